// A veil over two pictures of one window where they agree, so that what differs is lit.

import { sharesOf } from "./frames.js";

const PALE = [236, 240, 244, 205]; // its colour and how dense it is

/** The veil of two frames, {frame: whose cells it covers, canvas}; kept by the first of them. */
export function veilOf(one, other) {
  if (one.veil?.other === other) return one.veil;
  const [names, others] = [one, other]
    .map((frame) => new Map(sharesOf(frame).map(({ id, key }) => [id < 0 ? 255 : id, key])));
  const { rows, columns } = one;
  const canvas = Object.assign(document.createElement("canvas"), { width: columns, height: rows });
  const picture = canvas.getContext("2d").createImageData(columns, rows);
  for (let row = 0; row < rows; row++) {
    const across = Math.floor(((row + 0.5) * other.rows) / rows) * other.columns;
    for (let column = 0; column < columns; column++) {
      const label = one.labels[row * columns + column];
      const second = other.labels[across + Math.floor(((column + 0.5) * other.columns) / columns)];
      if (names.get(label) === others.get(second)) picture.data.set(PALE, 4 * ((rows - 1 - row) * columns + column));
    }
  }
  canvas.getContext("2d").putImageData(picture, 0, 0);
  return (one.veil = { frame: one, other, canvas });
}
