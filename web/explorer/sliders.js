// A slider and a typed value for every number of the pendulum's mapping, on a track that shows what the pendulum does.

import { formsOf, isNeutral, isOfDrive } from "./drive.js";
import { usualKeys } from "./map_plane.js";
import { drawTrack, stretchesOf } from "./track.js";
import { keyWords, numberOf, placeOf, valueAt, withUnit } from "./values.js";

const REST = 250; // ms without a change, after which tracks are made anew
const EXPLAINED = {
  quality_factor: "how weak friction is: about as many swings as it makes until it is calm",
  drive_frequency: "how fast it is shaken: shakes in one small swing of the pendulum at rest",
  drive_amplitude: "how far it is shaken up and down, as a part of the pendulum's length",
  m: "how far it is shaken up and down, as a part of the pendulum's length",
  damping: "how strong friction is",
  k: "how strong gravity is, beside the shaking",
  amplitude: "how far it is shaken up and down",
  frequency: "how many shakes it makes in a second",
  length: "how long the pendulum is",
};
const APART = 0.1; // of a slider, between two pendulums that are compared
const STEP = 0.01; // of half a slider, that an arrow or a notch of the wheel goes; with shift ten of them
const SYMBOLS = { // of values without a unit of their own
  quality_factor: "Q",
  drive_frequency: "ω/ω₀",
  drive_amplitude: "ε",
  damping: "β",
  torque: "τ",
  torque_ratio: "γ",
  beta_c: "βc",
  omega: "ω/ωp",
  constant_torque: "N m",
  oscillating_torque: "N m",
  tilt: "rad",
  length: "m",
  amplitude: "m",
  frequency: "Hz",
  gravity: "m/s²",
  decay_time: "s",
  mass: "kg",
  radius: "m",
  inertia: "kg m²",
  friction: "kg m²/s",
  pivot_amplitude: "m",
  pivot_frequency: "rad/s",
};

/** What is typed, as a value of a scene: a number alone has the unit that the scene gives; null where it is no
 * number. */
export function typed(text, home) {
  const found = numberOf(text.trim());
  return found && withUnit(found.number, found.unit || numberOf(home).unit);
}

/** Fills `holder`; `change(name, text)` is called for each new value, `sweep(name)` for a press of the button that
 * moves a slider there and back; `engine()`: one that has nothing to do, or null. */
export class Sliders {
  constructor(holder, scene, { change, sweep, engine }) {
    this.scene = scene;
    this.rows = new Map();
    this.engine = engine;
    new ResizeObserver(() => this.rows.forEach((row) => row.stretches && drawTrack(row, row.stretches))).observe(
      holder);
    this.drive = newDrive(scene);
    holder.replaceChildren();
    for (const name of Object.keys(scene).filter((key) => numberOf(scene[key]))) {
      const row = newRow(name, scene[name]);
      listen(row, name, scene[name], change);
      row.play.onclick = () => sweep(name);
      this.rows.set(name, row);
      (isOfDrive(name) ? this.drive : holder).append(row.element);
    }
    if ("waveform" in scene) this.addForms(change);
    if (this.drive.children.length > 1) holder.append(this.drive);
    this.main = usualKeys(this.names)[1] ?? this.names[0];
    this.rows.get(this.main)?.element.classList.add("main");
  }

  /** Another pendulum, to be compared with one: it does something else, where the track knows that. */
  besides(pendulum) {
    const { main, scene } = this;
    if (!main) return { ...pendulum };
    const place = (1 + placeOf(pendulum[main], scene[main])) / 2;
    const stretches = this.rows.get(main).stretches ?? [];
    const at = stretches.findIndex(({ from, to }) => from <= place && place < to);
    const other = stretches[at + 1] ?? stretches[at - 1] ?? { from: Math.max(0, place - APART), to: place };
    return { ...pendulum, [main]: valueAt(other.from + other.to - 1, scene[main]) };
  }

  /** The list of wave forms. */
  addForms(change) {
    const { element, range, number, marks, play } = newRow("waveform", "0");
    this.forms = document.createElement("select");
    for (const form of formsOf(this.scene)) this.forms.append(new Option(form, form));
    this.forms.id = number.id;
    this.forms.onchange = () => change("waveform", this.forms.value);
    range.remove();
    marks.remove();
    play.remove();
    number.replaceWith(this.forms);
    this.drive.append(element);
  }

  /** Shows which slider is moved there and back; null: none. */
  showSwept(swept) {
    for (const [name, { play }] of this.rows) {
      play.setAttribute("aria-pressed", String(name === swept));
      play.textContent = name === swept ? "❚❚" : "▶";
    }
  }

  get names() {
    return [...this.rows.keys()];
  }

  /** Shows the values of a pendulum. */
  show(pendulum) {
    for (const [name, { element, range, number, value, message }] of this.rows) {
      const home = this.scene[name];
      range.value = placeOf(pendulum[name], home);
      element.style.setProperty("--share", (1 + placeOf(pendulum[name], home)) / 2);
      value.textContent = pendulum[name];
      range.setAttribute("aria-valuetext", pendulum[name]);
      if (document.activeElement !== number) number.value = pendulum[name];
      if (message.dataset.of !== pendulum[name]) message.textContent = "";
      number.title = range.title = `the scene has ${home}; a double click goes there`;
    }
    if (this.forms) this.forms.value = pendulum.waveform;
    this.pendulum = pendulum;
    this.trackSoon();
  }

  trackSoon() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.track(), REST);
  }

  /** Makes the tracks whose other values have changed, of the sliders that are seen. */
  async track() {
    const { pendulum } = this;
    const mine = (this.tracking = {});
    for (const [name, row] of this.rows) {
      const others = JSON.stringify({ ...pendulum, [name]: null });
      if (row.others === others || !row.element.offsetParent) continue;
      const engine = this.engine();
      const stretches = engine && (await stretchesOf(engine, name, pendulum, this.scene[name]).catch(() => []));
      if (mine !== this.tracking) return;
      if (!stretches) return this.trackSoon();
      Object.assign(row, { others, stretches });
      drawTrack(row, stretches);
    }
  }
}

function listen({ range, number, message }, name, home, change) {
  const go = (place) => change(name, valueAt(Math.max(-1, Math.min(1, place)), home));
  const move = (steps) => go(Number(range.value) + STEP * steps);
  range.oninput = () => go(Number(range.value));
  range.ondblclick = () => change(name, home);
  range.onkeydown = (event) => {
    const steps = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (!steps) return;
    event.preventDefault();
    move(event.shiftKey ? 10 * steps : steps);
  };
  const turn = (event) => {
    if (document.activeElement !== range) return; // else the wheel scrolls
    event.preventDefault();
    move(-Math.sign(event.deltaY));
  };
  range.addEventListener("wheel", turn, { passive: false });
  number.onchange = () => {
    const value = typed(number.value, home);
    number.setAttribute("aria-invalid", String(!value));
    message.textContent = value ? "" : `${number.value} is not a number; write for example ${home}`;
    message.dataset.of = home;
    if (value) change(name, value);
  };
}

/** The part for drives beyond the sine, which is open where the scene has one. */
function newDrive(scene) {
  const part = document.createElement("details");
  const summary = document.createElement("summary");
  summary.textContent = "Other drives";
  part.append(summary);
  part.open = Object.keys(scene).some((name) => isOfDrive(name) && !isNeutral(name, scene[name]));
  return part;
}

const spanOf = (className, textContent) => Object.assign(document.createElement("span"), { className, textContent });

function newRow(name, home) {
  const [element, label, marks, message] = ["div", "label", "div", "p"].map((kind) => document.createElement(kind));
  const [range, number] = [document.createElement("input"), document.createElement("input")];
  element.className = "slider";
  label.append(spanOf("key", keyWords(name)), spanOf("plain", /amplitude|^m$/.test(name) ? "how far it is shaken"
    : keyWords(name)));
  label.title = EXPLAINED[name] ?? "";
  label.setAttribute("for", `value-${name}`);
  number.id = `value-${name}`;
  label.append(" ", spanOf("symbol", numberOf(home).unit || (SYMBOLS[name] ?? "")));
  Object.assign(range, { type: "range", min: -1, max: 1, step: 0.002, value: 0, id: `slider-${name}` });
  range.setAttribute("aria-label", keyWords(name));
  Object.assign(number, { type: "text", inputMode: "decimal", autocomplete: "off" });
  const value = Object.assign(document.createElement("output"), { htmlFor: range.id });
  marks.className = "marks";
  Object.assign(message, { className: "message", id: `message-${name}` }).setAttribute("role", "alert");
  number.setAttribute("aria-describedby", message.id);
  const play = Object.assign(document.createElement("button"),
    { className: "sweep", textContent: "▶", title: `move ${keyWords(name)} there and back` });
  play.setAttribute("aria-label", play.title);
  play.setAttribute("aria-pressed", "false");
  element.append(label, value, range, number, play, marks, message);
  return { element, range, number, value, play, marks, message };
}
