// Buttons, lists and sliders.

import { Dive } from "./dive.js";
import { element } from "./element.js";
import { ask } from "./engine.js";
import { Experiment } from "./experiment.js";
import { Film } from "./film.js";
import { MotionMap } from "./map.js";
import { listenFiles, openPicture } from "./opened.js";
import { saveHtml } from "./portable.js";
import { copyText, savePng, saveScene, saveSvg, saveText } from "./save.js";
import { Sliders } from "./sliders.js";
import { LEVELS } from "./state.js";
import { VIEWS } from "./stage.js";
import { Stories } from "./stories.js";

/** Lists of the menu View: name in the state -> words, values with their words, and what more the title says. */
const CHOICES = {
  quality: ["Labels", { exact: "exact", moving: "quick" }],
  samples: ["Samples", { 1: "1", 2: "2", 3: "3" }],
  shade: ["Shade", { relief: "relief", none: "none", settling: "certain late", turns: "turns" }],
  units: ["Axes", { pi: "rad", degrees: "degrees", si: "SI" }],
  theme: ["Theme", { auto: "auto", light: "light", dark: "dark" }],
  letters: ["Letters", { usual: "usual", large: "large" }, "large letters, for a projector"],
  middle: ["Middle", { inverted: "inverted", down: "down" }],
  spread: [
    "Release",
    { 0: "exact", 1: "± 1°", 3: "± 3°", 10: "± 10°" },
    "how exactly a hand releases: the line under the picture says how likely each end is",
  ],
};
const PARTS = { map: "the map", basins: "the basins", motion: "the motion" }; // that may fill the page
const KEYS = { basins: " (f)", motion: " (p)" };
const SWITCHES = ["points", "drawn"];

/** Returns the parts that others see. */
export function listenControls(state, basins) {
  const { film, map } = listenPendulums(state, basins);
  const dive = listenWindow(state, basins, film);
  listenLevels(state);
  listenChoices(state, basins);
  listenSaving(state, basins);
  listenStage(state, basins);
  const stories = new Stories(state, basins);
  const experiment = new Experiment(state, basins, complain);
  listenFiles([
    [/\.ya?ml$/i, (file) => guarded(() => stories.open(file))()],
    [/\.png$/i, (file) => guarded(() => openPicture(state, file))()],
    [/^/, (file) => experiment.read(file)],
  ]);
  return { map, dive, stories };
}

/** Tabs of the motion, and buttons that let a part of the page fill it. */
function listenStage(state, basins) {
  const tabs = VIEWS.map((view) => {
    const tab = Object.assign(document.createElement("button"),
      { textContent: view, onclick: () => state.change({ view }) });
    tab.setAttribute("role", "tab");
    return tab;
  });
  element("views").append(...tabs);
  const show = () => tabs.forEach((tab, i) => tab.setAttribute("aria-selected", String(VIEWS[i] === state.view)));
  state.listen(show);
  show();
  const close = (target) => document.querySelectorAll(".menu[open]").forEach((menu) => menu.contains(target)
    || menu.removeAttribute("open"));
  addEventListener("pointerdown", (event) => close(event.target));
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    // It stops no labels, too
    if (document.body.dataset.filled || document.querySelector(".menu[open]")) event.preventDefault();
    close(null);
    document.body.dataset.filled = "";
  });
  for (const name in PARTS) document.querySelector(`[data-head=${name}]`).append(fillButton(name));
  for (const button of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("[data-fills]")))
    button.onclick = () => {
      const { body } = document;
      body.dataset.filled = body.dataset.filled === button.dataset.fills ? "" : button.dataset.fills;
      basins.drawStage();
    };
  new ResizeObserver(() => basins.drawStage()).observe(element("pendulum"));
}

/** How much the page shows. */
function listenLevels(state) {
  const radios = [...element("levels").querySelectorAll("input")];
  const show = () => radios.forEach((radio) => (radio.checked = radio.value === state.level));
  for (const radio of radios)
    radio.onchange = () => {
      document.body.dataset.filled = "";
      state.show(radio.value);
    };
  state.listen(show);
  if (!LEVELS.includes(state.level)) state.show(LEVELS[0]);
  show();
}

function fillButton(name) {
  const words = `let ${PARTS[name]} fill the page`;
  const button = Object.assign(document.createElement("button"),
    { id: `fill-${name}`, title: words + (KEYS[name] ?? ""), textContent: "⤢" });
  button.dataset.fills = name;
  button.dataset.from = "measure";
  button.setAttribute("aria-label", words);
  return button;
}

function complain(words) {
  document.body.dataset.state = "error";
  element("status").textContent = words;
}

/** Runs what a button does; what goes wrong stands in the status line. */
const guarded = (action) => () =>
  Promise.resolve()
    .then(action)
    .catch((error) => complain(error.message));

function listenWindow(state, basins, film) {
  element("home").onclick = () => {
    state.change({ jump: false });
    state.visit(state.home);
    basins.resume(); // where it is the window already
  };
  element("back").onclick = () => state.back();
  element("forward").onclick = () => state.forward();
  const steps = () => {
    element("back").disabled = state.past.length === 0;
    element("forward").disabled = state.undone.length === 0;
  };
  state.listen(steps);
  steps();
  element("zoom-in").onclick = () => basins.zoom(0.5);
  element("zoom-out").onclick = () => basins.zoom(2);
  element("play").onclick = () => state.change({ playing: !state.playing });
  state.listen(() => (element("play").textContent = state.playing ? "Pause" : "Play"));
  const dive = new Dive(state, basins, (words) => (element("status").textContent = words));
  element("dive").onclick = () => dive.toggle();
  element("nearest").onclick = () => dive.nearest(basins.active);
  element("saddles").onclick = () => basins.skeleton.toggle(basins.active);
  element("cancel").onclick = () => {
    if (document.body.dataset.state === "done") return basins.resume();
    dive.stop();
    film.stop();
    for (const pane of basins.panes) pane.cancel();
  };
  return dive;
}

function listenPendulums(state, basins) {
  const key = () => (state.pane === "b" && state.other ? "other" : "pendulum");
  const change = (values) => state.change({ [key()]: { ...state[key()], ...values }, jump: false });
  const setAll = (values) => {
    if (film.running?.swept) film.stop();
    state.keep(Object.keys(values).join());
    change(values);
  };
  const set = (name, value) => setAll({ [name]: value });
  const engine = () => (document.body.dataset.state === "done" ? basins.active.engine : null);
  const newSliders = () => new Sliders(element("sliders"), state.scene,
    { change: set, sweep: (name) => film.sweep(name), engine });
  let sliders = newSliders();
  const show = (keys) => {
    if (keys?.has("scene")) {
      sliders = newSliders();
      map.rename(sliders.names);
    }
    sliders.show(state[key()]);
    element("map-shown").setAttribute("aria-pressed", String(state.map === "on"));
    element("compare").setAttribute("aria-pressed", String(Boolean(state.other)));
    element("which").hidden = !state.other;
    for (const button of element("which").children) button.setAttribute("aria-pressed",
      String(button.dataset.pane === state.pane));
  };
  for (const button of element("which").children) button.onclick = () => state.change({ pane: button.dataset.pane });
  element("compare").onclick = () => {
    state.keep();
    state.change(state.other ? { other: null, pane: "a" } : { other: sliders.besides(state.pendulum), pane: "b" });
  };
  element("map-shown").onclick = () => state.change({ map: state.map === "on" ? "off" : "on" });
  const film = new Film(state, basins, sliders.names, (name, value) => change({ [name]: value }), complain);
  film.onSweep = (name) => sliders.showSwept(name);
  const map = new MotionMap(state, sliders.names,
    { set: setAll, say: (words) => (element("happening").textContent = words) });
  state.listen(show);
  show();
  return { film, map };
}

function choiceLabel(name) {
  const [words, values, title = ""] = CHOICES[name];
  const list = Object.assign(document.createElement("select"), { id: name });
  for (const value in values) list.append(new Option(values[value], value));
  const label = Object.assign(document.createElement("label"), { title });
  label.append(`${words} `, list);
  return label;
}

function listenChoices(state, basins) {
  element("choices").replaceWith(...Object.keys(CHOICES).map(choiceLabel));
  if (!state.pivotFrequency) element("units").querySelector("[value=si]").disabled = true;
  const show = () => {
    for (const name in CHOICES) element(name).value = state[name];
    for (const name of SWITCHES) element(name).checked = state[name] === "on";
  };
  for (const name in CHOICES) element(name).onchange = () => state.change({ [name]: element(name).value });
  for (const name of SWITCHES) element(name).onchange = () =>
    state.change({ [name]: element(name).checked ? "on" : "off" });
  for (const name of Object.keys(state.overlays)) element("overlays").append(overlayBox(name, basins));
  state.listen(show);
  show();
}

/** The width that is asked for, px; 0 where it is that of the screen. */
function pictureWidth() {
  const { value } = element("save-width");
  const width = Number(value);
  if (value !== "" && !(width >= 300 && width <= 8000)) throw new Error(
    `${value} is no width of a picture; it must be 300 to 8000 px`);
  return width;
}

function overlayBox(name, basins) {
  const label = document.createElement("label");
  const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: true, value: name });
  box.onchange = () => {
    basins.overlays[box.checked ? "add" : "delete"](name);
    for (const pane of basins.panes) {
      pane.plain.overlays = basins.overlaysOf(pane);
      pane.draw();
    }
  };
  label.append(box, ` ${name}`);
  return label;
}

function listenSaving(state, basins) {
  element("save-scene").onclick = guarded(() => saveScene(state, basins.active));
  const png = element("save-png");
  png.onclick = guarded(() => {
    png.disabled = true; // one picture at a time: they have one program
    return savePng(state, basins, pictureWidth()).finally(() => (png.disabled = false));
  });
  element("save-html").onclick = guarded(() => saveHtml(state, basins));
  element("save-svg").onclick = guarded(() => saveSvg(state, basins));
  element("save-csv").onclick = () => saveText("orbit.csv", basins.motion.toCsv(), "text/csv");
  element("copy").onclick = guarded(() => copyText(JSON.stringify(state.window.toRequest())));
  element("link").onclick = guarded(async () => {
    const { once } = await ask("link");
    await copyText(`${location.origin}${location.pathname}${once ? `?once=${once}` : ""}${location.hash}`);
    const limit = once ? " One browser can open it, once." : "";
    element("status").textContent = `An address of this view was copied.${limit}`;
  });
}
