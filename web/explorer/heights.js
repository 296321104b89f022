// Shades by the time after which ends are certain.

import { TURN } from "./window.js";

/** By the word of the state: how much darker late ends are drawn (`depth`, 0 to 1), the shade that leaves a colour as
 * it is (`middle`), and whether shades are those of a raised frame. */
const MIDDLE = 0.5; // of a relief: the colour of a basin is on the mean that of its line in the list
const SHADINGS = {
  relief: { depth: 0.5, middle: MIDDLE, own: true },
  settling: { depth: 0.8, middle: 0, own: false },
  turns: { depth: 0.8, middle: 0, own: false },
};
const FLAT = { depth: 0, middle: 0, own: false };
const LEVEL = [MIDDLE - 1e6, MIDDLE + 1e6]; // heights between which all cells have the shade MIDDLE
export const shadingOf = (shade) => SHADINGS[shade] ?? FLAT;
const LAKES = 4; // numbers of turns that have shades of their own
export const DOUBLINGS = 10; // of the time after which the end is certain, until it is as dark as it gets
const LIGHT = [-0.45, 0.45, 0.77]; // where light comes from: left, above, in front
const STEEP = 0.13; // slope of ground that falls from the lightest to the darkest shade across a picture
const WHOLE = 1e-6; // rad by which a whole turn may differ
const REACH = 2; // cells about one that smooth it
const LATENESS = 0.45; // part that the time has in a shade; light has the rest
const [EARLY, LATE] = [0.02, 0.9]; // shares of a frame's cells that are as light, or darker than all but these

/** The shade of a number of turns, 0 (light) to 1: neighbours differ; where there is no number, light. */
export const shadeOfTurns = (turns) => (((turns % LAKES) + LAKES) % LAKES || 0) / (LAKES - 1);

/** Times, of 0 to 1 as `cells` has them, from which on cells get darker, and at which they are darkest. */
export const heightsOf = (frame, { own }) => (own && !frame.raised ? LEVEL : [0, 1]);

/** How much light a cell of a shade keeps. */
export const lightOf = ({ depth, middle }, shade) => (1 - depth * shade) / (1 - depth * middle);

/** Gives a frame the shades of a coarser frame of its window, between whose cells they are interpolated. */
export function raise(frame, coarse) {
  const { rows, columns, cells } = frame;
  const shades = litOf(coarse);
  const between = (i, count, all) => {
    const at = ((i + 0.5) * all) / count - 0.5;
    return [Math.floor(at), at - Math.floor(at)];
  };
  const across = Array.from({ length: columns }, (_, i) => {
    const [left, right] = between(i, columns, coarse.columns);
    return [cellOf(coarse, 0, left), cellOf(coarse, 0, left + 1), right];
  });
  for (let row = 0; row < rows; row++) {
    const [at, up] = between(row, rows, coarse.rows);
    const [below, above] = [cellOf(coarse, at, 0), cellOf(coarse, at + 1, 0)];
    for (let column = 0; column < columns; column++) {
      const [one, other, right] = across[column];
      const low = shades[below + one] * (1 - right) + shades[below + other] * right;
      const high = shades[above + one] * (1 - right) + shades[above + other] * right;
      cells[4 * (row * columns + column) + 1] = 255 * (low * (1 - up) + high * up);
    }
  }
  frame.raised = true;
}

/** The cell at a row and a column, beyond the edges the nearest one; round the circle, where the frame is a whole turn
 * of it. */
function cellOf({ rows, columns, window }, row, column) {
  const turns = Math.abs((window?.theta.width ?? 0) - TURN) < WHOLE;
  const x = turns ? (column + columns) % columns : Math.max(0, Math.min(columns - 1, column));
  return Math.max(0, Math.min(rows - 1, row)) * columns + x;
}

/** Shades of the cells of a frame with smooth times, 0 (light) to 1: late ends lie deep, and light comes from the upper
 * left. */
function litOf(frame) {
  const { rows, columns, labels, cells } = frame;
  const [low, high] = spreadOf(cells);
  const rough = Float32Array.from(labels, (_, i) => Math.max(0, Math.min(1, (depthOf(frame, i) - low) / (high - low))));
  const depth = smoothed(frame, smoothed(frame, rough));
  const slope = (i, from, to) => {
    if (labels[from] !== labels[i] || labels[to] !== labels[i]) return 0; // boundaries are no slopes
    return (STEEP * Math.sqrt(rows * columns) * (depth[from] - depth[to])) / (from === i || to === i ? 1 : 2);
  };
  const shades = depth.map((late, i) => {
    const column = i % columns;
    const row = (i - column) / columns;
    const at = (up, aside) => cellOf(frame, row + up, column + aside);
    const [x, y] = [slope(i, at(0, -1), at(0, 1)), slope(i, at(-1, 0), at(1, 0))];
    const light = (-LIGHT[0] * x - LIGHT[1] * y + LIGHT[2]) / Math.hypot(x, y, 1);
    return LATENESS * late + (1 - LATENESS) * (1 - light);
  });
  const [sums, counts] = [new Float64Array(256), new Uint32Array(256)];
  shades.forEach((shade, i) => ((sums[labels[i]] += shade), counts[labels[i]]++));
  return shades.map((shade, i) => Math.max(0, Math.min(1, MIDDLE + shade - sums[labels[i]] / counts[labels[i]])));
}

/** Each cell the mean of those of its label about it: slopes of times that vary from cell to cell are no ground. */
function smoothed(frame, values) {
  const { columns, labels } = frame;
  return values.map((_, i) => {
    const column = i % columns;
    const row = (i - column) / columns;
    let [sum, count] = [0, 0];
    for (let y = row - REACH; y <= row + REACH; y++)
      for (let x = column - REACH; x <= column + REACH; x++) {
        const other = cellOf(frame, y, x);
        if (labels[other] !== labels[i]) continue;
        sum += values[other];
        count++;
      }
    return sum / count;
  });
}

/** The time of a cell, on the scale of `cells`, 0 to 1. */
const depthOf = ({ smooth, cells }, i) => (smooth ? Math.log2(1 + (smooth[i] || 0)) / DOUBLINGS
  : cells[4 * i + 1] / 255);

function spreadOf(cells) {
  const counts = new Uint32Array(256);
  let all = 0;
  for (let i = 0; i < cells.length; i += 4)
    if (cells[i] !== 255) {
      counts[cells[i + 1]]++;
      all++;
    }
  const at = (share) => {
    let level = 0;
    for (let sum = counts[0]; sum <= share * all && level < 255;) sum += counts[++level];
    return level / 255;
  };
  const [low, high] = [at(EARLY), at(LATE)];
  return [low, Math.max(high, low + 0.1)];
}
