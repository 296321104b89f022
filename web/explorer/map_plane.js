// The plane of two keys of the pendulum that the map shows, and what the server knows of it: a chart at once, then
// atlases.

import { Atlas } from "./atlas.js";
import { stream } from "./engine.js";
import { asScene } from "./frames.js";
import { numberOf, withUnit } from "./values.js";

const CELLS = 120; // of the chart, along an axis
const DIGITS = 2; // of the edges
const RIM = 1e-6; // of the plane, outside of which rounding may lie

/** The keys that a map has where none are chosen: [along, up]. */
export function usualKeys(names) {
  const along = names.find((name) => /^k$|frequency/.test(name)) ?? names[0];
  return [along, names.find((name) => /amplitude|^m$/.test(name) && name !== along)
    ?? names.find((name) => name !== along)];
}

/** The edges of an axis about a value: amplitudes from 0, where nothing is driven and rest alone attracts. */
function edgesOf(name, number) {
  if (name === "k") return [Math.min(-0.5, number - 0.5), Math.max(1.5, number + 1)];
  if (/amplitude$|^m$/.test(name)) return [0, number > 0 ? 2.5 * number : 1];
  if (name.endsWith("frequency")) return [number / 3.5, 2.7 * number];
  return number === 0 ? [-1, 1] : [number / 2, 2 * number].sort((a, b) => a - b);
}

/** One axis: {name, unit, low, high}, edges in the unit in which the pendulum has the value. */
export function axisAround(name, pendulum) {
  const { number, unit } = numberOf(pendulum[name]);
  const [low, high] = edgesOf(name, number).map((edge) => Number(edge.toPrecision(DIGITS)));
  return { name, unit, low, high };
}

/** The share of an axis at which a pendulum lies; NaN where it has the value in another unit. */
export function shareOf({ name, unit, low, high }, pendulum) {
  const value = numberOf(pendulum[name]);
  return value?.unit === unit ? (value.number - low) / (high - low) : NaN;
}

/** What a map depends on beside its axes.
 * @param {any[]} axes @param {object} pendulum */
export function othersOf([x, y], pendulum) {
  return JSON.stringify({ ...pendulum, [x.name]: null, [y.name]: null });
}

/** Keys of a request that name the point of an atlas at which a pendulum lies, so that nothing is searched; none where
 * it is on no map. */
export function listedAt(ground, pendulum) {
  if (!ground || ground.others !== othersOf(ground.axes, pendulum)) return {};
  const place = ground.axes.map((axis) => shareOf(axis, pendulum));
  if (!place.every((share) => share > RIM && share < 1 - RIM)) return {};
  const { file, low, width } = ground.atlas;
  const [x, y] = place.map((share, i) => low[i] + share * width[i]);
  return { atlas: file, x, y };
}

/** The value at a share of an axis, as a scene has it. */
export function valueAt({ unit, low, high }, share) {
  return withUnit(Number((low + share * (high - low)).toPrecision(5)), unit);
}

/** As requests name axes: numbers without a unit are numbers. */
const asked = (axes) =>
  axes.map(({ name, unit, low, high }) => {
    const [min, max] = unit ? [withUnit(low, unit), withUnit(high, unit)] : [low, high];
    return { parameter: name, min, max };
  });

/** The atlases of a plane, of motions of up to so many periods, the better ones later. Throws the program's words.
 * @param {any[]} axes @param {object} pendulum @param {number} longest @param {AbortSignal} signal */
export async function* atlases(axes, pendulum, longest, signal) {
  const [x, y] = asked(axes);
  for await (const [header, bytes] of stream("atlas", { pendulum: asScene(pendulum), x, y, max_period: longest },
    signal)) {
    if (header.answer === "error") throw new Error(header.message);
    if (header.answer === "atlas") yield new Atlas(header, bytes);
  }
}

/** The levels of its chart, each [header, bytes].
 * @param {import("./engine.js").Engine} engine @param {any[]} axes @param {object} pendulum
 * @param {AbortSignal} signal */
export async function* charts(engine, axes, pendulum, signal) {
  const [x, y] = asked(axes).map((axis) => ({ ...axis, count: CELLS }));
  const request = { request: "chart", pendulum: asScene(pendulum), x, y, levels: [8, 4, 2, 1] };
  for await (const answer of engine.answers(request, signal)) if (answer[0].answer === "chart") yield answer;
}
