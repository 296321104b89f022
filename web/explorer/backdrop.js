// What lies under the curves of the map: what of most interest a place has, or, while that is not known, the kind of
// motion in which a start near inverted ends.

import { bytesOf } from "./frames.js";
import { kindOf as kindOfName } from "./words.js";

/** Regions of a map, the first that fits names a place: [words, kinds of motion that it has, kind that colours it].
 * @typedef {[string, string[], string]} Region
 * @type {Region[]} */
const REGIONS = [
  ["can stand", ["inverted"], "inverted"],
  ["can flutter", ["flutter", "inverted nodding"], "flutter"],
  ["down", ["down", "down nodding"], "down"],
  ["rotations only", ["rotation +", "rotation -", "running +", "running -"], "rotation +"],
];
/** @type {Region} */
const OTHER = ["other motions", [], "other"];
/** @type {Region} */
const UNKNOWN = ["not known", [], "unknown"];
const UNKNOWN_COLOUR = "#e7b9c4"; // where a curve is missing

const regionOf = (kinds) => REGIONS.find(([, own]) => own.some((kind) => kinds.includes(kind))) ?? OTHER;

/** The words of the region of a place of an atlas. */
export function regionWords(atlas, place) {
  return regionOfList(atlas, atlas.listAt(place))[0];
}

function regionOfList(atlas, list) {
  const motions = atlas.lists[list];
  return motions ? regionOf(motions.map(([motion]) => atlas.classes[motion].name.replace(/^rotation /, "rotation +"))
    .map(kindOfName)) : UNKNOWN;
}

/** A picture, {canvas of one pixel a cell, kinds: [[words, colour], ...] of the regions that it has}; `region(i)`: of
 * cell i, rows from below. */
function painted(rows, columns, region, colours) {
  const canvas = Object.assign(document.createElement("canvas"), { width: columns, height: rows });
  const context = canvas.getContext("2d");
  const picture = context.createImageData(columns, rows);
  const seen = new Set();
  const colourOf = ([, , kind]) => colours[kind] ?? UNKNOWN_COLOUR;
  for (let i = 0; i < rows * columns; i++) {
    const row = rows - 1 - Math.floor(i / columns);
    seen.add(region(i));
    picture.data.set([...bytesOf(colourOf(region(i))), 255], 4 * (row * columns + (i % columns)));
  }
  context.putImageData(picture, 0, 0);
  const listed = [...REGIONS, OTHER, UNKNOWN].filter((one) => seen.has(one));
  return { canvas, kinds: listed.map((one) => [one[0], colourOf(one)]) };
}

/** The regions of an atlas. `colours`: of kinds of motion. */
export function regionPicture(atlas, colours) {
  const regions = atlas.lists.map((_, list) => regionOfList(atlas, list));
  return painted(atlas.cells, atlas.cells, (i) => regions[atlas.list[i]], colours);
}

/** Those of a chart's answer: of the one start that it follows. */
export function chartPicture({ rows, columns }, bytes, colours) {
  return painted(rows, columns, (i) => regionOf([kindOf(bytes[i], bytes[rows * columns + i])]), colours);
}

/** The kind of motion of a cell of a chart by period (0 = chaotic, 255 = not settled) and centre (0 down, 1 inverted, 2
 * rotating, 3 neither). */
export function kindOf(period, centre) {
  if (period === 255) return "not settled";
  if (period === 0) return "chaotic";
  if (centre === 2) return "rotation +";
  if (centre === 0) return period === 1 ? "down" : "down nodding";
  if (centre === 1) return { 1: "inverted", 2: "flutter" }[period] ?? "inverted nodding";
  return "other";
}
