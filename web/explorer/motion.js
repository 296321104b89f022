// One motion of the pendulum: played with its drive beside the basins, its phase point and trace over them.

import { drawLine, drawPoints } from "./plane.js";
import { TURN } from "./window.js";
import { EXPLAINED, kindOf } from "./words.js";

const TRACE = 2.5; // drive periods of the bob's and the phase point's traces
const LONGEST = 32; // drive periods of a spectrum without a cycle
const START = 8; // px, radius of the ring at the start
const PAUSE = 1.5; // drive periods that the end is shown, before it begins anew

export class Motion {
  /** Of an answer to the request orbit: samples of theta and velocity, and the pivot's path over a drive period.
   * `cycle`: the answer for one period of the cycle in which it ends, from a strobe point; null where that is not
   * known. */
  constructor(header, bytes, ending, cycle = null) {
    const numbers = new Float64Array(bytes.buffer);
    this.theta = numbers.slice(0, header.samples);
    this.velocity = numbers.slice(header.samples);
    this.steady = cycle ? new Float64Array(cycle[1].buffer).slice(cycle[0].samples) : this.velocity;
    this.perPeriod = header.samples_per_period;
    this.pivot = header.pivot;
    this.ending = ending;
    this.at = 0; // the sample shown
    this.numbers = null;
  }

  get last() {
    return this.theta.length - 1;
  }

  get period() {
    return Math.floor(this.at / this.perPeriod + 1e-9);
  }

  /** Goes on by that many drive periods; from the end it begins anew. */
  advance(periods) {
    this.shown = (this.shown ?? 0) + periods;
    if (this.shown * this.perPeriod > this.last + PAUSE * this.perPeriod) this.shown = 0;
    this.at = Math.min(this.last, this.shown * this.perPeriod);
  }

  between(values) {
    const i = Math.min(Math.floor(this.at), this.last - 1);
    return values[i] + (this.at - i) * (values[i + 1] - values[i]);
  }

  /** [aside, height] of the pivot. */
  pivotAt(sample) {
    const first = Math.floor(sample);
    const [from, to] = [first, first + 1].map((i) => this.pivot[i % this.perPeriod]);
    return from.map((value, i) => value + (sample - first) * (to[i] - value));
  }

  /** Samples of the trace that ends at the present one. */
  trace() {
    const first = Math.max(0, Math.ceil(this.at - TRACE * this.perPeriod));
    return Array.from({ length: Math.floor(this.at) - first + 1 }, (_, i) => first + i);
  }

  /** The start, strobe points until now where they are wanted, the trace of the phase point, and the point itself in
   * the colour of its end. */
  drawOver(surface, plane, isStrobed, bob = "#ffffff") {
    const strobe = [];
    if (isStrobed) for (let i = 0; i <= this.at; i += this.perPeriod) strobe.push([this.theta[i], this.velocity[i]]);
    drawLine(
      surface,
      plane,
      this.trace().map((i) => [this.theta[i], this.velocity[i]]),
      "#1c2127c0",
      1.2,
    );
    drawPoints(surface, plane, strobe, surface.theme.mark, 3.2);
    const start = [[this.theta[0], this.velocity[0]]];
    drawPoints(surface, plane, start, "transparent", START);
    drawPoints(surface, plane, start, "transparent", START + 2, "#1c2127");
    drawPoints(surface, plane, [[this.between(this.theta), this.between(this.velocity)]], bob, 6.5, "#1c2127");
  }

  /** Numbers of all samples. */
  samples() {
    return (this.numbers ??= [...this.theta.keys()]);
  }

  /** The angle of a sample in [0, 2 pi): inverted is in the middle. */
  wrapped(i) {
    return this.theta[i] - TURN * Math.floor(this.theta[i] / TURN);
  }

  /** [[frequency, amplitude], ...] of the velocity, in drive frequencies up to `most`: of the cycle, as what is left of
   * the way there leaks between its lines; of the last LONGEST drive periods where the end has no period. */
  spectrum(most) {
    if (this.lines) return this.lines;
    const last = this.steady.length - 1;
    const settled = Math.floor(last / this.perPeriod - settledAfter(this.ending));
    const periods = this.ending.period > 0 ? this.ending.period : Math.max(1, Math.min(settled, LONGEST));
    const count = Math.min(last, periods * this.perPeriod);
    this.lines = [...Array(most * periods + 1).keys()].map((n) => {
      let [even, odd] = [0, 0];
      for (let i = 0; i < count; i++) {
        const angle = (TURN * ((n * i) % count)) / count;
        even += this.steady[last - count + i] * Math.cos(angle);
        odd += this.steady[last - count + i] * Math.sin(angle);
      }
      return [n / periods, ((n ? 2 : 1) * Math.hypot(even, odd)) / count];
    });
    return this.lines;
  }

  /** The pendulum on its shaker: pivot, rod, bob and the bob's trace. */
  drawPendulum(surface, width, height, units, slower) {
    const { theme } = surface;
    const most = Math.max(...this.pivot.flat().map(Math.abs));
    const rod = Math.min(width, height) / 2 / (1.12 + most);
    const place = (x, y) => [width / 2 + rod * x, height / 2 - rod * y];
    const bob = (angle, [aside, up]) => place(aside + Math.sin(angle), up - Math.cos(angle));
    const pivot = this.pivotAt(this.at);
    const angle = this.between(this.theta);
    const [x, y] = place(...pivot);
    const [, base] = place(0, -most);
    surface.rectangle(width / 2 - 0.16 * rod, base + 0.3 * rod, 0.32 * rod, height - base - 0.3 * rod, theme.shaker);
    surface.line([[x, y], [x, base + 0.34 * rod]], theme.faint, 0.1 * rod);
    surface.line([...this.pivot, this.pivot[0]].map((at) => place(...at)), theme.faint, 2);
    surface.line(this.trace().map((i) => bob(this.theta[i], this.pivotAt(i))), theme.trace, 2);
    surface.line([[x, y], bob(angle, pivot)], theme.ink, Math.max(3, 0.045 * rod));
    surface.circle(x, y, Math.max(4, 0.05 * rod), theme.ink, theme.ink);
    surface.circle(...bob(angle, pivot), Math.max(8, 0.12 * rod), theme.bob ?? theme.mark, theme.ink);
    surface.text(units.omega ? units.time(this.period) : `shake ${this.period}`, 6, height - 8, "left",
      { colour: theme.faint });
    if (slower) surface.text(`${Number(slower.toPrecision(2))} times slower than life`, 6, height - 28, "left",
      { colour: theme.faint });
  }

  /** Lines of time (drive radians), theta, velocity, the pivot's height and how far it is aside. */
  toCsv() {
    const lines = ["time_drive_radians,theta_rad,velocity_rad_per_drive_radian,pivot_height,pivot_aside"];
    for (let i = 0; i <= this.last; i++)
      lines.push([(TURN * i) / this.perPeriod, this.theta[i], this.velocity[i], ...this.pivotAt(i).reverse()]
        .join(","));
    return `${lines.join("\n")}\n`;
  }
}

/** Drive periods after which a start is near its end for good. */
export const settledAfter = ({ settling_time: certain, near_time: near }) => Math.max(certain ?? 0,
  Number.isFinite(near) ? near : 0);

/** Where a start ends, in plain words. */
export function plainEnding({ attractor, name }) {
  return attractor < 0 ? "This one does not settle" : `This one ends ${kindOf(name)}: it ${EXPLAINED[kindOf(name)]}`;
}

/** Where a start ends, with the evidence; `units`: of the page. */
export function endingWords(ending, units) {
  const [angle, speed] = units.start(ending);
  const from = `from θ = ${angle}, velocity ${speed}`;
  if (ending.attractor < 0) return `not settled\n${from}`;
  const near = Number.isFinite(ending.near_time) ? `, within 1° after ${units.time(ending.near_time)}` : "";
  const sure = ending.decided ? "decided: no rounding error can change this end"
    : `not decided: ${ending.name} or ${ending.other_name ?? "another"}`;
  const certain = ending.settling_time > 0 ? `certain after ${units.time(ending.settling_time)}` : "certain at once";
  return `ends on ${ending.name}: ${certain}${near}\n${from}\n${sure}`;
}
