// The window of starts that is looked at: edges in theta and velocity, to as many digits as its width asks for.

import { Decimal, digitsFor, turn } from "./decimal.js";

export const TURN = 2 * Math.PI;
const NARROWEST = 1e-100;
const FASTEST = 1e4; // of edges in velocity
const WHOLE = 1e-3; // rad by which a whole circle may differ from a turn
const DEEP = 1e-7; // windows narrower than that are named by centre and width, wider ones by their edges

/** One axis of a window. */
export class Range {
  constructor(low, high) {
    this.low = low;
    this.high = high;
    this.width = high.minus(low).toNumber();
  }

  /** Of what a scene or an address holds: {min, max} or {centre, width}, as texts or numbers. */
  static from({ min, max, centre, width }) {
    if (centre === undefined) return new Range(Decimal.from(min), Decimal.from(max));
    const half = Decimal.from(width).half();
    return new Range(Decimal.from(centre).minus(half), Decimal.from(centre).plus(half));
  }

  get centre() {
    return this.low.plus(this.high).half();
  }

  /** Where a number lies: 0 at the lower edge, 1 at the upper. */
  shareOf(value) {
    return value.minus(this.low).toNumber() / this.width;
  }

  /** The number at that share of the width. */
  at(share) {
    return this.low.moved(this.width, share);
  }

  moved(share) {
    const step = Decimal.from(this.width * share).rounded(digitsFor(this.width));
    return new Range(this.low.plus(step), this.high.plus(step));
  }

  /** Scaled by `factor` about the number at `share`. */
  scaled(factor, share) {
    const width = this.width * factor;
    const low = this.low.moved(this.width, share).moved(width, -share).rounded(digitsFor(width));
    return new Range(low, low.plus(Decimal.from(width)).rounded(digitsFor(width)));
  }

  /** Shifted so that no edge lies beyond -limit or limit. */
  within(limit) {
    const [least, most] = [Decimal.from(-limit), Decimal.from(limit)];
    if (this.width >= 2 * limit) return new Range(least, most);
    const wide = this.high.minus(this.low);
    if (this.low.toNumber() < -limit) return new Range(least, least.plus(wide));
    return this.high.toNumber() > limit ? new Range(most.minus(wide), most) : this;
  }

  /** Between this range (0) and another (1). */
  towards(other, part) {
    const width = Math.min(this.width, other.width);
    const between = (from, to) => from.plus(Decimal.from(to.minus(from).toNumber() * part)).rounded(digitsFor(width));
    return new Range(between(this.low, other.low), between(this.high, other.high));
  }

  /** As requests and scenes name it. */
  toRequest() {
    if (this.width > DEEP) return { min: this.low.toNumber(), max: this.high.toNumber() };
    return { centre: this.centre.rounded(digitsFor(this.width)).toString(), width: String(this.width) };
  }

  equals(other) {
    return this.low.minus(other.low).scaled === 0n && this.high.minus(other.high).scaled === 0n;
  }
}

/** A window: ranges of theta (rad, at most a turn) and velocity (rad per drive radian). */
export class Window {
  constructor(theta, velocity) {
    this.theta = theta;
    this.velocity = velocity;
  }

  static from({ theta, velocity }) {
    return new Window(Range.from(theta), Range.from(velocity));
  }

  /** Scaled about the point at shares x, y; as far as windows can go. */
  zoomed(factor, x, y) {
    const most = TURN / this.theta.width;
    const least = NARROWEST / Math.min(this.theta.width, this.velocity.width);
    const bounded = Math.max(factor, Math.min(1, least));
    const theta = bounded < most ? this.theta.scaled(bounded, x) : this.wholeCircle(x);
    return new Window(theta, this.velocity.scaled(bounded, y).within(FASTEST)).wrapped();
  }

  /** The range of a whole turn that keeps the angle at share x where it is; [-pi, pi) itself where that is near. */
  wholeCircle(x) {
    const whole = turn(30);
    if (this.theta.width === TURN) return this.theta;
    const low = this.theta.at(x).moved(TURN, -x);
    return new Range(low, low.plus(whole));
  }

  moved(x, y) {
    return new Window(this.theta.moved(x), this.velocity.moved(y).within(FASTEST));
  }

  /** A whole circle with inverted or down (hanging in old addresses) in its middle; others stay as they are. */
  centred(middle) {
    if (Math.abs(this.theta.width - TURN) > WHOLE) return this;
    const half = turn(30).half();
    const low = ["down", "hanging"].includes(middle) ? Decimal.from(0).minus(half) : Decimal.from(0);
    return new Window(new Range(low, low.plus(turn(30))), this.velocity);
  }

  /** The same window with its middle angle in [-pi/2, 3 pi/2): neither down nor inverted lies at the ends. */
  wrapped() {
    const digits = digitsFor(this.theta.width);
    const turns = Math.floor((this.theta.centre.toNumber() + Math.PI / 2) / TURN);
    if (turns === 0 || !Number.isFinite(turns)) return this;
    const whole = turn(digits + 10);
    const shift = new Decimal(whole.scaled * BigInt(-turns), whole.digits).rounded(digits);
    return new Window(new Range(this.theta.low.plus(shift), this.theta.high.plus(shift)), this.velocity);
  }

  towards(other, part) {
    return new Window(this.theta.towards(other.theta, part), this.velocity.towards(other.velocity, part));
  }

  /** Where another window lies in this one: left, bottom, width, height as shares; angles the short way round. */
  placeOf(other) {
    let left = this.theta.shareOf(other.theta.low);
    const period = TURN / this.theta.width;
    const width = other.theta.width / this.theta.width;
    left -= period * Math.round((left + width / 2 - 0.5) / period);
    return { left, bottom: this.velocity.shareOf(other.velocity.low), width,
      height: other.velocity.width / this.velocity.width };
  }

  toRequest() {
    return { theta: this.theta.toRequest(), velocity: this.velocity.toRequest() };
  }

  equals(other) {
    return this.theta.equals(other.theta) && this.velocity.equals(other.velocity);
  }
}
