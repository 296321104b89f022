// What lies under the curves of the map: the number of motions of each place, or, while that is not known, the kind of motion in which a
// start near the inverted position ends.

import { bytesOf } from "./frames.js";
import { ORDER } from "./legend.js";

const MOST = 14; // motions that are distinguished
const SHADES = {
  light: [[251, 251, 239], [110, 166, 201]],
  dark: [[16, 24, 32], [46, 118, 124]],
};
const UNKNOWN = { light: [231, 185, 196], dark: [96, 52, 64] }; // where a curve is missing

/** A canvas of one pixel a cell; `colour(i)`: [r, g, b] of cell i, rows from below. */
function painted(rows, columns, colour) {
  const canvas = Object.assign(document.createElement("canvas"), { width: columns, height: rows });
  const context = canvas.getContext("2d");
  const picture = context.createImageData(columns, rows);
  for (let i = 0; i < rows * columns; i++) {
    const row = rows - 1 - Math.floor(i / columns);
    picture.data.set([...colour(i), 255], 4 * (row * columns + (i % columns)));
  }
  context.putImageData(picture, 0, 0);
  return canvas;
}

/** Shades of the number of motions: {canvas, kinds: [[words, colour], ...]}. */
export function countPicture(atlas, theme) {
  const [low, high] = SHADES[theme];
  const all = atlas.lists.map((_, list) => atlas.countOf(list));
  const counts = all.filter((count) => count !== null).map((count) => Math.min(MOST, count));
  const most = Math.max(1, ...counts), least = Math.min(1, ...counts);
  const shade = (count) => low.map((from, i) => Math.round(from + ((high[i] - from) * (count - least)) / Math.max(1, most - least)));
  const shades = all.map((count) => (count === null ? UNKNOWN[theme] : shade(Math.min(MOST, count))));
  const canvas = painted(atlas.cells, atlas.cells, (i) => shades[atlas.list[i]]);
  const kinds = [...new Set([Math.min(...counts), most])].map((count) => [`${count} motion${count === 1 ? "" : "s"}`, `rgb(${shade(count)})`]);
  if (counts.length < all.length) kinds.push(["not known", `rgb(${UNKNOWN[theme]})`]);
  return { canvas, kinds };
}

/** The kinds of motion of a chart's answer, in the same form. `colours`: of kinds. */
export function kindPicture({ rows, columns }, bytes, colours) {
  const seen = new Map();
  const colour = (i) => {
    const kind = kindOf(bytes[i], bytes[rows * columns + i]);
    if (!seen.has(kind)) seen.set(kind, colours[kind] ?? "#ffffff");
    return bytesOf(seen.get(kind));
  };
  const canvas = painted(rows, columns, colour);
  const kinds = [...seen].sort(([one], [other]) => ORDER.indexOf(one) - ORDER.indexOf(other));
  return { canvas, kinds: kinds.map(([name, shade]) => [name === "rotation +" ? "rotation" : name, shade]) };
}

/** The kind of motion of a cell by period (0 = chaotic, 255 = not settled) and centre (0 down, 1 inverted, 2 rotating, 3 neither). */
function kindOf(period, centre) {
  if (period === 255) return "not settled";
  if (period === 0) return "chaotic";
  if (centre === 2) return "rotation +";
  if (centre === 0) return period === 1 ? "down" : "down nodding";
  if (centre === 1) return { 1: "inverted", 2: "flutter" }[period] ?? "inverted nodding";
  return "other";
}
