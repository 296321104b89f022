// Keys: everything that hands do with the mouse.

const STEP = 1 / 8; // of the window
const ZOOM = 1.6;
const press = (id) => document.getElementById(id).click();

export function listenKeys(state, basins) {
  const move = (x, y) => {
    state.past.push(state.window);
    state.change({ window: state.window.moved(x, y).wrapped(), jump: false });
  };
  const actions = {
    ArrowLeft: () => move(-STEP, 0),
    ArrowRight: () => move(STEP, 0),
    ArrowUp: () => move(0, STEP),
    ArrowDown: () => move(0, -STEP),
    "+": () => basins.zoom(1 / ZOOM),
    "=": () => basins.zoom(1 / ZOOM),
    "-": () => basins.zoom(ZOOM),
    f: () => press(document.body.dataset.filled === "motion" ? "fill-motion" : "fill-basins"),
    p: () => press("fill-motion"),
    Enter: () => basins.click(basins.active, 0.5, 0.5),
    " ": () => press("play"),
    Escape: () => {
      for (const id of ["dive", "film-play"]) if (document.getElementById(id).getAttribute("aria-pressed") === "true") press(id);
      press("cancel");
    },
    Backspace: () => press("back"),
    h: () => press("home"),
    d: () => press("dive"),
    n: () => press("nearest"),
    w: () => press("drawn"),
    c: () => press("compare"),
    m: () => press("chart"),
  };
  addEventListener("keydown", (event) => {
    const typing = event.target.matches("input, select, textarea, button");
    const action = actions[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey || (typing && event.key !== "Escape")) return;
    event.preventDefault();
    action();
  });
}
