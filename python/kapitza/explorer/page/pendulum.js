// The pendulum played from the samples that the program computed: pivot, rod, bob and the bob's trace.

class Player {
  constructor(canvas, onPeriod) {
    this.canvas = canvas;
    this.onPeriod = onPeriod;
    this.motion = null;
    requestAnimationFrame((now) => this.frame(now));
  }

  play(motion) {
    this.motion = motion;
    this.begun = performance.now();
    this.shown = -1;
  }

  // The sample at which a second of a person's time shows 1.2 drive periods; the end stays, then it begins anew.
  frame(now) {
    if (this.motion) {
      const { time } = this.motion, step = time[1] - time[0], last = time.length - 1;
      const at = (now - this.begun) / 1000 * 1.2 * TURN / step;
      if (at > last + 1.5 * TURN / step) this.begun = now;
      this.draw(Math.min(at, last));
      const period = Math.floor(Math.min(at, last) * step / TURN + 1e-6);
      if (period !== this.shown) this.onPeriod(this.shown = period);
    }
    requestAnimationFrame((next) => this.frame(next));
  }

  // Where the bob is at sample i, counted from the pivot's mean place, in rod lengths, upward.
  bob(i) {
    const { theta, pivot } = this.motion;
    return [Math.sin(theta[i]), pivot[i] - Math.cos(theta[i])];
  }

  draw(at) {
    const { theta, pivot } = this.motion, i = Math.floor(at), j = Math.min(i + 1, theta.length - 1), part = at - i;
    const between = (values) => values[i] + part * (values[j] - values[i]);
    const c = this.canvas.getContext("2d"), size = this.canvas.width, most = Math.max(...pivot.slice(0, 64).map(Math.abs));
    const rod = size / 2 / (1.12 + most), place = ([x, y]) => [size / 2 + rod * x, size / 2 - rod * y];
    const angle = between(theta), height = between(pivot);
    const pivotAt = place([0, height]), bobAt = place([Math.sin(angle), height - Math.cos(angle)]);
    const surface = new CanvasSurface(c);
    surface.rectangle(0, 0, size, size, "#ffffff");
    surface.line([place([0, -most]), place([0, most])], "#d5dce3", 6);
    const trace = [];
    for (let k = Math.max(0, i - 144); k <= i; k++) trace.push(place(this.bob(k)));
    surface.line(trace, "#a9c4df", 1.5);
    surface.line([pivotAt, bobAt], INK, 3);
    surface.circle(...pivotAt, 4, INK, INK);
    surface.circle(...bobAt, 9, "#b3261e", "#ffffff");
    surface.text(`period ${Math.floor(between(this.motion.time) / TURN + 1e-6)}`, 6, size - 8, "left", 12);
  }
}
