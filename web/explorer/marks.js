// Marks under a slider: where the map has curves on its way, and the limits between which upright stands.

import { shareOf } from "./ground.js";
import { placeOf, withUnit } from "./values.js";

const LIMITS = { rest_leans: "stands", rest_swings: "flutters" }; // of upright, as marks are called
const [BESIDE, APART] = [4, 6]; // px between a tick and its words, and between words

/** Marks of a slider: {place, words, limit, below: upright is stable beyond it}, where the line through a pendulum's place crosses curves of the map. */
export function marksOf(ground, name, pendulum, home) {
  const axis = ground?.axes.findIndex((one) => one.name === name) ?? -1;
  if (axis < 0) return [];
  const { low, high, unit } = ground.axes[axis];
  const ends = [0, 1].map((share) => ground.axes.map((other, i) => (i === axis ? share : shareOf(other, pendulum))));
  if (!ground.atlas.holds(ends[0]) || !ground.atlas.holds(ends[1])) return [];
  return ground.atlas.crossed(...ends).flatMap(({ curve, at }) => {
    const number = Number((low + at * (high - low)).toPrecision(3));
    const place = placeOf(withUnit(number, unit), home, false);
    const limit = curve.words.startsWith("upright") ? (LIMITS[curve.kind] ?? null) : null;
    const words = `${withUnit(number, unit)}: ${curve.words}, ${limit ?? curve.kind.replace("_", " ")}`;
    return Math.abs(place) < 1 ? [{ place, words, limit: limit && `${limit} ${number}`, below: limit === LIMITS.rest_leans }] : [];
  });
}

/** Where upright stands, as shares of a slider: the first stretch that marks bound. */
export function stretchOf(marks) {
  const limits = marks.filter(({ limit }) => limit);
  const from = limits.findIndex(({ below }) => below);
  const to = limits.find(({ below }, i) => !below && i > from);
  const share = ({ place }) => `${50 * (1 + place)}%`;
  const [low, high] = [from < 0 ? "0%" : share(limits[from]), to ? share(to) : "100%"];
  return [["--from", limits.length ? low : "0%"], ["--to", limits.length ? high : "0%"]];
}

/**
 * Where the words of limits stand so that none touch: {first, last, left, words} of each group, `first` and `last`: indices of its ticks,
 * `left`: whether they stand to the left of the first tick, else to the right of the last. Limits: {x, words, below}, x in px from the left,
 * in their order; `widthOf(words)`: px; `room`: [left, right] edges. Words without room beside others join those of the tick before, and words
 * without any room are left out.
 */
export function laidOut(limits, widthOf, room) {
  let groups = limits.map(({ below, words }, i) => ({ first: i, last: i, below, words }));
  for (;;) {
    const placed = [];
    let end = room[0];
    const stuck = groups.findIndex((group) => {
      const wide = widthOf(group.words);
      const spans = [
        [false, limits[group.last].x + BESIDE],
        [true, limits[group.first].x - BESIDE - wide],
      ];
      const next = limits[group.last + 1]?.x ?? Infinity; // words cover no other tick
      const fits = ([left, from]) => from >= end && from + wide <= room[1] && (left || from + wide < next);
      const span = (group.below ? spans.toReversed() : spans).find(fits);
      if (!span) return true;
      end = Math.max(span[1] + wide + APART, limits[group.last].x + BESIDE);
      placed.push({ ...group, left: span[0] });
      return false;
    });
    if (stuck < 0) return placed;
    const at = stuck > 0 ? stuck - 1 : groups.length > 1 ? 0 : -1;
    const [one, other] = [groups[at], groups[at + 1]];
    const joined = one && { first: one.first, last: other.last, below: one.below, words: `${one.words}, ${other.words}` };
    const short = joined && widthOf(joined.words) <= room[1] - room[0] && other.last - one.first < 2;
    const { last } = groups[stuck];
    const rest = groups[stuck].first < last ? [{ ...limits[last], first: last, last }] : []; // of two that were joined, the second may have room
    groups = short ? groups.toSpliced(at, 2, joined) : groups.toSpliced(stuck, 1, ...rest);
  }
}

/** Fills the element under a slider. */
export function drawMarks(holder, marks) {
  const words = marks.map((mark) => mark.words).join("; ");
  if (holder.dataset.words === words && holder.dataset.wide === String(holder.clientWidth)) return;
  Object.assign(holder.dataset, { words, wide: holder.clientWidth });
  holder.setAttribute("role", "img");
  holder.setAttribute("aria-label", words || "no limit");
  const ticks = marks.map(newTick);
  holder.replaceChildren(...ticks);
  const limits = marks.flatMap((mark, i) => (mark.limit ? [{ ...mark, tick: ticks[i], x: (holder.clientWidth * (1 + mark.place)) / 2 }] : []));
  limits.sort((one, other) => one.x - other.x);
  const named = limits.map(({ x, limit, below }) => ({ x, words: limit, below }));
  const room = [holder.clientWidth ? -8 : 0, holder.clientWidth + 8];
  for (const { first, last, left, words: text } of laidOut(named, widthIn(holder), room)) {
    const { tick } = limits[left ? first : last];
    tick.textContent = text;
    tick.classList.toggle("below", left);
    tick.title = limits.slice(first, last + 1).map((limit) => limit.words).join("; ");
  }
}

/** Measures words in the letters of an element. */
function widthIn(holder) {
  const context = (widthIn.context ??= document.createElement("canvas").getContext("2d"));
  const { fontFamily } = getComputedStyle(holder);
  context.font = `${getComputedStyle(holder).getPropertyValue("--tiny")} ${fontFamily}`;
  return (words) => context.measureText(words).width;
}

function newTick({ place, words, limit }) {
  const tick = document.createElement("span");
  tick.title = words;
  tick.className = limit ? "limit" : "";
  tick.style.setProperty("--share", (1 + place) / 2);
  return tick;
}
