// What boundaries are made of: saddles and their stable manifolds, where they are asked for.

import { element } from "./element.js";
import { stream } from "./engine.js";
import { asScene } from "./frames.js";

const DEEPEST = 30; // the curves are drawn in steps that are seen in deeper windows

export class Skeleton {
  /** @param {import("./state.js").State} state
   * @param {import("./basins.js").Basins} basins
   * @param {(words: string) => void} say */
  constructor(state, basins, say) {
    this.state = state;
    this.basins = basins;
    this.say = say;
  }

  /** Shows the skeleton of a pane's pendulum, or takes it away. */
  async toggle(pane) {
    if (pane.plain.skeleton) return this.put(pane, null);
    if (this.state.home.theta.width / this.state.window.theta.width > DEEPEST) return this.say(
      "The lines of saddles are too coarse for so deep a window.");
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
      this.say("The boundary is made of the stable manifolds (lines) of saddles (white points): " +
        "starts on them go to no attractor.");
    } catch (error) {
      this.say(`No saddles: ${error.message}`);
    }
  }

  put(pane, skeleton) {
    pane.plain.skeleton = skeleton;
    element("saddles").setAttribute("aria-pressed", String(Boolean(skeleton)));
    pane.draw();
  }
}
