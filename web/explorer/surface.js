// Two surfaces with the same words, so that what the page shows and what it saves are one drawing.

const FONT = '"DejaVu Sans", "Helvetica Neue", Arial, sans-serif';

const LETTERS = 14; // px

/** Colours of lines and letters. Saved pictures are always on white. */
export const LIGHT = { paper: "#ffffff", ink: "#1c2127", faint: "#5a646e", trace: "#a9c4df", mark: "#b3261e",
  shaker: "#dfe4e9", cross: "#1c212770" };
export const DARK = { paper: "#161b21", ink: "#e4e8ec", faint: "#98a2ad", trace: "#3f5f80", mark: "#ff8a7a",
  shaker: "#2a323b", cross: "#ffffff70" };

/** How much larger letters on the page's canvases are in a lecture. */
export const lettersOf = (page) => (page.dataset.story === undefined && page.dataset.letters !== "large" ? 1 : 1.35);

export class CanvasSurface {
  constructor(context, theme = LIGHT, letters = 1) {
    this.context = context;
    this.theme = theme;
    this.letters = letters;
  }

  /** @param {any} canvas @param {number[]} box */
  image(canvas, [x, y, width, height]) {
    this.context.drawImage(canvas, x, y, width, height);
  }

  line(points, colour, width, dashes = []) {
    const c = this.context;
    c.setLineDash(dashes);
    c.beginPath();
    points.forEach(([x, y], i) => (i ? c.lineTo(x, y) : c.moveTo(x, y)));
    c.strokeStyle = colour;
    c.lineWidth = width;
    c.stroke();
  }

  circle(x, y, radius, fill, stroke) {
    const c = this.context;
    c.beginPath();
    c.arc(x, y, radius, 0, 2 * Math.PI);
    c.fillStyle = fill;
    c.fill();
    c.strokeStyle = stroke;
    c.lineWidth = 1.2;
    c.stroke();
  }

  rectangle(x, y, width, height, fill) {
    this.context.fillStyle = fill;
    this.context.fillRect(x, y, width, height);
  }

  text(words, x, y, align, { size = LETTERS, turned = false, colour = this.theme.ink } = {}) {
    const c = this.context;
    c.save();
    c.translate(x, y);
    if (turned) c.rotate(-Math.PI / 2);
    c.font = `${size * this.letters}px ${FONT}`;
    c.fillStyle = colour;
    c.textAlign = align;
    c.fillText(words, 0, 0);
    c.restore();
  }

  /** Width of words, px. */
  width(words, size = LETTERS) {
    this.context.font = `${size * this.letters}px ${FONT}`;
    return this.context.measureText(words).width;
  }

  /** What `draw` draws is seen inside of the box alone.
   * @param {number[]} box @param {() => void} draw */
  clipped([x, y, width, height], draw) {
    this.context.save();
    this.context.beginPath();
    this.context.rect(x, y, width, height);
    this.context.clip();
    draw();
    this.context.restore();
  }
}

export class SvgSurface {
  constructor(width, height, theme = LIGHT) {
    this.size = [width, height];
    this.theme = theme;
    this.parts = [];
    this.clips = 0;
  }

  /** @param {any} canvas @param {number[]} box */
  image(canvas, [x, y, width, height]) {
    this.parts.push(
      `<image x="${x}" y="${y}" width="${width}" height="${height}" preserveAspectRatio="none" ` +
        `style="image-rendering:pixelated" href="${canvas.toDataURL("image/png")}"/>`,
    );
  }

  line(points, colour, width, dashes = []) {
    const path = points.map(([x, y]) => `${x.toFixed(2)},${y.toFixed(2)}`).join(" ");
    this.parts.push(`<polyline fill="none" stroke="${colour}" stroke-width="${width}" ` +
      `stroke-dasharray="${dashes.join(" ")}" points="${path}"/>`);
  }

  circle(x, y, radius, fill, stroke) {
    this.parts.push(`<circle cx="${x}" cy="${y}" r="${radius}" fill="${fill}" stroke="${stroke}" stroke-width="1.2"/>`);
  }

  rectangle(x, y, width, height, fill) {
    this.parts.push(`<rect x="${x}" y="${y}" width="${width}" height="${height}" fill="${fill}"/>`);
  }

  text(words, x, y, align, { size = LETTERS, turned = false, colour = this.theme.ink } = {}) {
    const anchor = { left: "start", center: "middle", right: "end" }[align];
    const turn = turned ? ` transform="rotate(-90 ${x} ${y})"` : "";
    this.parts.push(
      `<text x="${x}" y="${y}" font-family="DejaVu Sans, Arial, sans-serif" font-size="${size}" fill="${colour}" ` +
        `text-anchor="${anchor}"${turn}>${escaped(words)}</text>`,
    );
  }

  /** @param {number[]} box @param {() => void} draw */
  clipped([x, y, width, height], draw) {
    const id = `clip${this.clips++}`;
    this.parts.push(
      `<clipPath id="${id}"><rect x="${x}" y="${y}" width="${width}" height="${height}"/></clipPath>` +
        `<g clip-path="url(#${id})">`,
    );
    draw();
    this.parts.push("</g>");
  }

  toString() {
    const [width, height] = this.size;
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">` +
      `<rect width="100%" height="100%" fill="${this.theme.paper}"/>${this.parts.join("\n")}</svg>\n`
    );
  }
}

function escaped(words) {
  return words.replace(/&/g, "&amp;").replace(/</g, "&lt;");
}
