// The page: the state, the panes that show it, and what the controls do to it.

import { Basins } from "./basins.js";
import { listenControls } from "./controls.js";
import { NEUTRAL } from "./drive.js";
import { element } from "./element.js";
import { ask, signIn } from "./engine.js";
import { listenKeys } from "./keyboard.js";
import { addressOf, DEFAULTS, readAddress, remember, remembered, State } from "./state.js";
import { DARK, LIGHT } from "./surface.js";
import { idOf } from "./track.js";
import { Window } from "./window.js";

const QUESTION = "Where does the pendulum end?"; // the title of a first look
const EMBEDDED = /^#embed\b/.test(location.hash); // in another page: the pendulum, its slider, the basins
const dark = matchMedia("(prefers-color-scheme: dark)");

async function begin() {
  document.body.toggleAttribute("data-embed", EMBEDDED);
  await signIn();
  const start = await ask("state");
  const scene = { ...NEUTRAL, ...textsOf(start.pendulum) };
  const state = new State({
    ...DEFAULTS,
    title: start.title,
    name: start.name, // of the scene, where the page has several
    scene,
    pendulum: scene,
    other: null,
    pane: "a",
    whole: Window.from(start.window),
    pivotFrequency: start.pivot_frequency,
    overlays: start.overlays,
    kinds: start.kinds,
    start: null,
    lit: null,
    pinned: null,
    playing: true,
    jump: false,
    ground: null,
    speed: 1,
  });
  Object.assign(state, start.choices, remembered(), readAddress(location.hash, { pendulum: scene }));
  if (EMBEDDED) state.level = "look";
  state.home = state.whole.centred(state.middle);
  state.window ??= state.home;
  for (const [kind, colour] of Object.entries(state.kinds)) document.documentElement.style.setProperty(
    `--${idOf(kind)}`, colour);
  const titleKeys = ["title", "pendulum", "scene", "level"];
  const showTitle = () => {
    document.title = state.shownTitle;
    element("title").textContent = state.level === "look" ? QUESTION : state.shownTitle;
    document.body.dataset.level = state.level;
  };
  showTitle();
  state.listen((keys) => titleKeys.some((key) => keys.has(key)) && showTitle());
  setTheme(state);
  const setLetters = () => (document.body.dataset.letters = state.letters);
  setLetters();
  state.listen((keys) => keys.has("theme") && setTheme(state));
  state.listen((keys) => keys.has("letters") && setLetters());
  dark.addEventListener("change", () => setTheme(state));
  if (!EMBEDDED) keepAddress(state);
  keepMiddle(state);
  const basins = new Basins(state);
  const parts = listenControls(state, basins);
  listenKeys(state, basins);
  basins.show();
  // No program stays for a closed page.
  addEventListener("pagehide", () => [...basins.panes, parts.map].forEach(({ engine }) => engine.close()));
  /** @type {any} */ (window).explorer = { state, basins, ...parts }; // for the browser's console
}

/** Numbers as texts; lists and mappings stay. */
function textsOf(pendulum) {
  return Object.fromEntries(Object.entries(pendulum)
    .map(([name, value]) => [name, typeof value === "number" ? String(value) : value]));
}

function setTheme(state) {
  const name = state.theme === "auto" ? (dark.matches ? "dark" : "light") : state.theme;
  document.documentElement.dataset.theme = name;
  state.change({ colours: name === "dark" ? DARK : LIGHT });
}

/** Another angle in the middle: the first window turns, and with it the one that is shown where it is the first. */
function keepMiddle(state) {
  state.listen((keys) => {
    remember(state, keys);
    if (!keys.has("middle")) return;
    const home = state.whole.centred(state.middle);
    if (state.window.equals(state.home)) state.change({ window: home, jump: true });
    state.change({ home });
  });
}

/** The address follows the state, a little later. */
function keepAddress(state) {
  let timer = 0;
  state.listen(() => {
    clearTimeout(timer);
    timer = setTimeout(() => history.replaceState(null, "", addressOf(state)), 250);
  });
  addEventListener("hashchange", () => state.change(readAddress(location.hash, { pendulum: state.scene })));
}

begin().catch((error) => {
  document.body.dataset.state = "error";
  element("status").textContent = error.message;
});
