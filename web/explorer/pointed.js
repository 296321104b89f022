// What a place of the basins says to the pointer.

import { likelyEnds } from "./experiment.js";
import { sharesOf, unlabelled } from "./frames.js";
import { measureWords } from "./passport.js";

/** The attractor under a place, of the list of its frame; undefined where none is known. */
export function rowAt(pane, across, up) {
  const found = pane.cellAt(across, up);
  return found && sharesOf(found.frame).find(({ id }) => id === found.frame.labels[found.cell]);
}

/** The end of a place; from the level measure on the measures of its basin too, as far as they are known. */
export function wordsAt(pane, { passport, units, state }, across, up) {
  const found = pane.cellAt(across, up);
  const row = rowAt(pane, across, up);
  if (!found) return "not labelled yet";
  const { frame, cell } = found;
  const name = frame.labels[cell] === 255 ? unlabelled(frame) : frame.catalogue.attractors[frame.labels[cell]].name;
  // Not those of another window
  const known = row && (pane.shows(frame) ? row : { ...row, share: null, settling: null });
  if (state.level === "look") return `ends ${row ? row.kind : name}`;
  const measures = row ? `: ${measureWords(known, passport.pushOf(pane, row), units)}` : "";
  return name + (frame.cells[4 * cell + 2] === 255 ? " (undecided)" : "") + measures;
}

/** How likely each end is for starts about a place. */
export function likelyWords(pane, at, spread) {
  return likelyEnds(pane, at, spread)
    .slice(0, 4)
    .map(([name, share]) => `${name} ${(100 * share).toFixed(0)} %`)
    .join(", ");
}
