// Ticks of an axis in radians (fractions of pi where the window is wide), degrees, or SI.

import { Decimal, digitsFor, turn } from "./decimal.js";

const PARTS_OF_PI = [1, 1 / 2, 1 / 4, 1 / 6, 1 / 12, 1 / 24];
const WIDE = 0.5; // rad: from here on fractions of pi are read more easily than decimals
const MOST_DIGITS = 4; // after the point, which the margin of an axis has room for; beyond, ticks count from an origin
const FINER = 2; // digits that a place has beyond those of ticks
const SHOWN_DIGITS = 30; // of such an origin

/** {ticks: [{share, words}], origin, wordsAt}: where ticks lie (0 at the lower edge, 1 at the upper) and what they say;
 * where digits run out they count from `origin` ("1.2345 + n × 1e-9"), else it is null. `wordsAt(share)`: what a tick
 * there would say, with more digits. `factor`: the unit's number per radian; `inPi`: fractions of pi are wanted. */
export function ticksOf(range, most, { factor = null, inPi = false } = {}) {
  if (inPi && range.width >= WIDE) return piTicks(range, most);
  const low = factor ? range.low.times(factor(digitsFor(range.width))) : range.low;
  const high = factor ? range.high.times(factor(digitsFor(range.width))) : range.high;
  const width = high.minus(low).toNumber();
  const step = roundStep(width / most);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return digits > MOST_DIGITS ? countedTicks(low, high, width, step, digits) : plainTicks(low.toNumber(), width, step,
    digits);
}

function roundStep(rough) {
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * [1, 2, 5, 10].find((n) => n * power >= rough * (1 - 1e-9));
}

function plainTicks(low, width, step, digits) {
  const ticks = [];
  for (let n = Math.ceil(low / step - 1e-6); n * step <= low + width * (1 + 1e-6); n++)
    ticks.push({ share: (n * step - low) / width, words: signed((n * step).toFixed(digits)) });
  return { ticks, origin: null, wordsAt: (share) => signed((low + share * width).toFixed(digits + FINER)) };
}

/** Ticks n 10^-digits from an origin of whole tens of them. */
function countedTicks(low, high, width, step, digits) {
  const origin = low
    .plus(high)
    .half()
    .rounded(Math.max(0, digits - 2));
  const unit = 10 ** -digits;
  const from = low.minus(origin).toNumber();
  const each = Math.round(step / unit);
  const ticks = [];
  for (let n = Math.ceil(from / step - 1e-6); n * step <= from + width * (1 + 1e-6); n++)
    ticks.push({ share: (n * step - from) / width, words: signed(String(n * each)) });
  const wordsAt = (share) => signed(((from + share * width) / unit).toFixed(FINER));
  return { ticks, wordsAt, origin: `${shortened(signed(origin.toString()))} + n × 1e${signed(String(-digits))}` };
}

function piTicks(range, most) {
  const step = Math.PI * (PARTS_OF_PI.filter((part) => range.width / (part * Math.PI) <= most).at(-1) ?? 1);
  const low = range.low.toNumber();
  const ticks = [];
  for (let n = Math.ceil(low / step - 1e-6); n * step <= low + range.width * (1 + 1e-6); n++)
    ticks.push({ share: (n * step - low) / range.width, words: piText((n * step) / Math.PI) });
  return { ticks, origin: null,
    wordsAt: (share) => `${signed(((low + share * range.width) / Math.PI).toFixed(FINER + 1))}π` };
}

/** A multiple of pi as a fraction: 3π/2. */
export function piText(multiple) {
  const denominator = [1, 2, 3, 4, 6, 8, 12, 24].find((n) => Math.abs(multiple * n - Math.round(multiple * n)) < 1e-6);
  const top = Math.round(multiple * denominator);
  if (top === 0) return "0";
  const size = Math.abs(top) === 1 ? "" : String(Math.abs(top));
  return `${top < 0 ? "−" : ""}${size}π${denominator === 1 ? "" : `/${denominator}`}`;
}

/** Degrees per radian, to that many digits. */
export function degrees(digits) {
  return Decimal.from(360).over(turn(digits + 10), digits + 10);
}

/** With true minus signs; a hyphen between a digit and a letter stays one ("6-nodding"). */
export function signed(text) {
  return text.replace(/-(?![a-z])/g, "−");
}

export function shortened(text) {
  return text.length > SHOWN_DIGITS ? `${text.slice(0, SHOWN_DIGITS / 2)}…${text.slice(-SHOWN_DIGITS / 2)}` : text;
}
