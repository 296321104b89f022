// The pendulum on its shaker, and what its motion looks like otherwise: trace, phase portrait, strobe points, spectrum.

import { CanvasSurface, lettersOf } from "./surface.js";
import { signed } from "./ticks.js";

export const VIEWS = ["pendulum", "trace", "phase", "strobe", "spectrum"];
const RECENT = 8; // drive periods of the trace
const MOST_LINES = 3; // drive frequencies of the spectrum
const DECADES = 6;
const SMALL = 500; // px, below which nothing is enlarged
const LECTURE = 1.3; // how much larger everything is in one, beside letters
const MARGIN = { left: 48, right: 10, top: 12, bottom: 30 };

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
  }

  /** One picture of a motion (null: none yet), in a view of VIEWS; `slower`: how many times slower than life it is, or null. */
  draw(motion, view, theme, units, slower) {
    const { canvas } = this;
    canvas.classList.toggle("awaits", !motion); // the last picture of another motion stays, pale
    if (!motion) return;
    const letters = canvas.clientWidth < SMALL ? 1 : lettersOf(document.body);
    const zoom = letters === 1 ? 1 : LECTURE;
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
    plot.axes("drive periods", "θ", (sample) => sample / motion.perPeriod);
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

  /** Angle and velocity once a drive period. */
  strobe(surface, motion, width, height) {
    const plot = this.plane(surface, motion, width, height);
    for (let i = 0; i <= motion.at; i += motion.perPeriod) plot.point(motion.wrapped(i), motion.velocity[i], 4);
  }

  plane(surface, motion, width, height) {
    const samples = motion.samples();
    const plot = new Plot(surface, width, height, spread(samples.map((i) => motion.wrapped(i))), spread(motion.velocity));
    plot.axes("θ", "velocity", (angle) => angle);
    return plot;
  }

  /** Amplitudes of the velocity after the motion has settled, over frequency. */
  spectrum(surface, motion, width, height) {
    const lines = motion.spectrum(MOST_LINES);
    const most = Math.max(...lines.map(([, amplitude]) => amplitude), 1);
    const plot = new Plot(surface, width, height, [0, MOST_LINES], [-DECADES, Math.log10(most) + 0.3]);
    plot.axes("drive frequencies", "log₁₀ velocity", (frequency) => frequency);
    for (const [frequency, amplitude] of lines) {
      const level = Math.log10(amplitude);
      if (level > -DECADES) plot.line([[frequency, -DECADES], [frequency, level]], surface.theme.mark, 2);
    }
  }
}

/** Limits a little beyond the values. */
function spread(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const beyond = Math.max(0.08 * (high - low), 1e-3);
  return [low - beyond, high + beyond];
}

/** A small plot with limits along both axes. */
class Plot {
  constructor(surface, width, height, [left, right], [low, high]) {
    Object.assign(this, { surface, left, right, low, high });
    const margin = MARGIN.left * (surface.letters ?? 1); // room for numbers such as −0.037
    this.box = [margin, MARGIN.top, width - margin - MARGIN.right, height - MARGIN.top - MARGIN.bottom];
  }

  place([x, y]) {
    const [left, top, width, height] = this.box;
    return [left + ((x - this.left) / (this.right - this.left)) * width, top + (1 - (y - this.low) / (this.high - this.low)) * height];
  }

  line(points, colour = this.surface.theme.ink, width = 1.4) {
    const run = [];
    const flush = () => run.length > 1 && this.surface.line(run, colour, width);
    for (const [i, point] of points.entries()) {
      const wraps = i && this.right - this.left < 8 && Math.abs(point[0] - points[i - 1][0]) > Math.PI; // round the circle
      if (wraps) (flush(), (run.length = 0));
      run.push(this.place(point));
    }
    flush();
  }

  point(x, y, radius = 5) {
    this.surface.circle(...this.place([x, y]), radius, this.surface.theme.mark, this.surface.theme.paper);
  }

  axes(across, up, value) {
    const [left, top, width, height] = this.box;
    const { surface } = this;
    const small = { size: 11, colour: surface.theme.faint };
    surface.line([[left, top], [left, top + height], [left + width, top + height]], surface.theme.faint, 1);
    const brief = (number) => signed(String(Number(number.toPrecision(2))));
    surface.text(brief(value(this.left)), left, top + height + 14, "left", small);
    surface.text(brief(value(this.right)), left + width, top + height + 14, "right", small);
    surface.text(across, left + width / 2, top + height + 14, "center", small);
    surface.text(brief(this.high), left - 4, top + 9, "right", small);
    surface.text(brief(this.low), left - 4, top + height, "right", small);
    surface.text(up, left - 8, top + height / 2, "center", { ...small, turned: true });
  }
}
