// One motion of the pendulum: played with its drive beside the basins, its phase point and trace over them.

import { drawLine, drawPoints } from "./plane.js";
import { CanvasSurface } from "./surface.js";
import { TURN } from "./window.js";

const TRACE = 2.5; // drive periods of the bob's and the phase point's traces
const PAUSE = 1.5; // drive periods that the end is shown, before it begins anew

export class Motion {
  /** Of an answer to the request orbit: samples of theta and velocity, and the pivot's path over a drive period. */
  constructor(header, bytes, ending) {
    const numbers = new Float64Array(bytes.buffer);
    this.theta = numbers.slice(0, header.samples);
    this.velocity = numbers.slice(header.samples);
    this.perPeriod = header.samples_per_period;
    this.pivot = header.pivot;
    this.ending = ending;
    this.at = 0; // the sample shown
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

  /** Strobe points until now, the trace of the phase point, and the point itself. */
  drawOver(surface, plane) {
    const strobe = [];
    for (let i = 0; i <= this.at; i += this.perPeriod) strobe.push([this.theta[i], this.velocity[i]]);
    drawLine(
      surface,
      plane,
      this.trace().map((i) => [this.theta[i], this.velocity[i]]),
      "#1c2127c0",
      1.2,
    );
    drawPoints(surface, plane, strobe, surface.theme.mark, 3.2);
    drawPoints(surface, plane, [[this.between(this.theta), this.between(this.velocity)]], "#ffffff", 5.5, "#b3261e");
  }

  /** The pendulum: pivot, rod, bob and the bob's trace. */
  drawPendulum(canvas, theme, units) {
    const context = canvas.getContext("2d");
    const surface = new CanvasSurface(context, theme);
    const size = canvas.width;
    const most = Math.max(...this.pivot.flat().map(Math.abs));
    const rod = size / 2 / (1.12 + most);
    const place = (x, y) => [size / 2 + rod * x, size / 2 - rod * y];
    const bob = (angle, [aside, height]) => place(aside + Math.sin(angle), height - Math.cos(angle));
    const pivot = this.pivotAt(this.at);
    const angle = this.between(this.theta);
    context.clearRect(0, 0, size, size);
    surface.line(
      [...this.pivot, this.pivot[0]].map((at) => place(...at)),
      theme.faint,
      5,
    );
    surface.line(
      this.trace().map((i) => bob(this.theta[i], this.pivotAt(i))),
      theme.trace,
      1.5,
    );
    surface.line([place(...pivot), bob(angle, pivot)], theme.ink, 3);
    surface.circle(...place(...pivot), 4, theme.ink, theme.ink);
    surface.circle(...bob(angle, pivot), 9, theme.mark, theme.paper);
    surface.text(units.omega ? units.time(this.period) : `period ${this.period}`, 6, size - 8, "left", { size: 20 });
  }

  /** Lines of time (drive radians), theta, velocity, the pivot's height and how far it is aside. */
  toCsv() {
    const lines = ["time_drive_radians,theta_rad,velocity_rad_per_drive_radian,pivot_height,pivot_aside"];
    for (let i = 0; i <= this.last; i++)
      lines.push([(TURN * i) / this.perPeriod, this.theta[i], this.velocity[i], ...this.pivotAt(i).reverse()].join(","));
    return `${lines.join("\n")}\n`;
  }
}

/** Where a start ends, in words; `units`: of the page. */
export function endingWords(ending, units) {
  const from = `From θ = ${units.angle(ending.theta)}, velocity ${units.velocity(ending.velocity)}`;
  if (ending.attractor < 0) return `${from}\nnot settled`;
  const near = Number.isFinite(ending.near_time) ? `, within 1° of it after ${units.time(ending.near_time)}` : "";
  const sure = ending.decided ? `decided: ${ending.precision}` : `not decided: ${ending.name} or ${ending.other_name ?? "another"}`;
  return `${from}\nends on ${ending.name}: certain after ${units.time(ending.settling_time)}${near}\n${sure}`;
}
