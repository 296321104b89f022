// Keys: everything that hands do with the mouse, and the list of them.

import { element } from "./element.js";
import { LEVELS } from "./state.js";

// Keys of these show no more than before
const STAYS = ["cancel", "home", "back", "forward", "tell", "nearest", "fill-basins", "fill-motion"];
const STEP = 1 / 8; // of the window
const ZOOM = 1.6;

/** [keys, what they do in words, what they do]; the first of the keys is listed.
 * @returns {[string[], string, (hasClosed: boolean) => void][]} */
function actionsOn(state, basins) {
  const press = (id) => {
    const levels = [];
    for (let part = element(id); part; part = part.parentElement) levels.push(LEVELS.indexOf(part.dataset.from));
    const level = LEVELS[Math.max(...levels)]; // the first that shows the button
    if (level && !STAYS.includes(id) && LEVELS.indexOf(state.level) < LEVELS.indexOf(level)) state.show(level);
    element(id).click();
  };
  const move = (x, y) => () => {
    state.keep("move");
    state.change({ window: state.window.moved(x, y).wrapped(), jump: false });
  };
  const stop = (hasClosed) => {
    const running = ["dive", "film-play"].filter((id) => element(id).getAttribute("aria-pressed") === "true");
    running.forEach(press);
    if (!running.length && !hasClosed && document.body.dataset.state !== "done") press("cancel");
  };
  return [
    [["ArrowLeft"], "move left", move(-STEP, 0)],
    [["ArrowRight"], "move right", move(STEP, 0)],
    [["ArrowUp"], "move up", move(0, STEP)],
    [["ArrowDown"], "move down", move(0, -STEP)],
    [["+", "="], "zoom in", () => basins.zoom(1 / ZOOM)],
    [["-"], "zoom out", () => basins.zoom(ZOOM)],
    [["h"], "the first window", () => press("home")],
    [["Backspace", "Ctrl+z"], "the window or the values before", () => press("back")],
    [["Ctrl+y", "Ctrl+Z"], "undo Back", () => press("forward")],
    [["n"], "go to the nearest boundary", () => press("nearest")],
    [["w"], "zooms stay on boundaries, or not", () => press("drawn")],
    [["d"], "dive between two starts", () => press("dive")],
    [["b"], "show saddles and what boundaries are made of, or not", () => press("saddles")],
    [["Enter"], "play the start in the middle", () => basins.click(basins.active, 0.5, 0.5)],
    [[" "], "play or pause", () => press("play")],
    [["f"], "the basins fill the page, or not", () => press(document.body.dataset.filled === "motion" ? "fill-motion"
      : "fill-basins")],
    [["p"], "the pendulum fills the page, or not", () => press("fill-motion")],
    [["m"], "show the map, or not", () => press("map-shown")],
    [["c"], "compare two pendulums, or not", () => press("compare")],
    [["s"], "tell a story", () => press("tell")],
    [["Escape"], "stop what runs", stop],
    [["?"], "this list", () => press("help-shown")],
  ];
}

const NAMES = { " ": "space", ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓" };

/** Keys that an element with the focus takes: texts all, lists those that choose, buttons and boxes those to press.
 * @type {[string, RegExp][]} */
const OWN = [
  ["input[type=range]", /^Arrow|^Page|^Home|^End/],
  ["input[type=checkbox], input[type=file], button, summary", /^( |Enter)$/],
  ["select", /^( |Enter|Arrow.*|Page.*|Home|End)$/],
  ["input, textarea", /^/],
];

export function listenKeys(state, basins) {
  const actions = actionsOn(state, basins);
  const known = new Map(actions.flatMap(([keys, , action]) => keys.map((key) => [key, action])));
  element("keys").append(
    ...actions.flatMap(([[key], words]) => [
      Object.assign(document.createElement("dt"), { textContent: NAMES[key] ?? key }),
      Object.assign(document.createElement("dd"), { textContent: words }),
    ]),
  );
  element("help-shown").onclick = () => element("help").showModal();
  addEventListener("keydown", (/** @type {any} */ event) => {
    const control = event.ctrlKey || event.metaKey;
    const typing = !control && (OWN.find(([kinds]) => event.target.matches(kinds))?.[1].test(event.key) ?? false);
    const undoes = control && event.target.matches("input:not([type=range])");
    const action = known.get((control ? "Ctrl+" : "") + event.key);
    const taken = event.altKey || element("help").open;
    if (!action || taken || undoes || (typing && event.key !== "Escape")) return;
    const { defaultPrevented } = event;
    event.preventDefault();
    action(defaultPrevented);
  });
}
