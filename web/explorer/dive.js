// A dive: two starts with different ends are clicked, the boundary between them is found by halving, and the window
// goes down to it.

import { endOf, halvings, nearestBoundary } from "./boundary.js";
import { Decimal } from "./decimal.js";
import { element } from "./element.js";
import { Window } from "./window.js";

const DEEPEST = 1e-20; // distance at which halving ends, of the distance of the two starts
const SPEED = 1.5; // natural logarithm by which the window shrinks in a second
const nextPicture = () => new Promise((resolve) => requestAnimationFrame(resolve));

export class Dive {
  /** @param {import("./state.js").State} state
   * @param {import("./basins.js").Basins} basins
   * @param {(words: string) => void} say */
  constructor(state, basins, say) {
    this.state = state;
    this.basins = basins;
    this.say = say;
    this.order = 0;
  }

  toggle() {
    if (this.basins.onClick || this.diving) return this.stop();
    this.starts = [];
    this.basins.onClick = (pane, start) => this.take(pane, start);
    element("dive").setAttribute("aria-pressed", "true");
    this.say("Dive: click two starts that end on different attractors.");
  }

  stop() {
    this.order++;
    this.diving = false;
    this.basins.onClick = null;
    this.mark([]);
    element("dive").setAttribute("aria-pressed", "false");
    this.basins.say(this.basins.panes[0]); // what the status line said before
  }

  /** Shows starts, [theta, velocity] as Decimals. */
  mark(starts) {
    for (const pane of this.basins.panes) {
      pane.plain.marks = starts;
      pane.draw();
    }
  }

  async take(pane, { theta, velocity }) {
    const order = this.order;
    const start = [Decimal.from(theta), Decimal.from(velocity)];
    const end = await endOf(pane, start);
    if (order !== this.order) return;
    if (this.starts.length && this.end === end) return this.say(
      "Dive: both starts end on the same attractor. Click another one.");
    this.starts.push(start);
    this.mark(this.starts);
    if (this.starts.length < 2) {
      this.end = end;
      return this.say("Dive: click a start that ends on another attractor.");
    }
    await this.run(async () => this.go(order, await this.boundary(order, pane)));
  }

  /** Moves the window, as it is, to the nearest boundary. */
  nearest(pane) {
    if (this.basins.onClick || this.diving) this.stop();
    this.say("Looking for the nearest boundary …");
    return this.run(async (order) => {
      const before = this.state.window;
      const window = await nearestBoundary(pane, before);
      if (order !== this.order || before !== this.state.window) return;
      this.state.change({ jump: false });
      this.state.visit(window.wrapped());
    });
  }

  /** Does what takes long, until it is done or stopped. */
  async run(action) {
    const { order } = this;
    this.basins.onClick = null;
    this.diving = true;
    let failure = null;
    try {
      await action(order);
    } catch (error) {
      failure = error.message;
    }
    if (order !== this.order) return;
    this.stop();
    if (failure) this.say(failure);
  }

  /** The point between the two starts beyond which the end changes; halved until they are DEEPEST apart. The marks show
   * it. */
  async boundary(order, pane) {
    for await (const [one, other, share] of halvings(pane, ...this.starts, this.end)) {
      if (order !== this.order || share <= DEEPEST) return one;
      this.mark([one, other]);
      this.say(`Dive: the boundary is known to ${share.toExponential(1)} of the distance of the starts.`);
    }
  }

  /** Down to the point, whose place comes nearer to the middle, at the same speed however often pictures come. */
  async go(order, [theta, velocity]) {
    const deepest = this.state.window.theta.width * DEEPEST * 100;
    this.state.keep();
    for (let last = performance.now(); order === this.order && this.state.window.theta.width > deepest;) {
      const { window } = this.state;
      const seconds = Math.min(0.5, (performance.now() - last) / 1000);
      last += 1000 * seconds;
      const around = (range, point) => {
        const share = range.shareOf(point);
        const scaled = range.scaled(Math.exp(-SPEED * seconds), share);
        return scaled.moved((share - 0.5) * Math.min(1, 3 * seconds));
      };
      this.state.change({ window: new Window(around(window.theta, theta), around(window.velocity, velocity)),
        jump: true });
      await nextPicture();
    }
  }
}
