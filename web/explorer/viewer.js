// What a view saved as one HTML file does without a server: its list plays the recorded motions.

import { element } from "./element.js";
import { Motion } from "./motion.js";
import { Stage, VIEWS } from "./stage.js";
import { DARK, LIGHT } from "./surface.js";
import { Units } from "./units.js";

const SECOND = 1.2; // drive periods that a second shows

/** `data`: {rows: [{name, colour, share, words, motion}], pivotFrequency}; motion: {header, numbers, ending} or
 * null. */
export function view({ rows, pivotFrequency }) {
  const theme = matchMedia("(prefers-color-scheme: dark)").matches ? DARK : LIGHT;
  const stage = new Stage(element("pendulum"));
  let shown = { motion: null, view: VIEWS[0] };
  const play = (row) => {
    const { header, numbers, ending } = row.motion;
    shown.motion = new Motion(header, new Uint8Array(new Float64Array(numbers).buffer), ending);
    element("words").textContent = row.words;
  };
  for (const row of rows) {
    const line = document.createElement("button");
    const patch = Object.assign(document.createElement("span"), { className: "patch" });
    patch.style.background = row.colour;
    line.append(patch, `${row.name} ${row.share}`);
    line.disabled = !row.motion;
    line.onclick = () => play(row);
    element("list").append(line);
  }
  for (const name of VIEWS) {
    const tab = Object.assign(document.createElement("button"), { textContent: name });
    tab.onclick = () => (shown = { ...shown, view: name });
    element("views").append(tab);
  }
  const first = rows.find((row) => row.motion);
  if (first) play(first);
  let last = performance.now();
  const tick = (now) => {
    const seconds = Math.max(0, Math.min(0.1, (now - last) / 1000)); // the first picture may be older than this script
    shown.motion?.advance(seconds * SECOND);
    last = now;
    stage.draw(shown.motion, shown.view, theme, new Units("pi", pivotFrequency));
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}
