// The place of a deep window in the whole: a small picture of the first window with a mark, from a depth of 10 on.

import { shadingOf } from "./heights.js";
import { Painter2d } from "./painter2d.js";
import { CanvasSurface } from "./surface.js";

const DEPTH = 10;
const LEAST = 7; // px of the mark

export class Inset {
  /** @param {HTMLElement} root the button, which holds a canvas
   * @param {import("./state.js").State} state */
  constructor(root, state) {
    this.root = root;
    this.state = state;
    this.canvas = root.querySelector("canvas");
    this.painter = new Painter2d(this.canvas);
    this.frame = null;
    root.onclick = () => (state.change({ jump: false }), state.visit(state.home));
  }

  /** Whether a window is deep enough, and no frame of that pendulum is there. */
  wants(window, key) {
    return this.isDeep(window) && !(this.frame?.key === key && this.frame.window.equals(this.state.home));
  }

  isDeep(window) {
    return this.state.home.theta.width / window.theta.width >= DEPTH;
  }

  get size() {
    return { width: this.canvas.width / 2, height: this.canvas.height / 2 };
  }

  draw(window) {
    this.root.hidden = !(this.frame && this.isDeep(window));
    if (this.root.hidden) return;
    const { width, height } = this.canvas;
    this.painter.draw([this.frame], this.frame.window, shadingOf("none"));
    const place = this.frame.window.placeOf(window);
    const [x, y] = [(place.left + place.width / 2) * width, (1 - place.bottom - place.height / 2) * height];
    const [across, up] = [(place.width * width) / 2, (place.height * height) / 2].map((half) => Math.max(LEAST, half));
    const surface = new CanvasSurface(this.painter.context);
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]].map(([i, j]) => [x + i * across, y + j * up]);
    surface.line(corners, "#ffffff", 6);
    surface.line(corners, "#b3261e", 3);
  }
}
