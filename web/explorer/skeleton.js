// What a boundary is made of: a click on it shows the saddles and their stable manifolds, another one takes them away.

import { edgeNear } from "./boundary.js";
import { stream } from "./engine.js";
import { asScene } from "./frames.js";
import { placementOf } from "./placement.js";

const NEAR = 3; // px from a boundary that a click may be
const DEEPEST = 30; // the curves are drawn in steps that are seen in deeper windows

/** Whether a place of a pane (shares of its window) lies on a boundary. */
export function isOnBoundary(pane, across, up) {
  const frame = pane.top;
  if (!frame) return false;
  const { place, period } = placementOf(frame, pane.window);
  const x = (across - place[0]) / place[2];
  return edgeNear(frame, x - period * Math.floor(x / period), (up - place[1]) / place[3], NEAR / (pane.basins.clientWidth || 1)) !== null;
}

export class Skeleton {
  constructor(state, basins, say) {
    Object.assign(this, { state, basins, say });
  }

  /** Shows the skeleton of a pane's pendulum, or takes it away. */
  async toggle(pane) {
    if (pane.plain.skeleton) return this.put(pane, null);
    if (this.state.home.theta.width / this.state.window.theta.width > DEEPEST) return;
    const { pendulum } = pane;
    const { low, high } = this.state.whole.velocity;
    const fastest = Math.max(Math.abs(low.toNumber()), Math.abs(high.toNumber()));
    this.say("Looking for the saddles of this boundary …");
    try {
      for await (const [header] of stream("skeleton", { pendulum: asScene(pendulum), fastest })) {
        if (pendulum !== pane.pendulum) return;
        if (header.answer === "error") throw new Error(header.message);
        if (header.answer === "skeleton") this.put(pane, Object.values(header.overlays));
      }
      this.say("The boundary is made of the stable manifolds (lines) of saddles (white points): starts on them go to no attractor.");
    } catch (error) {
      this.say(`No saddles: ${error.message}`);
    }
  }

  put(pane, skeleton) {
    pane.plain.skeleton = skeleton;
    pane.draw();
  }
}
