// What the page shows, in one place, and its copy in the address: a reload keeps it, and a link shares it.

import { keyWords } from "./values.js";
import { Window } from "./window.js";

export const DEFAULTS = {
  quality: "exact",
  samples: "2",
  shade: "relief",
  units: "pi",
  theme: "auto",
  points: "on",
  painter: "auto",
  middle: "inverted",
  drawn: "on",
  view: "pendulum",
  letters: "usual",
  spread: "0",
  level: "look",
  map: "off",
  curves: "few",
};
export const LEVELS = ["look", "explore", "measure"]; // each shows what the one before does, and more

const SAID = ["level", "map"]; // by every address: what the browser remembers of them may be another page's
const AMPLITUDES = ["drive_amplitude", "m"]; // what a pendulum may call how far it is shaken
const PAUSE = 1000; // ms
const NAMED = 2; // values in a title

/** The state: change() tells everyone who listens which keys have changed. */
export class State {
  title; scene; pivotFrequency; kinds; overlays; // of the scene
  pendulum; other; pane; start; lit; pinned; ground; jump; colours; // the pendulums as texts, and what is shown of them
  quality; samples; shade; painter; middle; level; letters; map; curves; // as in DEFAULTS
  /** @type {import("./window.js").Window} */ window;
  /** @type {import("./window.js").Window} */ home; // the first one
  /** @type {import("./window.js").Window} */ whole; // the scene's

  /** @param {object} start values of all that is shown */
  constructor(start) {
    Object.assign(this, start);
    this.listeners = [];
    this.past = [];
    this.undone = [];
  }

  listen(listener) {
    this.listeners.push(listener);
  }

  change(values) {
    const keys = Object.keys(values).filter((key) => this[key] !== values[key]);
    Object.assign(this, values);
    if (keys.length) for (const listener of this.listeners) listener(new Set(keys));
  }

  /** The scene's title; once the pendulum is another one, what differs: the title may say what holds no more. */
  get shownTitle() {
    const { title, pendulum, scene } = this;
    const names = Object.keys(pendulum).filter((name) => pendulum[name] !== scene[name]);
    const words = names.slice(0, NAMED).map((name) => `${keyWords(name)} ${pendulum[name]} instead of ${scene[name]}`);
    return names.length ? words.join(", ") + (names.length > NAMED ? " …" : "") : title;
  }

  /** Shows as much as a level does; what it has no control for goes. */
  show(level) {
    const plain = level === "look" ? { view: DEFAULTS.view, map: "off", other: null, pane: "a" } : {};
    this.change({ level, lit: null, pinned: null, ...plain });
  }

  /** Goes to another window; the present one is kept for back(). */
  visit(window) {
    if (window.equals(this.window)) return;
    this.keep();
    this.change({ window });
  }

  /** Keeps the window and the pendulums for back(). Changes of one `kind`, as a hand makes them without a pause, are
   * one step. */
  keep(kind = null, window = this.window) {
    const now = performance.now();
    const goesOn = kind !== null && kind === this.kept?.kind && now - this.kept.at < PAUSE;
    this.kept = { kind, at: now };
    const { pendulum, other, pane } = this;
    if (goesOn) return;
    this.past.push({ window, pendulum, other, pane });
    this.undone = [];
    this.change({ steps: this.past.length });
  }

  back() {
    this.swap(this.past, this.undone);
  }

  /** Undoes back(). */
  forward() {
    this.swap(this.undone, this.past);
  }

  swap(from, to) {
    this.kept = null;
    if (!from.length) return;
    const { window, pendulum, other, pane } = this;
    to.push({ window, pendulum, other, pane });
    this.change({ ...from.pop(), steps: this.past.length, jump: false });
  }
}

const axisText = ({ min, max, centre, width }) => (centre === undefined ? `${min}..${max}` : `${centre}~${width}`);

function axisFrom(text) {
  const [min, max] = text.split("..");
  if (max !== undefined) return { min, max };
  const [centre, width] = text.split("~");
  return { centre, width };
}

/** The part of an address after #. */
export function addressOf(state) {
  const { theta, velocity } = state.window.toRequest();
  const named = state.name ? { scene: state.name } : {};
  const parts = new URLSearchParams({ ...named, theta: axisText(theta), velocity: axisText(velocity) });
  for (const [name, value] of Object.entries(state.pendulum)) if (value !== state.scene[name]) parts.set(
    `pendulum.${name}`, value);
  if (state.start) parts.set("start", `${state.start.theta}~${state.start.velocity}~${state.start.pane}`);
  if (state.other) for (const [name, value] of Object.entries(state.other)) parts.set(`other.${name}`, value);
  for (const [name, value] of Object.entries(DEFAULTS)) if (state[name] !== value || SAID.includes(name)) parts.set(
    name, state[name]);
  return `#${parts}`;
}

/** What an address says beside the start: {window, pendulum, other, ...}; what it says wrongly is left out. */
export function readAddress(hash, start) {
  const parts = new URLSearchParams(hash.replace(/^#/, "").replaceAll(";", "&"));
  /** @type {any} */ const found = { pendulum: { ...start.pendulum }, other: null };
  for (const [name, value] of parts) {
    const [group, key] = name.split(".");
    if (name in DEFAULTS) found[name] = value;
    else if (name === "amplitude") found.pendulum[AMPLITUDES.find((own) => own in start.pendulum) ?? "m"] = value;
    else if (group === "pendulum" && key in start.pendulum) found.pendulum[key] = value;
    else if (group === "other" && key in start.pendulum) found.other = { ...(found.other ?? start.pendulum),
      [key]: value };
  }
  if (parts.has("start")) {
    const [theta, velocity, pane] = parts.get("start").split("~");
    found.start = { theta, velocity, pane };
  }
  try {
    found.window = Window.from({ theta: axisFrom(parts.get("theta")), velocity: axisFrom(parts.get("velocity")) });
  } catch {
    // the scene's own window stays
  }
  return found;
}

const REMEMBERED = ["middle", "theme", "drawn", "level", "map"];

/** Choices that hold for every scene. A cookie keeps them: it is the same for all ports of this machine, where other
 * storage is not. */
export function remember(state, keys) {
  for (const name of REMEMBERED.filter((key) => keys.has(key)))
    document.cookie = `kapitza_${name}=${state[name]}; max-age=31536000; path=/; samesite=strict`;
}

export function remembered() {
  const kept = new Map(document.cookie.split("; ").map((text) => /** @type {[string, string]} */ (text.split("="))));
  const names = REMEMBERED.filter((name) => kept.has(`kapitza_${name}`));
  return Object.fromEntries(names.map((name) => [name, kept.get(`kapitza_${name}`)]));
}
