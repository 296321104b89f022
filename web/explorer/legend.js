// The legend: a line for each end, in an order that does not depend on its share, so that nothing jumps while things
// move.

import { sharesOf } from "./frames.js";
import { signed } from "./ticks.js";
import { byKind, EXPLAINED, ORDER } from "./words.js";

const MARKED = 4000; // ms

/** Rows of the last frames of panes: {key, name, colour, shares: [of a, of b]}; null: not known, as a picture was given
 * up before any frame of its window came. `kinds`: one row for each kind of motion. */
export function rowsOf(panes, kinds = false) {
  const rows = new Map();
  panes.forEach((pane, number) => {
    const isKnown = pane.top && (!pane.isStopped || pane.shows(pane.top));
    for (const row of pane.top ? sharesOf(pane.top) : []) {
      if (!rows.has(row.key)) rows.set(row.key, { ...row, shares: panes.map(() => null) });
      if (isKnown) rows.get(row.key).shares[number] = row.share;
    }
  });
  const all = kinds ? byKind([...rows.values()]) : [...rows.values()];
  return all.sort(
    (one, two) =>
      ORDER.indexOf(one.kind) - ORDER.indexOf(two.kind) || one.period - two.period || one.winding - two.winding
        || one.id - two.id,
  );
}

export function shareWords(share) {
  if (share === null) return "–";
  const percent = 100 * share;
  if (percent === 0) return "0 %";
  return percent >= 1 ? `${percent.toFixed(1)} %` : percent >= 0.01 ? `${percent.toFixed(2)} %` : "< 0.01 %";
}

/** Writes the rows into the table; lines that stay are changed in place. */
export function writeLegend(table, rows) {
  const body = table.tBodies[0];
  const old = new Map([...body.rows].map((line) => [line.dataset.key, line]));
  const lines = rows.map((row) => {
    const line = old.get(row.key) ?? newLine(row, old.size > 0);
    Object.assign(line.dataset, { id: row.id, name: row.name, share: row.shares[0] ?? 0 });
    line.classList.toggle(
      "absent",
      row.shares.every((share) => !share),
    );
    line.querySelector(".patch").style.background = row.colour;
    line.querySelector(".patch").classList.toggle("hatched", Boolean(row.hatched));
    while (line.cells.length > 2) line.deleteCell(2);
    for (const share of row.shares) line.append(newShare(share, row.colour));
    return line;
  });
  body.replaceChildren(...lines);
}

/** A share as a number beside a bar. */
function newShare(share, colour) {
  const [cell, bar] = [document.createElement("td"), document.createElement("span")];
  cell.className = "share";
  bar.style.width = `${100 * (share ?? 0)}%`;
  bar.style.background = colour;
  cell.append(bar, shareWords(share));
  return cell;
}

/** A line; one that comes to others is marked for a moment. */
function newLine(row, comes) {
  const line = document.createElement("tr");
  line.classList.toggle("new", comes);
  setTimeout(() => line.classList.remove("new"), MARKED);
  const patch = document.createElement("span");
  patch.className = "patch";
  line.dataset.key = row.key;
  line.insertCell().append(patch);
  if (row.id < 0) line.insertCell().textContent = row.name;
  else {
    const button = Object.assign(document.createElement("button"),
      { textContent: signed(row.name), title: EXPLAINED[row.kind] });
    button.append(Object.assign(document.createElement("small"), { textContent: ` ${EXPLAINED[row.kind]}` }));
    button.setAttribute("aria-pressed", "false");
    line.insertCell().append(button);
  }
  return line;
}

/** Lights the basin of the line that the pointer or the focus is on, and keeps it lit where the line is clicked.
 * `state.lit`: key of the basin that is lit; `state.pinned`: of the one that was clicked. */
export function listenLegend(table, state, play) {
  const keyAt = (event) => {
    const line = event.target.closest("tr");
    return line?.querySelector("button") ? line.dataset.key : null;
  };
  const light = (event) => state.change({ lit: keyAt(event) ?? state.pinned });
  for (const kind of ["pointerover", "focusin"]) table.addEventListener(kind, light);
  for (const kind of ["pointerleave", "focusout"]) table.addEventListener(kind,
    () => state.change({ lit: state.pinned }));
  table.addEventListener("click", (event) => {
    const key = keyAt(event);
    if (!key) return;
    const pinned = key === state.pinned ? null : key;
    state.change({ pinned, lit: pinned });
    if (pinned) play(pinned);
  });
  state.listen((keys) => {
    if (!keys.has("pinned")) return;
    for (const line of table.rows) line.querySelector("button")?.setAttribute("aria-pressed",
      String(line.dataset.key === state.pinned));
  });
}
