// Values of the pendulum as a scene has them: numbers, some with a unit.

const PARTS = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$/; // a number and its unit, if it has one
// A slider goes from the scene's value / 4 to its 4-fold, in equal ratios; from 0 to -1 and 1, finer near 0
const REACH = 4;

/** Number and unit of a value as a scene has it ("0.3", "12 Hz"); null where it is none (words, lists). */
export function numberOf(value) {
  const match = typeof value === "string" ? PARTS.exec(value) : null;
  return match && Number.isFinite(Number(match[1])) ? { number: Number(match[1]), unit: match[2] } : null;
}

export function withUnit(number, unit) {
  return unit ? `${number} ${unit}` : String(number);
}

/** What a key is called on the page. */
export const keyWords = (name) => name.replace(/_/g, " ");

/** The value at a slider's place, -1 to 1, of a key that the scene gives as `home`. */
export function valueAt(place, home) {
  if (place === 0) return home;
  const { number, unit } = numberOf(home);
  const value = number === 0 ? place ** 3 : number * REACH ** place;
  return withUnit(Number(value.toPrecision(6)), unit);
}

/** The slider's place of a value; beyond its ends too where `ends` is false. */
export function placeOf(value, home, ends = true) {
  const { number } = numberOf(home);
  const at = numberOf(value)?.number ?? number;
  const place = number === 0 ? Math.cbrt(at) : at / number > 0 ? Math.log(at / number) / Math.log(REACH) : -Infinity;
  return ends ? Math.max(-1, Math.min(1, place)) : place;
}
