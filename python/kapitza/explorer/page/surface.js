// Two surfaces with the same words, so that the map on the page and the saved pictures are one drawing.

const INK = "#1c2127";
const FONT = '"DejaVu Sans", Arial, sans-serif';

class CanvasSurface {
  constructor(context) { this.context = context; }

  image(canvas, x, y, width, height, clip) {
    const c = this.context;
    c.save();
    c.beginPath();
    c.rect(...clip);
    c.clip();
    c.imageSmoothingEnabled = false;
    c.drawImage(canvas, x, y, width, height);
    c.restore();
  }

  line(points, colour, width) {
    const c = this.context;
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

  text(words, x, y, align, size = 12, turned = false) {
    const c = this.context;
    c.save();
    c.translate(x, y);
    if (turned) c.rotate(-Math.PI / 2);
    c.font = `${size}px ${FONT}`;
    c.fillStyle = INK;
    c.textAlign = align;
    c.fillText(words, 0, 0);
    c.restore();
  }
}

class SvgSurface {
  constructor(width, height) {
    this.size = [width, height];
    this.parts = [];
    this.clips = 0;
  }

  image(canvas, x, y, width, height, clip) {
    const id = `clip${this.clips++}`, [left, top, w, h] = clip;
    this.parts.push(`<clipPath id="${id}"><rect x="${left}" y="${top}" width="${w}" height="${h}"/></clipPath>`,
      `<image clip-path="url(#${id})" x="${x}" y="${y}" width="${width}" height="${height}" preserveAspectRatio="none" ` +
      `style="image-rendering:pixelated" href="${canvas.toDataURL("image/png")}"/>`);
  }

  line(points, colour, width) {
    this.parts.push(`<polyline fill="none" stroke="${colour}" stroke-width="${width}" points="${points.map((p) => p.join(",")).join(" ")}"/>`);
  }

  circle(x, y, radius, fill, stroke) {
    this.parts.push(`<circle cx="${x}" cy="${y}" r="${radius}" fill="${fill}" stroke="${stroke}" stroke-width="1.2"/>`);
  }

  rectangle(x, y, width, height, fill) {
    this.parts.push(`<rect x="${x}" y="${y}" width="${width}" height="${height}" fill="${fill}"/>`);
  }

  text(words, x, y, align, size = 12, turned = false) {
    const anchor = { left: "start", center: "middle", right: "end" }[align];
    const escaped = words.replace(/&/g, "&amp;").replace(/</g, "&lt;");
    const turn = turned ? ` transform="rotate(-90 ${x} ${y})"` : "";
    this.parts.push(`<text x="${x}" y="${y}" font-family="DejaVu Sans, Arial, sans-serif" font-size="${size}" fill="${INK}" text-anchor="${anchor}"${turn}>${escaped}</text>`);
  }

  toString() {
    const [width, height] = this.size;
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">` +
      `<rect width="100%" height="100%" fill="white"/>${this.parts.join("\n")}</svg>\n`;
  }
}
