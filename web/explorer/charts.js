// A chart of pendulums beside the basins: what ends a plane of two of its values has. A click sets the pendulum.

import { Decimal } from "./decimal.js";
import { Engine } from "./engine.js";
import { asScene, bytesOf } from "./frames.js";
import { listen } from "./gestures.js";
import { ORDER } from "./legend.js";
import { drawAxes, Plane } from "./plane.js";
import { numberOf, withUnit } from "./sliders.js";
import { CanvasSurface } from "./surface.js";
import { Range } from "./window.js";

const CELLS = 160; // along an axis
const element = (id) => document.getElementById(id);

export class Charts {
  constructor(state) {
    this.state = state;
    this.root = null;
    state.listen((keys) => this.root && this.changed(keys));
  }

  /** Opens the chart, or closes it. */
  toggle(names, set) {
    element("chart").setAttribute("aria-pressed", String(!this.root));
    if (this.root) return this.close();
    Object.assign(this, { names, set });
    this.build();
    const along = names.find((name) => /^k$|frequency/.test(name)) ?? names[0];
    const up = names.find((name) => /amplitude|^m$/.test(name) && name !== along) ?? names.find((name) => name !== along);
    this.choose(along, up);
  }

  build() {
    this.root = element("pane").content.firstElementChild.cloneNode(true);
    this.root.classList.add("chart");
    const caption = this.root.querySelector(".caption");
    this.lists = ["velocity", "theta"].map((axis) => {
      const list = document.createElement("select");
      for (const name of this.names) list.append(new Option(name.replace(/_/g, " "), name));
      list.setAttribute("aria-label", axis === "theta" ? "value along the chart" : "value up the chart");
      list.onchange = () => this.choose(this.lists[1].value, this.lists[0].value);
      return list;
    });
    caption.append(this.lists[0], " over ", this.lists[1]);
    this.over = this.root.querySelector(".over");
    this.over.setAttribute("aria-label", "Chart: a click sets the pendulum");
    this.image = document.createElement("canvas");
    this.kinds = Object.assign(document.createElement("p"), { className: "kinds" });
    this.root.append(this.kinds);
    this.root.querySelector(".basins").remove();
    element("panes").append(this.root);
    this.engine = new Engine("chart");
    listen(this.over, this.hands());
    new ResizeObserver(() => this.draw()).observe(this.root);
  }

  close() {
    this.controller?.abort();
    this.engine.close();
    this.root.remove();
    this.root = null;
  }

  /** Another plane: half to twice the pendulum's values. */
  choose(along, up) {
    if (along === up) return this.refuse("the chart needs two different values");
    const around = (name) => {
      const { number, unit } = numberOf(this.pendulum[name]);
      const edges = number === 0 ? [-1, 1] : [number / 2, number * 2].sort((a, b) => a - b);
      return { unit, range: new Range(...edges.map((edge) => Decimal.from(edge))) };
    };
    this.x = { name: along, ...around(along) };
    this.y = { name: up, ...around(up) };
    [this.lists[0].value, this.lists[1].value] = [up, along];
    this.have = null;
    this.ask();
  }

  /** That which the sliders move. */
  get pendulum() {
    return (this.state.pane === "b" && this.state.other) || this.state.pendulum;
  }

  get plane() {
    return new Plane({ theta: this.x.range, velocity: this.y.range }, this.over.clientWidth, this.over.clientHeight);
  }

  hands() {
    const scale = (axis, factor, share) => (axis.range = axis.range.scaled(factor, share));
    const soon = () => {
      this.draw();
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.ask(), 120);
    };
    return {
      holds: (x, y) => this.plane.holds(x, y),
      zoom: (factor, x, y) => {
        const [across, up] = this.plane.sharesOf(x, y);
        scale(this.x, factor, across);
        scale(this.y, factor, up);
        soon();
      },
      move: (dx, dy) => {
        const [, , width, height] = this.plane.box;
        this.x.range = this.x.range.moved(-dx / width);
        this.y.range = this.y.range.moved(dy / height);
        soon();
      },
      click: (x, y) => this.pick(...this.plane.sharesOf(x, y)),
      hover: () => {},
      grip: () => {},
      release: () => {},
    };
  }

  pick(across, up) {
    const text = ({ range, unit }, share) => withUnit(Number(range.at(share).toNumber().toPrecision(6)), unit);
    const values = { [this.x.name]: text(this.x, across), [this.y.name]: text(this.y, up) };
    for (const [name, value] of Object.entries(values)) this.set(name, value);
  }

  /** Asked anew where the other values have changed; those of its own axes only move its mark. */
  changed(keys) {
    if (["pendulum", "other", "pane"].some((key) => keys.has(key)) && this.have && this.have.others !== this.others()) this.ask();
    else this.draw();
  }

  others() {
    const { [this.x.name]: along, [this.y.name]: up, ...others } = this.pendulum;
    return JSON.stringify(others);
  }

  refuse(words) {
    const refusal = this.root.querySelector(".refusal");
    refusal.textContent = words;
    refusal.hidden = words === "";
  }

  async ask() {
    this.controller?.abort();
    const { signal } = (this.controller = new AbortController());
    const axis = ({ name, range }) => ({ parameter: name, min: range.low.toNumber(), max: range.high.toNumber(), count: CELLS });
    const request = { request: "chart", pendulum: asScene(this.pendulum), x: axis(this.x), y: axis(this.y), levels: [8, 4, 2, 1] };
    const others = this.others();
    const asked = { x: this.x.range, y: this.y.range };
    try {
      for await (const [header, bytes] of this.engine.answers(request, signal)) {
        if (header.answer !== "chart") continue;
        this.have = { ...asked, others, level: header.level };
        this.paint(header, bytes);
        this.refuse("");
        this.draw();
      }
    } catch (error) {
      if (error.name === "AbortError" || !this.root) return;
      this.have = null;
      this.refuse(error.message);
      this.draw();
    }
  }

  /** One pixel a cell, coloured by the kind of the motion. */
  paint({ rows, columns }, bytes) {
    Object.assign(this.image, { width: columns, height: rows });
    const context = this.image.getContext("2d");
    const picture = context.createImageData(columns, rows);
    const seen = new Map(); // kinds of motion and their colours
    for (let i = 0; i < rows * columns; i++) {
      const row = rows - 1 - Math.floor(i / columns);
      const at = 4 * (row * columns + (i % columns));
      const kind = kindOf(bytes[i], bytes[rows * columns + i]);
      if (!seen.has(kind)) seen.set(kind, this.state.kinds[kind] ?? "#ffffff");
      picture.data.set([...bytesOf(seen.get(kind)), 255], at);
    }
    context.putImageData(picture, 0, 0);
    this.list(seen);
  }

  /** The list of the colours that the chart has. */
  list(seen) {
    const entries = [...seen].sort(([one], [other]) => ORDER.indexOf(one) - ORDER.indexOf(other));
    this.kinds.replaceChildren(
      ...entries.map(([name, colour]) => {
        const [entry, patch] = [document.createElement("span"), document.createElement("span")];
        Object.assign(patch, { className: "patch" }).style.background = colour;
        entry.append(patch, name === "rotation +" ? "rotation" : name);
        return entry;
      }),
    );
  }

  draw() {
    if (!this.root || !this.x) return;
    const ratio = devicePixelRatio || 1;
    Object.assign(this.over, { width: Math.round(this.over.clientWidth * ratio), height: Math.round(this.over.clientHeight * ratio) });
    const context = this.over.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.imageSmoothingEnabled = false;
    const surface = new CanvasSurface(context, this.state.colours);
    const { plane } = this;
    surface.clipped(plane.box, () => {
      if (this.have) surface.image(this.image, this.placeOfImage(plane));
      const at = [this.x, this.y].map(({ name, range }) => range.shareOf(Decimal.from(numberOf(this.pendulum[name]).number)));
      surface.circle(...plane.placeOf(...at), 6, "#ffffff", "#b3261e");
    });
    const words = ({ name, unit }) => ({ words: name.replace(/_/g, " ") + (unit ? ` (${unit})` : "") });
    drawAxes(surface, plane, { theta: words(this.x), velocity: words(this.y) });
  }

  placeOfImage(plane) {
    const left = this.x.range.shareOf(this.have.x.low);
    const top = this.y.range.shareOf(this.have.y.high);
    const [x, y] = plane.placeOf(left, top);
    return [x, y, (plane.box[2] * this.have.x.width) / this.x.range.width, (plane.box[3] * this.have.y.width) / this.y.range.width];
  }
}

/** The kind of motion of a cell by period (0 = chaotic, 255 = not settled) and centre (0 down, 1 inverted, 2 rotating, 3 neither). */
export function kindOf(period, centre) {
  if (period === 255) return "not settled";
  if (period === 0) return "chaotic";
  if (centre === 2) return "rotation +";
  if (centre === 0) return period === 1 ? "down" : "down nodding";
  if (centre === 1) return { 1: "inverted", 2: "flutter" }[period] ?? "inverted nodding";
  return "other";
}
