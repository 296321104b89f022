// The legend: a line for each end, in an order that does not depend on its share, so that nothing jumps while things move.

import { sharesOf } from "./frames.js";
import { signed } from "./ticks.js";

/** Kinds of motion, as lists of them are ordered. */
export const ORDER = [
  "down",
  "inverted",
  "down nodding",
  "flutter",
  "inverted nodding",
  "rotation +",
  "rotation -",
  "other",
  "chaotic",
  "not settled",
];

/** Rows of the last frames, by pane: {key, name, colour, shares: [of a, of b]}. */
export function rowsOf(frames) {
  const rows = new Map();
  frames.forEach((frame, pane) => {
    const seen = {};
    for (const row of frame ? sharesOf(frame) : []) {
      const nth = (seen[row.name] = (seen[row.name] ?? 0) + 1);
      const key = `${row.name} ${nth}`;
      if (!rows.has(key)) rows.set(key, { ...row, key, shares: frames.map(() => null) });
      rows.get(key).shares[pane] = row.share;
    }
  });
  return [...rows.values()].sort(
    (one, two) =>
      ORDER.indexOf(one.kind) - ORDER.indexOf(two.kind) || one.period - two.period || one.winding - two.winding || one.id - two.id,
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
    const line = old.get(row.key) ?? newLine(row);
    Object.assign(line.dataset, { id: row.id, name: row.name, share: row.shares[0] });
    line.classList.toggle(
      "absent",
      row.shares.every((share) => !share),
    );
    line.querySelector(".patch").style.background = row.colour;
    line.querySelector(".patch").classList.toggle("hatched", Boolean(row.hatched));
    while (line.cells.length > 2) line.deleteCell(2);
    for (const share of row.shares) line.insertCell().textContent = shareWords(share);
    return line;
  });
  body.replaceChildren(...lines);
}

function newLine(row) {
  const line = document.createElement("tr");
  const patch = document.createElement("span");
  patch.className = "patch";
  line.dataset.key = row.key;
  line.insertCell().append(patch);
  line.insertCell().textContent = signed(row.name);
  return line;
}
