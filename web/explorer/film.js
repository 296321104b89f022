// A film: one value of the pendulum moves from a first value to a last. Played on the page, or recorded picture by
// picture.

import { element } from "./element.js";
import { pictureCanvas, pictureSize, pngOf, saveBlob } from "./save.js";
import { keyWords, numberOf, placeOf, valueAt, withUnit } from "./values.js";
import { zipOf } from "./zip.js";

const MOST = 1000; // pictures
const RATE = 25; // pictures a second
const KINDS = ["webm", "mp4"];
// Of half a slider: how far a sweep goes to either side of the scene's value, which the usual map holds
const SWEPT = 0.65;
const EACH = 1 / 160; // of half a slider, a picture of a sweep
const SKIPPED = 7; // pictures at most, where they are late
const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

export class Film {
  /** @param {import("./state.js").State} state
   * @param {import("./basins.js").Basins} basins
   * @param {string[]} names of the keys of the pendulum
   * @param {(name: string, value: number | string) => void} set gives a value to a key of the pendulum
   * @param {(...words: any[]) => void} complain */
  constructor(state, basins, names, set, complain) {
    this.state = state;
    this.basins = basins;
    this.set = set;
    this.complain = complain;
    this.running = null;
    this.onSweep = (_name) => {};
    for (const name of names) element("film-key").append(new Option(keyWords(name), name));
    element("film-key").value = names.find((name) => /amplitude|^m$/.test(name)) ?? names[0];
    element("film-key").onchange = () => this.propose();
    element("film-play").onclick = () => this.toggle(() => this.play());
    for (const kind of KINDS) {
      element(`film-${kind}`).disabled = !globalThis.MediaRecorder?.isTypeSupported(`video/${kind}`);
      element(`film-${kind}`).onclick = () => this.toggle(() => this.record(kind));
    }
    element("film-png").onclick = () => this.toggle(() => this.pngs());
    if (names.length) this.propose();
  }

  /** Ends of the scene's value less and more a tenth. */
  propose() {
    const { number, unit } = numberOf(this.state.scene[element("film-key").value]);
    const reach = number === 0 ? 0.1 : Math.abs(number) / 10;
    element("film-from").value = withUnit(Number((number - reach).toPrecision(6)), unit);
    element("film-to").value = withUnit(Number((number + reach).toPrecision(6)), unit);
  }

  stop() {
    this.running = null;
  }

  /** Starts what a button does, or ends what runs. The pendulum is then as before; not after the sweep of a slider, the
   * value `swept`. */
  async toggle(action, swept = null) {
    if (this.running) return this.stop();
    const mine = (this.running = { swept });
    const before = this.state[this.state.pane === "b" ? "other" : "pendulum"];
    this.showRunning();
    try {
      await action();
    } catch (error) {
      this.complain(error.message);
    }
    if (this.running === mine) this.running = null;
    if (swept === null) this.state.change({ [this.state.pane === "b" ? "other" : "pendulum"]: before });
    this.showRunning();
  }

  showRunning() {
    this.say("");
    element("film-play").textContent = this.running ? "Stop" : "Play";
    element("film-play").setAttribute("aria-pressed", String(Boolean(this.running)));
    this.onSweep(this.running?.swept ?? null);
  }

  say(words) {
    element("film-state").textContent = words;
  }

  /** Value number n of `count`. */
  valueAt(n, count) {
    const [from, to] = [numberOf(element("film-from").value), numberOf(element("film-to").value)];
    if (!from || !to) throw new Error("the film's first and last value must be numbers");
    return withUnit(Number((from.number + ((to.number - from.number) * n) / (count - 1)).toPrecision(8)), from.unit);
  }

  /** Pictures that the film has. */
  count() {
    const count = Number(element("film-count").value);
    if (!(Number.isInteger(count) && count >= 2 && count <= MOST)) throw new Error(
      `the number of pictures of a film must be from 2 to ${MOST}`);
    return count;
  }

  /** To the last value and back, until it is stopped. */
  async play() {
    const count = this.count();
    await this.loop(element("film-key").value,
      (n) => this.valueAt(n % (2 * count) < count ? n % count : count - 1 - (n % count), count));
  }

  /** Moves a slider there and back from where it is, until it is stopped or another one is swept. */
  sweep(name) {
    const swept = this.running?.swept;
    const stops = this.running && (swept === null || swept === name);
    this.stop();
    if (stops) return;
    const { state } = this;
    const home = state.scene[name];
    const [low, high] = this.endsOf(name, home);
    const now = placeOf(state[state.pane === "b" ? "other" : "pendulum"][name], home);
    const [count, first] = [high - low, Math.max(low, Math.min(high, now)) - low].map((way) => Math.round(way / EACH));
    const fold = (n) => (n % (2 * count) <= count ? n % (2 * count) : 2 * count - (n % (2 * count)));
    state.keep();
    this.toggle(() => this.loop(name, (n) => valueAt(low + fold(first + n) * EACH, home), SKIPPED), name);
  }

  /** Places of a slider between which it is swept: no further than the map has motions. */
  endsOf(name, home) {
    const axis = this.state.ground?.axes.find((one) => one.name === name && one.unit === numberOf(home).unit);
    const edges = axis ? [axis.low, axis.high].map((edge) => placeOf(withUnit(edge, axis.unit), home)) : [-1, 1];
    return [Math.max(-SWEPT, Math.min(...edges)), Math.min(SWEPT, Math.max(...edges))];
  }

  /** Shows value number n, each when the picture of the one before is there, until it is stopped; where pictures are
   * late it skips so many. */
  async loop(name, valueOf, skips = 0) {
    const { running, basins } = this;
    const waits = () => basins.active.top?.key !== JSON.stringify(basins.active.pendulum)
      && document.body.dataset.state !== "error";
    for (let n = 0, last = performance.now(); this.running === running; ) {
      this.set(name, valueOf(n));
      await pause(1000 / RATE);
      while (this.running === running && waits()) await pause(10);
      const late = Math.floor(((performance.now() - last) * RATE) / 1000) - 1;
      n += 1 + Math.max(0, Math.min(skips, late));
      last = performance.now();
    }
  }

  /** Calls `take(n)` on every picture, each when its labels are there as right and fine as the page asks for. */
  async pictures(take) {
    const count = this.count();
    const all = element("film-loop").checked ? 2 * count - 2 : count; // back without the pictures at both ends
    for (let n = 0; this.running && n < all; n++) {
      this.say(`picture ${n + 1} of ${all}`);
      this.set(element("film-key").value, this.valueAt(n < count ? n : 2 * count - 2 - n, count));
      while (this.running && !["done", "error"].includes(document.body.dataset.state)) await pause(20);
      if (this.running && document.body.dataset.state === "error") throw new Error(element("status").textContent);
      if (this.running) await take(n);
    }
  }

  async pngs() {
    const files = [];
    await this.pictures(async (n) => {
      const blob = await pngOf(pictureCanvas(this.state, this.basins));
      files.push({ name: `film-${String(n).padStart(3, "0")}.png`, bytes: new Uint8Array(await blob.arrayBuffer()) });
    });
    if (files.length) saveBlob("film.zip", zipOf(files));
  }

  /** As a video of one of KINDS. */
  async record(kind) {
    const bitmaps = [];
    await this.pictures(async () => bitmaps.push(await createImageBitmap(pictureCanvas(this.state, this.basins, 1))));
    if (!bitmaps.length) return;
    this.say("recording …");
    saveBlob(`film.${kind}`, await recorded(bitmaps, pictureSize(this.basins), `video/${kind}`));
  }
}

/** A film of pictures, recorded as they are shown in turn; codecs take even sizes alone.
 * @param {ImageBitmap[]} bitmaps @param {number[]} size @param {string} mimeType */
async function recorded(bitmaps, [wide, high], mimeType) {
  const [width, height] = [wide, high].map((side) => 2 * Math.floor(side / 2));
  const canvas = Object.assign(document.createElement("canvas"), { width, height });
  const context = canvas.getContext("2d");
  const stream = canvas.captureStream(0);
  const recorder = new MediaRecorder(stream, { mimeType, videoBitsPerSecond: 8e6 });
  const parts = [];
  recorder.ondataavailable = (event) => parts.push(event.data);
  let started = false;
  recorder.onstart = () => (started = true);
  const ended = new Promise((resolve) => (recorder.onstop = resolve));
  const show = async (bitmap) => {
    context.drawImage(bitmap, 0, 0);
    /** @type {any} */ (stream.getVideoTracks()[0]).requestFrame();
    await pause(1000 / RATE);
  };
  recorder.start();
  while (!started) await show(bitmaps[0]); // it starts with a picture, and loses those before
  for (const bitmap of bitmaps) await show(bitmap);
  await pause(500); // the last pictures are still under way
  recorder.stop();
  await ended;
  return new Blob(parts, { type: mimeType });
}
