// The map: a plane of two keys of the pendulum, its curves, and the point of the pendulum, which hands move.

import { chartPicture, regionPicture, regionWords } from "./backdrop.js";
import { Decimal } from "./decimal.js";
import { element } from "./element.js";
import { Engine } from "./engine.js";
import { listen } from "./gestures.js";
import { atlases, axisAround, charts, othersOf, shareOf, usualKeys, valueAt } from "./map_plane.js";
import { happening } from "./crossings.js";
import { drawAxes, drawPlace, Plane } from "./plane.js";
import { CanvasSurface, lettersOf } from "./surface.js";
import { keyWords } from "./values.js";
import { Range } from "./window.js";

const CHART = 1200; // ms that the curves may take; where they take more, a chart stands in for them
const REST = 900; // ms without a change of other keys, after which the map is made anew
const REACH = 7; // px within which a curve is named
const STEP = 0.01; // of the map that an arrow moves the point
const DASHES = { fold: [], period_doubling: [6, 3], symmetry_breaking: [2, 2], rest_swings: [6, 3],
  rest_leans: [2, 2] };
const [FEW, MANY] = [2, 4]; // drive periods of motions whose curves are drawn, at most, and where more are asked for
const CURVE = "#5a646e";
const PENDING = "One start near inverted:";
const HATCHES = 9; // px between lines over what is not computed yet

/** Lines over a place of which the motions are not known yet.
 * @param {CanvasSurface} surface @param {number[]} box */
function hatch(surface, [left, top, width, height]) {
  for (let x = left - height; x < left + width; x += HATCHES) {
    const line = [[x, top + height], [x + height, top]];
    surface.line(line, surface.theme.paper, 2.4);
  }
}

/** Takes all answers, until nobody wants them; what went wrong, or null. */
async function taken(answers, take, signal) {
  try {
    for await (const answer of answers) {
      if (signal.aborted) return null;
      take(answer);
    }
    return null;
  } catch (error) {
    return error;
  }
}

export class MotionMap {
  /** @param {import("./state.js").State} state
   * @param {string[]} names of the keys of the pendulum
   * @param {object} calls `set` gives the pendulum other values; `say` is called with what happens on the way
   * @param {(values: object) => void} calls.set
   * @param {(words: string) => void} calls.say */
  constructor(state, names, { set, say }) {
    this.state = state;
    this.set = set;
    this.say = say;
    this.root = element("map");
    this.atlas = this.picture = null;
    this.engine = new Engine("chart");
    this.over = this.root.querySelector(".over");
    this.ground = this.root.querySelector(".ground");
    this.bubble = this.root.querySelector(".bubble");
    this.lists = [...this.root.querySelectorAll("select")];
    for (const list of this.lists) list.onchange = () => this.choose(...this.lists.map(({ value }) => value));
    element("map-more").onclick = () => state.change({ curves: state.curves === "few" ? "all" : "few" });
    listen(this.over, this.hands());
    this.over.addEventListener("keydown", (event) => this.arrow(event));
    new ResizeObserver(() => this.draw()).observe(this.root);
    state.listen((keys) => this.changed(keys));
    this.rename(names);
  }

  /** Other keys may be chosen: another scene is shown. */
  rename(names) {
    this.names = names;
    for (const list of this.lists) list.replaceChildren(...names.map((name) => new Option(keyWords(name), name)));
    this.forget();
    this.show();
  }

  get isOpen() {
    return this.state.map === "on" && this.names.length > 1;
  }

  /** The pendulum that the sliders move. */
  get pendulum() {
    return (this.state.pane === "b" && this.state.other) || this.state.pendulum;
  }

  /** Where it lies on the plane. */
  get place() {
    return this.axes.map((axis) => shareOf(axis, this.pendulum));
  }

  get isInside() {
    return this.place.every((share) => share >= 0 && share <= 1);
  }

  show() {
    this.root.hidden = !this.isOpen;
    element("map-more").setAttribute("aria-pressed", String(this.state.curves === "all"));
    const keys = usualKeys(this.names);
    const known = keys.every((name) => name in this.pendulum); // not between two scenes, whose names come at once
    if (this.isOpen && !this.axes && known) this.choose(...keys);
    else if (!this.isOpen) this.forget();
  }

  forget() {
    this.controller?.abort();
    if (this.axes) this.engine.close();
    this.axes = this.atlas = this.picture = null;
  }

  /** Another plane, about the pendulum's values. */
  choose(along, up) {
    if (along === up) return this.note("The map needs two different values.");
    [this.lists[0].value, this.lists[1].value] = [along, up];
    this.axes = [along, up].map((name) => axisAround(name, this.pendulum));
    this.atlas = this.picture = null;
    this.askSoon(0);
  }

  note(words, isEvidence = false) {
    const note = this.root.querySelector(".note");
    note.textContent = words;
    note.dataset.from = isEvidence ? "measure" : "explore";
  }

  /** Drive periods of the motions whose curves are wanted. */
  get longest() {
    return this.state.curves === "all" ? MANY : FEW;
  }

  get others() {
    return othersOf(this.axes, this.pendulum);
  }

  async ask() {
    this.controller?.abort();
    const { signal } = (this.controller = new AbortController());
    this.asked = this.others;
    this.atlas = this.from = null;
    this.note("computing the motions …");
    this.say("");
    this.state.change({ ground: null });
    const chart = (answer) => {
      this.chart = answer;
      this.paint();
    };
    const instead = new AbortController();
    signal.addEventListener("abort", () => instead.abort());
    const atlas = (found) => {
      instead.abort();
      this.atlas = found;
      this.from = found.holds(this.place) ? this.place : null;
      this.paint();
      this.note(`up to ${found.longest} drive period${found.longest === 1 ? "" : "s"}; ${found.certainty}`, true);
      this.state.change({ ground: { atlas: found, axes: this.axes, others: this.asked } });
    };
    const curves = taken(atlases(this.axes, this.pendulum, this.longest, signal), atlas, signal);
    await Promise.race([curves, new Promise((resolve) => setTimeout(resolve, CHART))]);
    const others = this.atlas ? null : taken(charts(this.engine, this.axes, this.pendulum, instead.signal), chart,
      instead.signal);
    const [failure] = await Promise.all([curves, others]);
    if (failure && !signal.aborted) this.note(`No curves: ${failure.message}`);
  }

  changed(keys) {
    if (keys.has("map") || keys.has("curves")) this.show();
    if (keys.has("curves") && this.axes) this.ask();
    if (!this.isOpen || !this.axes) return;
    if (keys.has("letters")) this.draw();
    if (keys.has("colours") && (this.chart || this.atlas)) this.draw();
    if (!["pendulum", "other", "pane"].some((key) => keys.has(key))) return;
    this.drawPoint();
    if (this.others !== this.asked || !this.isInside) return this.askSoon();
    this.tell();
  }

  /** The other values have changed: the map is pale until it is made anew. */
  askSoon(delay = REST) {
    this.root.classList.add("stale");
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      if (!this.isOpen) return;
      if (!this.isInside) this.choose(...this.axes.map(({ name }) => name));
      else if (!this.picture || this.others !== this.asked) this.ask();
    }, delay);
  }

  /** What has happened on the way to the present place. */
  tell() {
    const { place } = this;
    if (this.atlas && this.from && this.atlas.holds(place)) {
      const words = happening(this.atlas, this.from, place);
      if (words) this.say(words);
    }
    this.from = this.atlas?.holds(place) ? place : null;
  }

  // ---- hands ----

  hands() {
    const share = (x, y) => this.plane.sharesOf(x, y).map((value) => Math.max(0, Math.min(1, value)));
    return {
      holds: (x, y) => Boolean(this.axes) && this.plane.holds(x, y),
      move: (dx, dy, x, y) => this.go(share(x, y)),
      click: (x, y) => this.go(share(x, y)),
      hover: (at) => this.point(at),
      grip: () => {},
      release: () => {},
    };
  }

  /** Moves the pendulum to a place. */
  go(place) {
    this.set(Object.fromEntries(this.axes.map((axis, i) => [axis.name, valueAt(axis, place[i])])));
  }

  arrow(event) {
    const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (!(event.key in steps) || !this.axes) return;
    event.preventDefault();
    event.stopPropagation();
    const step = event.shiftKey ? 10 * STEP : STEP;
    this.go(this.place.map((share, i) => Math.max(0, Math.min(1, share + step * steps[event.key][i]))));
  }

  /** Names the motions that live under the pointer, and a curve that is near it. */
  point(at) {
    this.pointed = at && this.plane.sharesOf(...at);
    if (this.axes) this.drawPoint();
    this.bubble.hidden = !(at && this.atlas);
    if (this.bubble.hidden) return;
    const place = this.plane.sharesOf(...at);
    const [, , width, height] = this.plane.box;
    const curve = this.atlas.nearest(place, [REACH / width, REACH / height], this.longest);
    const motions = this.atlas.motionsAt(place);
    const title = document.createElement("strong");
    title.textContent = regionWords(this.atlas, place) + (curve ? ` (${curve.name}: ${curve.kind.replace("_", " ")})`
      : "");
    const lines = motions.map(({ name, colour, count }) => {
      const line = document.createElement("span");
      const patch = Object.assign(document.createElement("span"), { className: "patch" });
      patch.style.background = colour;
      line.append(patch, name + (count > 1 ? ` (${count})` : ""));
      return line;
    });
    this.bubble.replaceChildren(title, ...lines);
    const side = at[0] > this.over.clientWidth / 2;
    Object.assign(this.bubble.style, {
      left: side ? "auto" : `${at[0] + 14}px`,
      right: side ? `${this.over.clientWidth - at[0] + 14}px` : "auto",
      top: `${Math.max(0, Math.min(at[1] - 20, this.over.clientHeight - 30 - 19 * lines.length))}px`,
    });
  }

  // ---- pictures ----

  get plane() {
    const [theta, velocity] = this.axes.map(({ low, high }) => new Range(Decimal.from(low), Decimal.from(high)));
    return new Plane({ theta, velocity }, this.over.clientWidth, this.over.clientHeight, lettersOf(document.body));
  }

  /** What changes seldom: shades, curves, axes. */
  paint() {
    this.root.classList.remove("stale");
    const { kinds } = this.state;
    this.picture = this.atlas ? regionPicture(this.atlas, kinds) : chartPicture(...this.chart, kinds);
    this.root.querySelector(".kinds").replaceChildren(
      this.atlas ? "" : PENDING,
      ...this.picture.kinds.map(([words, colour]) => {
        const entry = document.createElement("span");
        const patch = Object.assign(document.createElement("span"), { className: "patch" });
        patch.style.background = colour;
        entry.append(patch, words);
        return entry;
      }),
    );
    this.draw();
  }

  surfaceOn(canvas) {
    const ratio = devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    Object.assign(canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.imageSmoothingEnabled = false;
    return new CanvasSurface(context, this.state.colours, lettersOf(document.body));
  }

  draw() {
    if (!this.axes || !this.isOpen) return;
    const surface = this.surfaceOn(this.ground);
    const { plane } = this;
    surface.clipped(plane.box, () => {
      if (this.picture) surface.image(this.picture.canvas, plane.box);
      if (!this.atlas) hatch(surface, plane.box);
      for (const curve of this.atlas?.curves ?? []) if (curve.period <= this.longest) this.drawCurve(surface, plane,
        curve);
    });
    drawAxes(surface, plane, this.words);
    this.drawPoint();
  }

  /** Words of its axes, as planes have them. */
  get words() {
    const [theta, velocity] = this.axes
      .map(({ name, unit }) => ({ words: keyWords(name) + (unit ? ` (${unit})` : "") }));
    return { theta, velocity };
  }

  drawCurve(surface, plane, { kind, first, points }) {
    const line = Array.from({ length: points }, (_, i) => plane.placeOf(this.atlas.x[first + i],
      this.atlas.y[first + i]));
    surface.line(line, CURVE, kind.startsWith("rest") ? 1.4 : 0.8, DASHES[kind]);
  }

  drawPoint() {
    if (!this.axes) return;
    const surface = this.surfaceOn(this.over);
    const { plane, place } = this;
    if (this.pointed) drawPlace(surface, plane, this.words, this.pointed);
    if (!this.isInside) return;
    const [x, y] = plane.placeOf(...place);
    const [left, top, width, height] = plane.box;
    surface.line([[left, y], [left + width, y]], surface.theme.cross, 1);
    surface.line([[x, top], [x, top + height]], surface.theme.cross, 1);
    surface.circle(x, y, 9, "#1c2127", "#ffffff");
    surface.circle(x, y, 5, "#f2b233", "#ffffff");
  }
}
