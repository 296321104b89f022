// A dive: two starts with different ends are clicked, the boundary between them is found by halving, and the window goes down to it.

import { Decimal } from "./decimal.js";
import { asScene } from "./frames.js";
import { Window } from "./window.js";

const DEEPEST = 1e-20; // distance at which halving ends, of the distance of the two starts
const SPEED = 1.5; // natural logarithm by which the window shrinks in a second
const element = (id) => document.getElementById(id);
const nextPicture = () => new Promise((resolve) => requestAnimationFrame(resolve));

export class Dive {
  constructor(state, basins, say) {
    Object.assign(this, { state, basins, say, order: 0 });
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

  mark(starts) {
    for (const pane of this.basins.panes) {
      pane.plain.marks = starts.map(({ theta, velocity }) => [theta, velocity]);
      pane.draw();
    }
  }

  async take(pane, start) {
    const order = this.order;
    const end = await this.endOf(pane, start);
    if (order !== this.order) return;
    this.starts.push({ ...start, end });
    this.mark(this.starts);
    if (this.starts.length < 2) return this.say("Dive: click a start that ends on another attractor.");
    if (this.starts[0].end === end) {
      this.starts.pop();
      this.mark(this.starts);
      return this.say("Dive: both starts end on the same attractor. Click another one.");
    }
    this.basins.onClick = null;
    this.diving = true;
    let failure = null;
    try {
      await this.go(order, await this.boundary(order, pane));
    } catch (error) {
      failure = error.message;
    }
    if (order === this.order) this.stop();
    if (failure) this.say(failure);
  }

  async endOf(pane, { theta, velocity }) {
    const request = { request: "where", theta, velocity, pendulum: asScene(pane.pendulum) };
    return (await pane.engine.answer(request))[0].attractor;
  }

  /** The point between the two starts beyond which the end changes; halved until they are DEEPEST apart. */
  async boundary(order, pane) {
    let [one, other] = this.starts.map(({ theta, velocity }) => [Decimal.from(theta), Decimal.from(velocity)]);
    const first = this.starts[0].end;
    for (let distance = 1; distance > DEEPEST && order === this.order; distance /= 2) {
      const middle = [0, 1].map((axis) => one[axis].plus(other[axis]).half());
      const end = await this.endOf(pane, { theta: middle[0].toString(), velocity: middle[1].toString() });
      if (end === first) one = middle;
      else other = middle;
      this.say(`Dive: the boundary is known to ${(distance / 2).toExponential(1)} of the distance of the starts.`);
    }
    return one;
  }

  /** Down to the point, whose place comes nearer to the middle, at the same speed however often pictures come. */
  async go(order, [theta, velocity]) {
    const deepest = this.state.window.theta.width * DEEPEST * 100;
    this.state.past.push(this.state.window);
    for (let last = performance.now(); order === this.order && this.state.window.theta.width > deepest;) {
      const { window } = this.state;
      const seconds = Math.min(0.5, (performance.now() - last) / 1000);
      last += 1000 * seconds;
      const around = (range, point) => {
        const share = range.shareOf(point);
        const scaled = range.scaled(Math.exp(-SPEED * seconds), share);
        return scaled.moved((share - 0.5) * Math.min(1, 3 * seconds));
      };
      this.state.change({ window: new Window(around(window.theta, theta), around(window.velocity, velocity)), jump: true });
      await nextPicture();
    }
  }
}
