// Boundaries of basins: where the end changes between two starts, and the nearest start that ends elsewhere.

import { Decimal } from "./decimal.js";
import { asScene } from "./frames.js";
import { placementOf } from "./placement.js";
import { Range, TURN, Window } from "./window.js";

const LOOK = { width: 120, height: 80 }; // cells of the pictures in which another basin is looked for
const WIDER = 4; // how much wider each of them is than the one before
const FASTEST = 40; // rad per drive radian: windows beyond it are not looked at
const FINE = 1e-3; // of a push, to which it is halved
const FEWEST = 6; // cells of a side, from which on a part of a frame is known
const TRIED = 5; // starts with another quick label whose end is asked for

/** Id of the attractor that a start, [theta, velocity] as Decimals, ends on; -1: it settles on none. */
/** @param {import("./pane.js").Pane} pane @param {any[]} start */
export async function endOf(pane, [theta, velocity]) {
  const request = { request: "where", theta: theta.toString(), velocity: velocity.toString(),
    pendulum: asScene(pane.pendulum) };
  return (await pane.engine.answer(request))[0].attractor;
}

/** Halves the way between two starts, of which the first ends on `end`: yields [one, other, share of their distance]
 * after each step. */
export async function* halvings(pane, one, other, end) {
  for (let share = 0.5; ; share /= 2) {
    const middle = [0, 1].map((axis) => one[axis].plus(other[axis]).half());
    if ((await endOf(pane, middle)) === end) one = middle;
    else other = middle;
    yield [one, other, share];
  }
}

/** Centres of cells of a frame whose label is not that of its middle, the nearest first, as shares of its window. */
function otherCells({ rows, columns, labels }) {
  const own = labels[Math.floor(rows / 2) * columns + Math.floor(columns / 2)];
  const found = [];
  labels.forEach((label, cell) => {
    if (label !== own && label !== 255) found.push(
      [((cell % columns) + 0.5) / columns, (Math.floor(cell / columns) + 0.5) / rows]);
  });
  const distance = ([x, y]) => Math.hypot(x - 0.5, y - 0.5);
  return found.sort((one, other) => distance(one) - distance(other));
}

/** A window as wide as `window`, whose middle is the boundary that is nearest to that of `window`. */
export async function nearestBoundary(pane, window) {
  pane.lent++;
  try {
    return await soughtBoundary(pane, window);
  } finally {
    pane.lent--;
  }
}

async function soughtBoundary(pane, window) {
  const middle = [window.theta.at(0.5), window.velocity.at(0.5)];
  const end = await endOf(pane, middle);
  for (let wide = window; ; wide = wide.zoomed(WIDER, 0.5, 0.5)) {
    for (const [x, y] of otherCells(await pane.glance(wide, LOOK)).slice(0, TRIED)) {
      const other = [wide.theta.at(x), wide.velocity.at(y)];
      if ((await endOf(pane, other)) === end) continue;
      const finest = 1e-3 * Math.min(1, window.theta.width / wide.theta.width);
      for await (const [one, , share] of halvings(pane, middle, other, end)) if (share < finest) return around(window,
        one);
    }
    if (wide.theta.width >= TURN * (1 - 1e-9) && wide.velocity.width > FASTEST) throw new Error(
      "No other basin was found.");
  }
}

function around({ theta, velocity }, point) {
  const range = ({ width }, at) => new Range(at.moved(width, -0.5), at.moved(width, 0.5));
  return new Window(range(theta, point[0]), range(velocity, point[1]));
}

/** The smallest change of velocity seen that takes an attractor from one of its strobe points, { id, strobe: [[theta,
 * velocity], ...] }, into another basin: found among the cells of the last frame, then halved. Null: none in that
 * window. Tongues thinner than a cell may lie nearer. */
export async function smallestPush(pane, { id, strobe }) {
  const { top: frame } = pane;
  if (!frame) return null;
  let best = null;
  for (const [angle, speed] of strobe) {
    const [theta, velocity] = [Decimal.from(angle), Decimal.from(speed)];
    const turns = frame.window.theta.shareOf(theta);
    const period = TURN / frame.window.theta.width;
    const column = Math.floor((turns - period * Math.floor(turns / period)) * frame.columns);
    const row = Math.floor(frame.window.velocity.shareOf(velocity) * frame.rows);
    if (column >= frame.columns || row < 0 || row >= frame.rows) continue;
    for (const step of [-1, 1])
      for (let at = row + step; at >= 0 && at < frame.rows; at += step) {
        const label = frame.labels[at * frame.columns + column];
        if (label === id || label === 255) continue;
        if (!best || Math.abs(at - row) < best.cells) best = { cells: Math.abs(at - row), theta, velocity,
          at: (at + 0.5) / frame.rows };
        break;
      }
  }
  if (!best) return null;
  const other = [best.theta, frame.window.velocity.at(best.at)];
  const end = await endOf(pane, [best.theta, best.velocity]);
  for await (const [, beyond, share] of halvings(pane, [best.theta, best.velocity], other, end))
    if (share < FINE) return beyond[1].minus(best.velocity).toNumber();
  return null;
}

/** Whether cells of a frame in a part of it, shares [left, bottom, width, height], have several labels; null where it
 * has too few cells. */
function hasSeveral({ rows, columns, labels }, [left, bottom, width, height]) {
  const [first, last] = [Math.max(0, Math.floor(left * columns)),
    Math.min(columns, Math.ceil((left + width) * columns))];
  const [low, high] = [Math.max(0, Math.floor(bottom * rows)), Math.min(rows, Math.ceil((bottom + height) * rows))];
  if (last - first < FEWEST || high - low < FEWEST) return null;
  for (let row = low; row < high; row++)
    for (let column = first; column < last; column++)
      if (labels[row * columns + column] !== labels[low * columns + first]) return true;
  return false;
}

/** A window that would show one colour of a frame, moved to the boundary of the frame that is nearest; the window
 * itself where there is none. */
export function onBoundary(window, frame) {
  const { place, period } = placementOf(frame, window);
  const [left, bottom, width, height] = place;
  const across = (0.5 - left) / width;
  const at = [across - period * Math.floor(across / period), (0.5 - bottom) / height];
  if (hasSeveral(frame, [at[0] - 0.5 / width, at[1] - 0.5 / height, 1 / width, 1 / height]) !== false) return window;
  const edge = edgeNear(frame, ...at, 1);
  return edge ? window.moved(width * (edge[0] - at[0]), height * (edge[1] - at[1])).wrapped() : window;
}

/** The edge between labels that is nearest to a place of a frame (shares of it), within `reach`; null where there is
 * none. */
export function edgeNear({ rows, columns, labels }, x, y, reach) {
  const [column, row] = [Math.floor(x * columns), Math.floor(y * rows)];
  const [across, up] = [Math.ceil(reach * columns), Math.ceil(reach * rows)];
  let best = null;
  for (let i = Math.max(0, row - up); i < Math.min(rows - 1, row + up); i++)
    for (let j = Math.max(0, column - across); j < Math.min(columns - 1, column + across); j++) {
      const cell = i * columns + j;
      if (labels[cell] === labels[cell + 1] && labels[cell] === labels[cell + columns]) continue;
      const place = [(j + 1) / columns, (i + 1) / rows];
      const distance = Math.hypot(place[0] - x, place[1] - y);
      if (distance < (best?.distance ?? reach)) best = { place, distance };
    }
  return best?.place ?? null;
}
