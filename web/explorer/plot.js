// A small plot of a motion: axes with ticks, lines and points.

import { Decimal } from "./decimal.js";
import { signed, ticksOf } from "./ticks.js";
import { Range } from "./window.js";

const MARGIN = { left: 66, right: 14, top: 12, bottom: 54 }; // the button Play lies under the numbers of the lower axis
const APART = 5; // px between words of an axis
const LETTERS = 14; // px
const [ACROSS, UP] = [72, 36]; // px that a tick of an axis has
const MOST_PARTS = 12; // of a drive frequency that ticks tell apart

/** Ticks of whole frequencies up to `most`, of their halves, and of the parts that a motion of that period has: {at,
 * words, rank}; words of a lower rank are the more important ones. */
export function fractionTicks(most, period) {
  const parts = period > 1 && period <= MOST_PARTS ? [2, period] : [2];
  const found = new Map();
  for (const part of parts)
    for (let n = 0; n <= most * part; n++) {
      const [top, bottom] = reduced(n, part);
      const rank = bottom === 1 && top > 0 ? 0 : top === 1 && bottom === period ? 1 : n === 0 || top / bottom === 1 / 2
        ? 2 : bottom === 2 ? 3 : 4;
      found.set(n / part, { at: n / part, words: bottom === 1 ? String(top) : `${top}/${bottom}`, rank });
    }
  return [...found.values()].sort((one, other) => one.at - other.at);
}

function reduced(top, bottom) {
  const common = (a, b) => (b ? common(b, a % b) : a);
  const factor = common(top, bottom);
  return [top / factor, bottom / factor];
}

/** Those of words on a line, {x, wide, rank} in px about their middle, that do not touch a more important one. */
export function apart(words) {
  const kept = [];
  for (const one of words.toSorted((a, b) => a.rank - b.rank || a.x - b.x))
    if (kept.every((other) => Math.abs(one.x - other.x) >= (one.wide + other.wide) / 2 + APART)) kept.push(one);
  return kept;
}

export class Plot {
  left; right; low; high; // of the quantities along its axes

  /** @param {any} surface @param {number} width @param {number} height @param {number[]} across @param {number[]} up */
  constructor(surface, width, height, [left, right], [low, high]) {
    this.surface = surface;
    [this.left, this.right, this.low, this.high] = [left, right, low, high];
    const margin = MARGIN.left * (surface.letters ?? 1); // room for numbers such as −0.037
    this.box = [margin, MARGIN.top, width - margin - MARGIN.right, height - MARGIN.top - MARGIN.bottom];
  }

  place([x, y]) {
    const [left, top, width, height] = this.box;
    return [left + ((x - this.left) / (this.right - this.left)) * width,
      top + (1 - (y - this.low) / (this.high - this.low)) * height];
  }

  line(points, colour = this.surface.theme.ink, width = 1.4) {
    let run = [];
    const flush = () => {
      if (run.length > 1) this.surface.line(run, colour, width);
      run = [];
    };
    for (const [i, point] of points.entries()) {
      // Round the circle
      const wraps = i && this.right - this.left < 8 && Math.abs(point[0] - points[i - 1][0]) > Math.PI;
      if (wraps) flush();
      run.push(this.place(point));
    }
    flush();
  }

  point(x, y, radius = 5) {
    this.surface.circle(...this.place([x, y]), radius, this.surface.theme.mark, this.surface.theme.paper);
  }

  /** Lines of words in the middle. */
  say(...lines) {
    const [left, top, width, height] = this.box;
    const step = 18 * (this.surface.letters ?? 1);
    lines.forEach((words, i) => this.surface.text(words, left + width / 2, top + height / 2 + step * i, "center"));
  }

  /** Both axes with their words; `across` and `up`: {ticks} of their own, {inPi} for fractions of pi, {per} for values
   * counted in that many. */
  /** @param {string} words @param {string} upWords @param {{across?: any, up?: any}} options of ticksBetween */
  axes(words, upWords, { across = {}, up = {} } = {}) {
    const [left, top, width, height] = this.box;
    const { surface } = this;
    const { faint } = surface.theme;
    const bottom = top + height;
    const small = { size: LETTERS, colour: faint };
    surface.line([[left, top], [left, bottom], [left + width, bottom]], faint, 1);
    const letters = surface.letters ?? 1;
    const along = across.ticks ?? ticksBetween(this.left, this.right, width / (ACROSS * letters), across);
    const placed = along
      .map((tick) => ({ ...tick, x: this.place([tick.at, 0])[0], wide: surface.width(tick.words, LETTERS) }));
    for (const { x, rank } of placed) surface.line([[x, bottom], [x, bottom + (rank ? 3 : 5)]], faint, 1);
    for (const { x, words } of apart(placed)) surface.text(words, x, bottom + 4 + 11 * letters, "center", small);
    surface.text(words, left + width / 2, bottom + 8 + 25 * letters, "center", small);
    for (const { at, words } of ticksBetween(this.low, this.high, height / (UP * letters), up)) {
      const y = this.place([0, at])[1];
      surface.line([[left - 4, y], [left, y]], faint, 1);
      surface.text(words, left - 6, y + 4, "right", small);
    }
    surface.text(upWords, 10 * letters, top + height / 2, "center", { ...small, turned: true });
  }
}

/** Ticks between two numbers: {at, words, rank}. */
function ticksBetween(low, high, most, { inPi = false, per = 1 }) {
  const range = new Range(Decimal.from(low / per), Decimal.from(high / per));
  return ticksOf(range, Math.max(2, most), { inPi }).ticks
    .map(({ share, words }) => ({ at: low + share * (high - low), words: signed(words), rank: 0 }));
}
