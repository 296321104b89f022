// Values of the pendulum as a scene has them: numbers, some with a unit.

const PARTS = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$/; // a number and its unit, if it has one

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
