// Numbers in the units of the axes: rad or degrees, and of a scene in SI velocities in rad/s and times in s.

import { Decimal } from "./decimal.js";
import { degrees } from "./ticks.js";
import { TURN } from "./window.js";

const BEYOND = 21; // digits of a start that the width of its window does not need,
const FEWEST = 4; // and digits that it has at least

/** Digits behind the point that a start given as a text has, without those that nobody reads. */
const digitsOf = (text) => Math.max(FEWEST, (text.split(".")[1] ?? "").length - BEYOND);

/** The units that the page has chosen; `pivotFrequency`: rad/s, or null where the scene does not say. */
export class Units {
  constructor(name, pivotFrequency) {
    this.degrees = name === "degrees";
    this.omega = name === "si" ? pivotFrequency : null;
  }

  /** An angle (decimal text, rad) in words. */
  angle(text, digits = digitsOf(text)) {
    return this.degrees ? `${Decimal.from(text).times(degrees(text.length)).rounded(digits)}°` : text;
  }

  /** A velocity (decimal text, rad per drive radian) in words. */
  velocity(text, digits = digitsOf(text)) {
    return this.omega ? `${Decimal.from(text).times(Decimal.from(this.omega)).rounded(digits)} rad/s` : text;
  }

  /** A start, {theta, velocity} as decimal texts, in words: without the digits that nobody reads. */
  start({ theta, velocity }) {
    const rounded = (text) => Decimal.from(text).rounded(digitsOf(text)).toString();
    const [angle, speed] = [this.degrees ? theta : rounded(theta), this.omega ? velocity : rounded(velocity)];
    return [this.angle(angle), this.velocity(speed)];
  }

  /** A time (drive periods) in words. */
  time(periods) {
    if (this.omega) return `${Number(((periods * TURN) / this.omega).toPrecision(4))} s`;
    return `${periods} drive period${periods === 1 ? "" : "s"}`;
  }

  /** Frequencies (of the drive's) with the words `about` behind each, in words. */
  frequencies(pairs) {
    const words = pairs.map(([frequency, about]) =>
      `${Number((frequency * (this.omega ? this.omega / TURN : 1)).toPrecision(3))} (${about})`);
    return `${words.join(", ")} ${this.omega ? "Hz" : "drive frequencies"}`;
  }
}
