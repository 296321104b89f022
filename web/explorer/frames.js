// Frames between page and program: what is asked for, what the bytes mean, the colours of a catalogue.

import { isNeutral, isUnused } from "./drive.js";

export const MOST_MOVING = 250_000; // cells of a frame while things move
const MOST_RESTING = 4_000_000;
const UNSETTLED = "#ffffff";
const WAITING = "#dfe4e9"; // of cells that have no label yet, hatched on the page
const FADED = 0.22; // what stays of the colour of a basin while another one is lit
export const HATCHING = 0.25; // how much darker every second stripe of them is

/** The request for a frame that fills a canvas; `samples` x `samples` cells a pixel. */
export function requestOf(window, pendulum, canvas, { quality, levels, samples, largest, shade, most: allowed }) {
  const most = allowed ?? (quality === "moving" && samples === 1 ? MOST_MOVING : MOST_RESTING);
  const scale = Math.min(samples, Math.sqrt(most / (canvas.width * canvas.height)), largest / canvas.width,
    largest / canvas.height);
  const times = [...(quality === "exact" ? ["settling_time"] : []), ...(shade === "settling" ? ["smooth_time"] : [])];
  const sure = quality === "exact" ? ["doubt", "other", ...(shade === "turns" ? ["turns"] : [])] : [];
  const planes = ["labels", ...times, ...sure];
  return {
    request: "frame",
    window: window.toRequest(),
    pendulum: asScene(pendulum),
    quality,
    levels,
    planes,
    rows: Math.max(8, Math.round(canvas.height * scale)),
    columns: Math.max(8, Math.round(canvas.width * scale)),
  };
}

/** A pendulum as a scene has it: what reads as a number is one, and what changes nothing is left out. */
export function asScene(pendulum) {
  const value = (text) => (typeof text === "string" && text.trim() !== "" && Number.isFinite(Number(text))
    ? Number(text) : text);
  const given = Object.entries(pendulum).filter(([name, text]) => !isNeutral(name, text) && !isUnused(name, pendulum));
  return Object.fromEntries(given.map(([name, text]) => [name, value(text)]));
}

/** The planes of an answer by name. */
export function decoded(header, bytes) {
  const cells = header.rows * header.columns;
  const planes = {};
  let at = 0;
  for (const name of header.planes) {
    const size = name.endsWith("_time") || name === "turns" ? 4 : 1;
    const part = bytes.slice(at, at + size * cells);
    planes[name] = size === 4 ? new Float32Array(part.buffer) : part;
    at += size * cells;
  }
  return planes;
}

const palettes = new WeakMap();

/** 256 colours of 4 bytes: colour i of label i of a catalogue; where `lit` is the key or the kind of attractors, those
 * of all others are faded. */
export function paletteOf(catalogue, lit = null) {
  if (!palettes.has(catalogue)) palettes.set(catalogue, new Map());
  const known = palettes.get(catalogue);
  const rows = keyed(catalogue);
  const isLit = (row) => row.key === lit || row.kind === lit;
  const key = rows.some(isLit) ? lit : null;
  if (!known.has(key)) {
    const bytes = new Uint8Array(1024).fill(255);
    bytes.set(bytesOf(UNSETTLED), 4 * 255);
    for (const row of rows) {
      const faded = key && !isLit(row) ? FADED : 1;
      bytes.set(
        bytesOf(row.colour).map((part) => 235 + faded * (part - 235)),
        4 * row.id,
      );
    }
    known.set(key, bytes);
  }
  return known.get(key);
}

/** The attractors of a catalogue, each with a key that tells mirror images of one name apart. */
function keyed(catalogue) {
  const seen = {};
  return catalogue.attractors
    .map((row) => ({ ...row, key: `${row.name} ${(seen[row.name] = (seen[row.name] ?? 0) + 1)}` }));
}

/** A catalogue in the colours that another one, of another program, gives to the same attractors. */
export function inColoursOf(catalogue, other) {
  if (!other || other === catalogue) return catalogue;
  const colours = new Map(keyed(other).map(({ key, colour }) => [key, colour]));
  return { ...catalogue, attractors: keyed(catalogue)
    .map((row) => ({ ...row, colour: colours.get(row.key) ?? row.colour })) };
}

export function bytesOf(colour) {
  return [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
}

/** What a cell without a label is called: quick labels leave some open, exact ones only those of motions that settle
 * nowhere. */
export function unlabelled({ quality }) {
  return quality === "moving" ? "not labelled yet" : "not settled";
}

/** The rows of a frame's catalogue with the shares of their labels and, where the frame has times, the mean settling
 * time; mirror images may share a name. */
export function sharesOf(frame) {
  return (frame.shares ??= countedShares(frame));
}

export function countedShares(frame) {
  const counts = new Uint32Array(256);
  const sums = new Float64Array(256);
  for (let i = 0; i < frame.labels.length; i++) {
    counts[frame.labels[i]]++;
    if (frame.times) sums[frame.labels[i]] += frame.times[i];
  }
  const rows = keyed(frame.catalogue).map((row) => ({
    ...row,
    share: counts[row.id] / frame.labels.length,
    settling: frame.times && counts[row.id] ? sums[row.id] / counts[row.id] : null,
  }));
  const name = unlabelled(frame);
  if (counts[255] > 0)
    rows.push({
      id: -1,
      name,
      key: name,
      kind: "not settled",
      period: 0,
      winding: 0,
      colour: name === "not settled" ? UNSETTLED : WAITING,
      hatched: name !== "not settled",
      share: counts[255] / frame.labels.length,
    });
  return rows;
}
