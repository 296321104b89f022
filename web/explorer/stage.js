// The pendulum on its shaker, and what its motion looks like otherwise: trace, phase portrait, strobe points, spectrum.

import { fractionTicks, Plot } from "./plot.js";
import { CanvasSurface, lettersOf } from "./surface.js";

export const VIEWS = ["pendulum", "trace", "phase", "strobe", "spectrum"];
const RECENT = 8; // drive periods of the trace
const MOST_LINES = 3; // drive frequencies of the spectrum
const DECADES = 6;
const NO_LINES = ["At rest nothing moves:", "there are no lines."];
const SMALL = 500; // px, below which letters alone are enlarged
const LECTURE = 1.3; // how much larger everything is in one, beside letters
const POINT = 1 / 45; // radius of a strobe point, of the shorter side of its plot, and
const LEAST_POINT = 5; // px at least

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
  }

  /** One picture of a motion (null: none yet), in a view of VIEWS; `slower`: how many times slower than life it is, or
   * null. */
  draw(motion, view, theme, units, slower) {
    const { canvas } = this;
    canvas.classList.toggle("awaits", !motion); // the last picture of another motion stays, pale
    if (!motion) return;
    const letters = lettersOf(document.body);
    const zoom = letters === 1 || canvas.clientWidth < SMALL ? 1 : LECTURE;
    const ratio = zoom * (devicePixelRatio || 1);
    const [width, height] = [canvas.clientWidth / zoom, canvas.clientHeight / zoom];
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio))
      Object.assign(canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    if (width === 0) return;
    const surface = new CanvasSurface(context, theme, letters);
    if (view === "pendulum") motion.drawPendulum(surface, width, height, units, slower);
    else this[view](surface, motion, width, height);
  }

  /** Angle over time, up to the present. */
  trace(surface, motion, width, height) {
    const last = Math.floor(motion.at);
    const first = Math.max(0, last - RECENT * motion.perPeriod);
    const samples = [...Array(last - first + 1)].map((_, i) => first + i);
    const angles = samples.map((i) => motion.theta[i]);
    const plot = new Plot(surface, width, height, [first, first + RECENT * motion.perPeriod], spread(angles));
    plot.axes("drive periods", "angle θ", { up: { inPi: true }, across: { per: motion.perPeriod } });
    plot.line(samples.map((i, n) => [i, angles[n]]));
    plot.point(last, angles.at(-1));
  }

  /** Velocity over angle: the whole motion faint, the last of it strong. */
  phase(surface, motion, width, height) {
    const plot = this.plane(surface, motion, width, height);
    plot.line(motion.samples().map((i) => [motion.wrapped(i), motion.velocity[i]]), surface.theme.trace, 1);
    plot.line(motion.trace().map((i) => [motion.wrapped(i), motion.velocity[i]]), surface.theme.ink, 1.6);
    plot.point(motion.wrapped(Math.floor(motion.at)), motion.velocity[Math.floor(motion.at)]);
  }

  /** Angle and velocity once a drive period, on the cycle in which the motion ends. */
  strobe(surface, motion, width, height) {
    const plot = this.plane(surface, motion, width, height);
    const cycle = motion.ending.period > 0 ? motion.samples().slice(-motion.ending.period * motion.perPeriod - 1) : [];
    plot.line(cycle.map((i) => [motion.wrapped(i), motion.velocity[i]]), surface.theme.trace, 1.4);
    const radius = Math.max(LEAST_POINT, POINT * Math.min(width, height));
    for (let i = 0; i <= motion.at; i += motion.perPeriod) plot.point(motion.wrapped(i), motion.velocity[i], radius);
  }

  plane(surface, motion, width, height) {
    const samples = motion.samples();
    const plot = new Plot(surface, width, height, spread(samples.map((i) => motion.wrapped(i))),
      spread(motion.velocity));
    plot.axes("angle θ", "velocity", { across: { inPi: true } });
    return plot;
  }

  /** Amplitudes of the velocity after the motion has settled, over frequency. */
  spectrum(surface, motion, width, height) {
    const lines = motion.spectrum(MOST_LINES);
    const most = Math.max(...lines.map(([, amplitude]) => amplitude), 1);
    const plot = new Plot(surface, width, height, [0, MOST_LINES], [-DECADES, Math.log10(most) + 0.3]);
    plot.axes("drive frequencies", "log₁₀ velocity",
      { across: { ticks: fractionTicks(MOST_LINES, motion.ending.period) } });
    for (const [frequency, amplitude] of lines) {
      const level = Math.log10(amplitude);
      if (level > -DECADES) plot.line([[frequency, -DECADES], [frequency, level]], surface.theme.mark, 2);
    }
    if (lines.every(([, amplitude]) => Math.log10(amplitude) <= -DECADES)) plot.say(...NO_LINES);
  }
}

/** Limits a little beyond the values. */
function spread(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const beyond = Math.max(0.08 * (high - low), 1e-3);
  return [low - beyond, high + beyond];
}
