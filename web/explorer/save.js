// Files of what is seen: a scene, pictures, tables.

import { ask, Engine } from "./engine.js";
import { asScene } from "./frames.js";
import { rowsOf, shareWords } from "./legend.js";
import { shadingOf } from "./heights.js";
import { Painter2d } from "./painter2d.js";
import { Plane } from "./plane.js";
import { withTexts } from "./png.js";
import { addressOf } from "./state.js";
import { CanvasSurface, LIGHT, SvgSurface } from "./surface.js";
import { signed } from "./ticks.js";

const SCENE_IN_PNG = "kapitza scene"; // keywords of texts in pictures: a scene for the program,
export const VIEW_IN_PNG = "kapitza view"; // and what the page shows
const LEGEND = 250; // px beside a saved picture
const HEAD = 28;
const MOST = 1 << 24; // cells of a frame

export function saveBlob(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

export function saveText(name, text, kind) {
  saveBlob(name, new Blob([text], { type: kind }));
}

export async function copyText(text) {
  await navigator.clipboard.writeText(text);
}

/** The view of a pane as a scene that gives the same labels. */
export async function saveScene(state, pane) {
  saveText("view.yaml", await sceneOf(state, pane), "application/yaml");
}

async function sceneOf(state, pane) {
  const frame = pane.top;
  const body = {
    window: state.window.centred("down").toRequest(), // as its frames are asked for
    pendulum: asScene(pane.pendulum),
    rows: frame?.rows ?? pane.basins.height,
    columns: frame?.columns ?? pane.basins.width,
  };
  return (await ask("scene", body)).text;
}

/** Size of a picture of all panes with their legend. */
export function pictureSize(basins) {
  const wide = basins.panes.reduce((sum, pane) => sum + pane.over.clientWidth, 0);
  return [wide + LEGEND, basins.panes[0].over.clientHeight + HEAD];
}

/** All panes beside each other, title above and legend beside, on white. `pictures`: of the basins, of panes that have
 * another one. */
export function drawPicture(surface, state, basins, pictures = new Map()) {
  const [width, height] = pictureSize(basins);
  surface.rectangle(0, 0, width, height, LIGHT.paper);
  surface.text(state.shownTitle, 66, 20, "left", { size: 16 });
  let left = 0;
  for (const pane of basins.panes) {
    drawPane(surface, pane, left, basins.captionOf(pane), pictures.get(pane));
    left += pane.over.clientWidth;
  }
  rowsOf(basins.panes).forEach((row, i) => {
    surface.rectangle(left + 8, HEAD + 12 + 20 * i, 13, 13, LIGHT.ink);
    surface.rectangle(left + 9, HEAD + 13 + 20 * i, 11, 11, row.colour);
    surface.text(signed(row.name), left + 28, HEAD + 23 + 20 * i, "left");
    surface.text(row.shares.map(shareWords).join("  "), left + 240, HEAD + 23 + 20 * i, "right");
  });
}

function drawPane(surface, pane, left, caption, picture) {
  const window = picture ? pane.state.window : pane.window; // of the picture; of what is on its way there
  const plane = new Plane(window, pane.over.clientWidth, pane.over.clientHeight);
  plane.box = [plane.box[0] + left, plane.box[1] + HEAD, plane.box[2], plane.box[3]];
  pane.drawNow(); // the painter's canvas is read in the same turn in which it is drawn
  surface.image(picture ?? pane.basins, plane.box);
  pane.drawOver(surface, plane);
  if (caption) surface.text(caption, plane.box[0] + 6, plane.box[1] + 16, "left");
}

export function pictureCanvas(state, basins, scale = 2, pictures = new Map()) {
  const [width, height] = pictureSize(basins);
  const canvas = Object.assign(document.createElement("canvas"),
    { width: Math.round(scale * width), height: Math.round(scale * height) });
  const context = canvas.getContext("2d");
  context.scale(scale, scale);
  drawPicture(new CanvasSurface(context, LIGHT), state, basins, pictures);
  return canvas;
}

/** A picture `width` px wide, whose basins are computed for that size; as large as the screen shows it without `width`.
 * The view is in it. */
export async function savePng(state, basins, width) {
  const canvas = await canvasOf(state, basins, width);
  const { title, scene, whole, pivotFrequency } = state;
  const view = JSON.stringify({ title, scene, whole: whole.toRequest(), pivotFrequency, address: addressOf(state) });
  const texts = { Software: "kapitza", [SCENE_IN_PNG]: await sceneOf(state, basins.active), [VIEW_IN_PNG]: view };
  saveBlob("view.png", await withTexts(await pngOf(canvas), texts));
}

async function canvasOf(state, basins, width) {
  if (!width) return pictureCanvas(state, basins);
  const scale = width / pictureSize(basins)[0];
  const pictures = new Map();
  const address = addressOf(state);
  for (const pane of basins.panes) pictures.set(pane, await computed(state, pane, scale));
  if (addressOf(state) !== address) throw new Error(
    "The view has changed while its picture was computed. Save it again.");
  return pictureCanvas(state, basins, scale, pictures);
}

/** The basins of a pane, a cell a pixel of a picture that is `scale` times as large as that on the page. They have a
 * program of their own, so that the page goes on with what it computes. */
async function computed(state, pane, scale) {
  const engine = new Engine(`${pane.name}-picture`);
  const [, , wide, high] = pane.plane.box;
  const canvas = Object.assign(document.createElement("canvas"),
    { width: Math.round(wide * scale), height: Math.round(high * scale) });
  const { window, quality, shade } = state;
  try {
    const frame = await pane.glance(window, canvas, { quality, shade, most: MOST, engine });
    if (shade === "relief") await pane.raise(frame, window, canvas, engine);
    new Painter2d(canvas).draw([frame], window, shadingOf(shade));
  } finally {
    engine.close();
  }
  return canvas;
}

export function pngOf(canvas) {
  return new Promise((resolve) => canvas.toBlob(resolve));
}

export function saveSvg(state, basins) {
  const surface = new SvgSurface(...pictureSize(basins));
  drawPicture(surface, state, basins);
  saveText("view.svg", surface.toString(), "image/svg+xml");
}
