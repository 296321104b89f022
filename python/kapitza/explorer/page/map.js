// The map: a window of starts, the labels of the last view in it, points and lines over them, axes around it.

const MARGIN = { left: 64, right: 12, top: 8, bottom: 46 };
const TURN = 2 * Math.PI;

// The plane of a canvas of width x height: where a start of the window lies on it, and back.
class Plane {
  constructor(window, width, height) {
    [this.low, this.high, this.slow, this.fast] = window;
    this.box = [MARGIN.left, MARGIN.top, width - MARGIN.left - MARGIN.right, height - MARGIN.top - MARGIN.bottom];
  }

  x(theta) { return this.box[0] + (theta - this.low) / (this.high - this.low) * this.box[2]; }
  y(velocity) { return this.box[1] + (this.fast - velocity) / (this.fast - this.slow) * this.box[3]; }
  theta(x) { return this.low + (x - this.box[0]) / this.box[2] * (this.high - this.low); }
  velocity(y) { return this.fast - (y - this.box[1]) / this.box[3] * (this.fast - this.slow); }

  holds(x, y) {
    const [left, top, width, height] = this.box;
    return x >= left && x <= left + width && y >= top && y <= top + height;
  }

  // Every image theta + 2 pi n of a start that lies in the window, as [x, y].
  images(theta, velocity) {
    const found = [];
    if (velocity < this.slow || velocity > this.fast) return found;
    for (let n = Math.ceil((this.low - theta) / TURN); theta + n * TURN <= this.high; n++)
      found.push([this.x(theta + n * TURN), this.y(velocity)]);
    return found;
  }
}

// The labels of a view as a canvas of its own, one pixel a cell, the fastest row on top.
function labelImage(view) {
  const bytes = Uint8Array.from(atob(view.labels), (c) => c.charCodeAt(0));
  const labels = new Int16Array(bytes.buffer);
  const canvas = document.createElement("canvas");
  canvas.width = view.width;
  canvas.height = view.height;
  const context = canvas.getContext("2d"), image = context.createImageData(view.width, view.height);
  const pixels = new Uint32Array(image.data.buffer);
  const colour = (hex) => 0xff000000 | parseInt(hex.slice(5, 7) + hex.slice(3, 5) + hex.slice(1, 3), 16);
  const table = view.attractors.map((row) => colour(row.colour)), unsettled = colour(view.unsettled_colour);
  for (let row = 0; row < view.height; row++)
    for (let i = 0; i < view.width; i++) {
      const label = labels[(view.height - 1 - row) * view.width + i];
      pixels[row * view.width + i] = label < 0 ? unsettled : table[label];
    }
  context.putImageData(image, 0, 0);
  return canvas;
}

// Ticks of an axis: a round step, and the angle or velocity that all are counted from where digits run out.
function ticksOf(low, high, most) {
  const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((n) => n * power >= rough);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const origin = digits > 5 ? (low + high) / 2 : 0;
  const ticks = [];
  for (let n = Math.ceil((low - origin) / step - 1e-6); origin + n * step <= high + 1e-6 * step; n++)
    ticks.push([origin + n * step, origin ? (n * step).toExponential(0).replace(/-/g, "−") : (n * step).toFixed(digits).replace("-", "−")]);
  return { ticks, origin };
}

function drawAxes(surface, plane) {
  const [left, top, width, height] = plane.box, bottom = top + height;
  surface.line([[left, top], [left + width, top], [left + width, bottom], [left, bottom], [left, top]], INK, 1);
  const along = ticksOf(plane.low, plane.high, Math.max(2, width / 110)), up = ticksOf(plane.slow, plane.fast, Math.max(2, height / 70));
  for (const [value, words] of along.ticks) {
    surface.line([[plane.x(value), bottom], [plane.x(value), bottom + 5]], INK, 1);
    surface.text(words, plane.x(value), bottom + 18, "center");
  }
  for (const [value, words] of up.ticks) {
    surface.line([[left - 5, plane.y(value)], [left, plane.y(value)]], INK, 1);
    surface.text(words, left - 8, plane.y(value) + 4, "right");
  }
  const from = (origin) => (origin ? ` ${origin < 0 ? "+" : "−"} ${Math.abs(origin).toPrecision(15)}` : "");
  surface.text(`angle θ from down${from(along.origin)} (rad)`, left + width / 2, bottom + 38, "center");
  surface.text(`velocity dθ/d(ωt)${from(up.origin)}`, 14, top + height / 2, "center", 12, true);
}

function drawPoints(surface, plane, row, fill) {
  row.theta.forEach((theta, i) => {
    for (const [x, y] of plane.images(theta, row.velocity[i])) surface.circle(x, y, row.theta.length > 2 ? 3.2 : 4.6, fill, "#ffffff");
  });
}

function drawLines(surface, plane, lines) {
  const [left, top, width, height] = plane.box;
  for (const line of lines) {
    const angles = line.map((point) => point[0]);
    const first = Math.ceil((plane.low - Math.max(...angles)) / TURN), last = Math.floor((plane.high - Math.min(...angles)) / TURN);
    for (let n = first; n <= last; n++) {
      let part = [];
      const flush = () => { if (part.length > 1) surface.line(part, "#000000", 1); part = []; };
      for (const [theta, velocity] of line) {
        const x = plane.x(theta + n * TURN), y = plane.y(velocity);
        if (x < left || x > left + width || y < top || y > top + height) flush();
        else part.push([x, y]);
      }
      flush();
    }
  }
}

// The whole drawing. layers: {view, image, attractors: bool, overlays: [..], motion: {theta, velocity} or null}
function drawMap(surface, window, width, height, layers) {
  const plane = new Plane(window, width, height);
  surface.rectangle(0, 0, width, height, "#ffffff");
  if (layers.view) {
    const [low, high, slow, fast] = layers.view.window;
    surface.image(layers.image, plane.x(low), plane.y(fast), plane.x(high) - plane.x(low), plane.y(slow) - plane.y(fast), plane.box);
    if (layers.attractors) for (const row of layers.view.attractors) drawPoints(surface, plane, row, INK);
  }
  for (const overlay of layers.overlays) {
    if (overlay.lines) drawLines(surface, plane, overlay.lines);
    for (const [theta, velocity] of overlay.points || [])
      for (const [x, y] of plane.images(theta, velocity)) surface.circle(x, y, 3.6, "#ffffff", "#000000");
  }
  if (layers.motion) drawPoints(surface, plane, layers.motion, "#b3261e");
  drawAxes(surface, plane);
  return plane;
}
