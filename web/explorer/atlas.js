// An atlas: curves over a plane of two keys on which motions are born and change, and the motions of every place.
// Places are shares of the plane, [x, y].

export class Atlas {
  curves; classes; lists; cells; longest; mirrored; certainty; file; low; width;
  // Of all points of all curves: their places, and the directions to the side where the motion lives
  x; y; sideX; sideY;

  /** Of an answer to the request atlas. */
  constructor(header, bytes) {
    ({ curves: this.curves, classes: this.classes, lists: this.lists, cells: this.cells } = header);
    ({ max_period: this.longest, mirrored: this.mirrored, certainty: this.certainty } = header);
    ({ file: this.file, low: this.low, width: this.width } = header); // in the file's units
    const n = header.points;
    [this.x, this.y, this.sideX, this.sideY] = [0, 1, 2, 3].map((i) => new Float32Array(bytes.buffer, 4 * n * i, n));
    this.list = new Uint16Array(bytes.buffer, 16 * n, this.cells ** 2);
    this.supercritical = new Uint8Array(bytes.buffer, 16 * n + 2 * this.cells ** 2, n);
    for (const curve of this.curves) curve.box = this.boxOf(curve);
  }

  boxOf({ first, points }) {
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = first; i < first + points; i++) {
      box[0] = Math.min(box[0], this.x[i]);
      box[1] = Math.min(box[1], this.y[i]);
      box[2] = Math.max(box[2], this.x[i]);
      box[3] = Math.max(box[3], this.y[i]);
    }
    return box;
  }

  holds([x, y]) {
    return x >= 0 && x <= 1 && y >= 0 && y <= 1;
  }

  listAt([x, y]) {
    const cell = (share) => Math.max(0, Math.min(this.cells - 1, Math.floor(share * this.cells)));
    return this.list[cell(y) * this.cells + cell(x)];
  }

  /** The motions of a place, of which nobody knows which one comes first: {name, period, colour, count}. */
  motionsAt(place) {
    return (this.lists[this.listAt(place)] ?? []).map(([motion, count]) => ({ ...this.classes[motion], count }));
  }

  /** Crossings of the way from one place to another, in their order: {curve, point, at, into}; into: to the side where
   * the motion lives. */
  crossed(from, to) {
    const found = [];
    const [left, right] = [Math.min(from[0], to[0]), Math.max(from[0], to[0])];
    const [low, high] = [Math.min(from[1], to[1]), Math.max(from[1], to[1])];
    const way = [to[0] - from[0], to[1] - from[1]];
    for (const curve of this.curves) {
      const { box, first, points } = curve;
      if (box[0] > right || box[2] < left || box[1] > high || box[3] < low) continue;
      for (let i = first; i < first + points - 1; i++) {
        const at = meeting(from, way, [this.x[i], this.y[i]], [this.x[i + 1] - this.x[i], this.y[i + 1] - this.y[i]]);
        if (at !== null) found.push({ curve, point: i, at, into: way[0] * this.sideX[i] + way[1] * this.sideY[i] > 0 });
      }
    }
    return found.sort((one, other) => one.at - other.at);
  }

  /** The curve of motions of so many periods at most that comes nearest to a place, within `reach` along each axis;
   * null where there is none. */
  nearest([x, y], reach, longest = Infinity) {
    let best = { distance: 1, curve: null };
    for (const curve of this.curves) {
      if (curve.period > longest) continue;
      const { box, first, points } = curve;
      if (box[0] > x + reach[0] || box[2] < x - reach[0] || box[1] > y + reach[1] || box[3] < y - reach[1]) continue;
      for (let i = first; i < first + points - 1; i++) {
        const distance = Math.hypot(...this.apart(i, x, y).map((part, axis) => part / reach[axis]));
        if (distance < best.distance) best = { distance, curve };
      }
    }
    return best.curve;
  }

  /** From a place to the nearest point of a step of a curve. */
  apart(i, x, y) {
    const step = [this.x[i + 1] - this.x[i], this.y[i + 1] - this.y[i]];
    const to = [x - this.x[i], y - this.y[i]];
    const share = Math.max(0, Math.min(1, (to[0] * step[0] + to[1] * step[1]) / (step[0] ** 2 + step[1] ** 2 || 1)));
    return [to[0] - share * step[0], to[1] - share * step[1]];
  }
}

/** Where a way meets a step, as a share of the way; null where they do not meet. */
function meeting(from, way, start, step) {
  const area = way[0] * step[1] - way[1] * step[0];
  if (area === 0) return null;
  const [x, y] = [start[0] - from[0], start[1] - from[1]];
  const along = (x * step[1] - y * step[0]) / area;
  const across = (x * way[1] - y * way[0]) / area;
  return along >= 0 && along < 1 && across >= 0 && across < 1 ? along : null;
}
