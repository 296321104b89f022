// Files that are dropped on the page, or chosen: releases, stories, and pictures that hold a view.

import { element } from "./element.js";
import { textsIn } from "./png.js";
import { VIEW_IN_PNG } from "./save.js";
import { readAddress } from "./state.js";
import { Window } from "./window.js";


/** Calls what takes a file of its kind: `kinds` has [pattern of names, what takes it], the first that fits is
 * called. */
export function listenFiles(kinds) {
  const take = (file) => file && kinds.find(([pattern]) => pattern.test(file.name))[1](file);
  element("panes").addEventListener("dragover", (event) => event.preventDefault());
  element("panes").addEventListener("drop", (event) => {
    event.preventDefault();
    take(event.dataTransfer.files[0]);
  });
  element("open").onchange = () => {
    take(element("open").files[0]);
    element("open").value = ""; // the same file may be chosen again
  };
}

/** Shows the view that a picture holds. */
export async function openPicture(state, file) {
  const text = textsIn(new Uint8Array(await file.arrayBuffer()))[VIEW_IN_PNG];
  if (!text) throw new Error(
    `${file.name}: the picture holds no view; pictures that this page saves as PNG hold theirs`);
  const { title, scene, whole: edges, pivotFrequency, address } = JSON.parse(text);
  const whole = Window.from(edges);
  /** @type {any} */ const found = { start: null, ...readAddress(address, { pendulum: scene }) };
  const home = whole.centred(found.middle ?? state.middle);
  const fresh = { pane: "a", lit: null, pinned: null, past: [], undone: [], jump: true };
  state.change({ title, scene, whole, home, pivotFrequency, ...fresh, ...found, window: found.window ?? home });
}
