// Stories for a lecture: states of the page one after the other, each with a sentence. Where they come from:
// docs/reference/explorer.md.

import { nearestBoundary } from "./boundary.js";
import { NEUTRAL } from "./drive.js";
import { element } from "./element.js";
import { ask } from "./engine.js";
import { VIEWS } from "./stage.js";
import { numberOf, withUnit } from "./values.js";
import { Window } from "./window.js";

const GLIDE = 1.5; // seconds in which numbers of the pendulum go to their new values
const PACE = 10_000; // ms of a step that goes on by itself
const PRESENTER = { ArrowRight: 1, PageDown: 1, Enter: 1, " ": 1, ArrowLeft: -1, PageUp: -1, Backspace: -1 };
const KEPT = ["level", "title", "scene", "pendulum", "other", "pane", "pivotFrequency", "start", "window", "home",
  "whole", "view", "map", "speed", "lit", "pinned", "past", "undone"];
const texts = (pendulum) => Object.fromEntries(Object.entries(pendulum)
  .map(([name, value]) => [name, typeof value === "number" ? String(value) : value]));

export class Stories {
  /** @param {import("./state.js").State} state
   * @param {import("./basins.js").Basins} basins */
  constructor(state, basins) {
    this.state = state;
    this.basins = basins;
    this.story = this.known = null;
    this.step = 0;
    element("tell").onclick = () => (this.story ? this.end() : this.offer());
    element("show-me").onclick = async () => this.begin((await this.all())[0],
      !matchMedia("(prefers-reduced-motion: reduce)").matches);
    element("story-next").onclick = () => this.take(1);
    element("story-back").onclick = () => this.take(-1);
    element("story-end").onclick = () => this.end();
    addEventListener("keydown", (event) => this.key(event), true);
  }

  async all() {
    return (this.known ??= (await ask("stories")).stories);
  }

  /** Lists the stories. */
  async offer() {
    const known = await this.all();
    element("stories").querySelector("div").replaceChildren(
      ...known.map((story) => {
        const button = Object.assign(document.createElement("button"), { type: "button", textContent: story.title });
        button.onclick = () => {
          element("stories").close();
          this.begin(story);
        };
        return button;
      }),
    );
    element("stories").showModal();
  }

  /** Tells the story of a file. */
  async open(file) {
    const [story] = (await ask("stories", { text: await file.text(), name: file.name })).stories;
    this.begin(story);
  }

  /** Tells a story; `alone`: each step goes on by itself, until somebody takes the next or the one before. */
  begin(story, alone = false) {
    this.alone = alone;
    this.before ??= Object.fromEntries(KEPT.map((name) => [name, this.state[name]]));
    this.state.show("look");
    this.story = story;
    document.body.dataset.story = element("story-title").textContent = story.title;
    element("tell").setAttribute("aria-pressed", "true");
    document.documentElement.requestFullscreen?.().catch(() => {}); // the browser may not want it
    const whole = Window.from(story.window ?? this.state.whole.toRequest());
    const home = whole.centred(this.state.middle);
    const scene = { ...NEUTRAL, ...texts(story.pendulum) };
    this.state.change({
      title: story.title,
      scene,
      pendulum: scene,
      other: null,
      pane: "a",
      pivotFrequency: story.pivot_frequency,
      whole,
      home,
      window: home,
      map: "off",
      lit: null,
      pinned: null,
      past: [],
      undone: [],
    });
    this.step = -1;
    this.go(1);
  }

  end() {
    if (!this.story) return;
    this.story = null;
    this.gliding = null;
    clearTimeout(this.next);
    delete document.body.dataset.story;
    document.body.dataset.filled = "";
    element("tell").setAttribute("aria-pressed", "false");
    if (document.fullscreenElement) document.exitFullscreen();
    this.state.change({ ...this.before, jump: true });
    this.before = null;
  }

  key(event) {
    if (!this.story || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "Escape") this.end();
    else if (event.key in PRESENTER) this.take(PRESENTER[event.key]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** A step that somebody takes: from here on nothing goes on by itself. */
  take(by) {
    this.alone = false;
    this.go(by);
  }

  go(by) {
    const { steps } = this.story;
    this.step = Math.max(0, Math.min(steps.length - 1, this.step + by));
    this.alone &&= this.step < steps.length - 1;
    clearTimeout(this.next);
    if (this.alone) this.next = setTimeout(() => this.go(1), PACE);
    element("story-place").textContent = `${this.step + 1} / ${steps.length}${this.alone ? ", plays on" : ""}`;
    element("story-words").textContent = steps[this.step].say;
    element("story-back").disabled = this.step === 0;
    element("story-next").disabled = this.step === steps.length - 1;
    this.show(steps.slice(0, this.step + 1));
  }

  /** The state after some steps: each changes what it names, and what it does not name stays as it was. */
  show(steps) {
    const all = Object.assign({ view: VIEWS[0], fill: "", map: "off", speed: 1, start: null,
      window: this.state.home.toRequest() }, ...steps);
    const { window, boundary } = steps.findLast((step) => step.window || step.boundary) ?? {};
    const pendulum = Object.assign({ ...this.state.scene }, ...steps.map((step) => texts(step.pendulum ?? {})));
    const start = all.start && { theta: String(all.start.theta), velocity: String(all.start.velocity), pane: "a" };
    document.body.dataset.filled = all.fill;
    const to = boundary ? this.state.window : window ? Window.from(window) : this.state.home;
    this.state.change({ view: all.view, map: all.map, speed: all.speed, start, window: to, jump: false, playing: true,
      lit: null, pinned: null });
    this.busy = (this.busy ?? 0) + 1; // shows that go on
    this.glide(pendulum, steps.at(-1).glide ?? GLIDE, () => boundary && this.zoomTo(boundary)).finally(
      () => this.busy--);
  }

  /** Numbers go to their new values in so many seconds; then `after`. */
  async glide(pendulum, seconds, after) {
    const mine = (this.gliding = {});
    const from = this.state.pendulum;
    const moving = Object.keys(pendulum).filter((name) => from[name] !== pendulum[name]);
    const begun = performance.now();
    for (let part = 0; part < 1 && moving.length; ) {
      await new Promise(requestAnimationFrame);
      if (this.gliding !== mine) return;
      part = Math.min(1, (performance.now() - begun) / (1000 * seconds));
      const between = moving.map((name) => [name, part < 1 ? mixed(from[name], pendulum[name], part) : pendulum[name]]);
      this.state.change({ pendulum: { ...from, ...Object.fromEntries(between) } });
    }
    await after();
  }

  /** The nearest boundary, in a window so many times narrower than the first one. */
  async zoomTo(depth) {
    const mine = this.gliding;
    try {
      const window = await nearestBoundary(this.basins.active, this.state.home.zoomed(1 / depth, 0.5, 0.5));
      if (mine === this.gliding && this.story) this.state.change({ window: window.wrapped(), jump: false });
    } catch (error) {
      element("story-words").textContent = error.message;
    }
  }
}

/** Between two values; words change at once. */
function mixed(from, to, part) {
  const [one, other] = [numberOf(from), numberOf(to)];
  if (!one || !other || one.unit !== other.unit) return to;
  return withUnit(Number((one.number + part * (other.number - one.number)).toPrecision(5)), other.unit);
}
