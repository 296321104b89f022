// One picture of basins: it asks the program for frames, keeps the last ones, and draws them with axes and marks over
// them.

import { drawOverBasins } from "./above.js";
import { Engine } from "./engine.js";
import { decoded, inColoursOf, MOST_MOVING, paletteOf, requestOf, sharesOf } from "./frames.js";
import { listedAt } from "./map_plane.js";
import { raise, shadingOf } from "./heights.js";
import { Inset } from "./inset.js";
import { frameOf, painterOn } from "./painter.js";
import { placementOf, seen } from "./placement.js";
import { Plane } from "./plane.js";
import { CanvasSurface, lettersOf } from "./surface.js";

const MOST_FRAMES = 6; // kept under each other while the window moves
const PATIENCE = 90; // ms after which a frame of a window that is no longer wanted is given up,
const BLIND = 1000; // and where nothing of it has been shown yet: on a slow machine things would never be seen to move
const QUIET = 60; // ms in which coarse levels of another pendulum are not shown: the whole frame comes at once
const REST = 160; // ms without a change, after which labels are made as right and fine as asked for
const LARGEST = 8192; // cells of a side, of a frame
const SMOOTH = 30; // ms that a frame may take while things move, which decides how many cells it has,
const FEWEST = 24_000; // at least
const EASE = 0.4; // of the way to the window wanted, a picture of the screen
const LEAP = 30;
const LATE = 500; // ms without a new picture, after which the last one is blurred
const COARSE = 40_000; // cells of the times that give a picture its relief

export class Pane {
  /** @param {HTMLElement} root
   * @param {string} name of its program
   * @param {import("./state.js").State} state
   * @param {object} calls
   * @param {(pane: Pane) => void} calls.report is called for every frame
   * @param {(pane: Pane, doing: string, words: string, share?: number) => void} calls.say hears it */
  constructor(root, name, state, { report, say }) {
    this.root = root;
    this.name = name;
    this.state = state;
    this.report = report;
    this.say = say;
    this.onPlain = () => {};
    /** @type {any} */ this.basins = root.querySelector(".basins");
    /** @type {any} */ this.over = root.querySelector(".over");
    this.engine = new Engine(name);
    this.engine.told = (words) => this.say(this, null, words);
    this.painter = painterOn(this.basins, state.painter === "2d");
    this.inset = new Inset(root.querySelector(".inset"), state);
    /** @type {any} */ this.offer = root.querySelector(".offer");
    this.frames = [];
    this.window = state.window;
    this.version = 0;
    this.most = MOST_MOVING;
    this.lent = 0; // others ask its program for frames, which end its own
    this.plain = { motion: null, marks: [], cursor: null, pointed: null, overlays: [], skeleton: null, releases: [],
      spread: null, bob: null, veil: null };
    this.controller = new AbortController();
    new ResizeObserver(() => this.resized()).observe(root);
    new IntersectionObserver(() => this.draw()).observe(root); // what changed out of sight may not have been drawn
  }

  get pendulum() {
    return this.name === "b" ? this.state.other : this.state.pendulum;
  }

  get plane() {
    return new Plane(this.window, this.over.clientWidth, this.over.clientHeight, lettersOf(document.body));
  }

  /** The last frame that came, which may be coarse, or of the pendulum before. */
  get top() {
    return this.frames.includes(this.latest) ? this.latest : null;
  }

  /** Whether the picture is not yet, or no longer, the one wanted. */
  get isStale() {
    return Boolean(this.top) && !this.shows(this.top);
  }

  /** Whether a frame is of the window and the pendulum that are wanted. */
  shows(frame) {
    if (frame?.key !== JSON.stringify(this.pendulum)) return false;
    return frame.window.equals(this.state.window.centred("down"));
  }

  /** The frames that are drawn: those of the window alone once one of them has every cell, lest patches of others
   * stay. */
  get drawnFrames() {
    const window = this.window.centred("down");
    const own = this.frames.filter((frame) => frame.window.equals(window));
    return own.some(({ level }) => level === 1) ? own : this.frames;
  }

  /** Whether the last labels wanted have been given up, or refused. */
  get isStopped() {
    return this.version === this.stopped || this.version === this.failed;
  }

  resized() {
    const ratio = devicePixelRatio || 1;
    const [left, top, width, height] = this.plane.box;
    Object.assign(this.over, { width: Math.round(this.over.clientWidth * ratio),
      height: Math.round(this.over.clientHeight * ratio) });
    Object.assign(this.basins, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    Object.assign(this.basins.style, { left: `${left}px`, top: `${top}px`, width: `${width}px`,
      height: `${height}px` });
    this.draw();
    this.changed();
  }

  /** The window, the pendulum or the quality that is wanted has changed. */
  changed() {
    this.version++;
    this.say(this, "moving", "", 0); // at once: the frame before may still be on its way
    this.offer.hidden = true;
    this.blurLate();
    this.giveUp();
    this.move();
    this.pursue();
  }

  /** Whether the last picture is blurred, as the one wanted is late. */
  blur(isLate = false) {
    clearTimeout(this.late);
    this.late = null;
    this.root.classList.toggle("stale", isLate);
  }

  blurLate() {
    if (this.isStale) this.late ??= setTimeout(() => this.blur(this.isStale), LATE);
  }

  /** Gives up a frame that is no longer wanted; soon, where its first level is not there. */
  giveUp() {
    const { controller } = this;
    const left = (this.arrived ? PATIENCE : BLIND) - (performance.now() - this.begun);
    clearTimeout(this.waiting);
    if (this.resting || left < 0) controller.abort();
    else if (!this.arrived) this.waiting = setTimeout(() => this.version !== this.pursued && controller.abort(), left);
  }

  /** Asks again for what was given up or refused. */
  resume() {
    if (this.isStopped) this.changed();
  }

  /** Moves the old picture towards the window wanted, a step for each picture of the screen. */
  move() {
    if (this.moving) return;
    const step = () => {
      this.moving = !this.window.equals(this.state.window);
      const near = Math.abs(Math.log(this.state.window.theta.width / this.window.theta.width)) < 0.004
        && this.nearlyThere();
      this.window = near || this.state.jump ? this.state.window : this.window.towards(this.state.window, this.ease());
      this.drawNow();
      if (this.moving) requestAnimationFrame(step);
    };
    this.moving = true;
    requestAnimationFrame(step);
  }

  /** The part of the way that the next picture goes; so much that windows LEAP times narrower are near in one step. */
  ease() {
    const ratio = this.window.theta.width / this.state.window.theta.width;
    return Math.max(EASE, 1 - LEAP / ratio);
  }

  nearlyThere() {
    const { left, bottom } = this.state.window.placeOf(this.window);
    return Math.abs(left) < 0.004 && Math.abs(bottom) < 0.004;
  }

  /** Asks for frames until the last one wanted is there: quickly while things change, then as right and fine as asked
   * for. */
  async pursue() {
    if (this.pursuing) return;
    this.pursuing = true;
    for (let done = -1; done !== this.version && !this.closed;) {
      const version = (this.pursued = this.version);
      try {
        if (this.ended === version) throw overtaken(); // while the frame before was on its way
        await this.frame({ quality: "moving", levels: [8, 4, 2, 1], samples: 1, most: this.most });
        this.measure(performance.now() - this.begun);
        if (version === this.version) await pause(REST);
        this.resting = true;
        if (version === this.version && this.stopped !== version) await this.rest(version);
      } catch (error) {
        this.resting = false;
        if (await this.again(error, version)) continue;
      }
      this.resting = false;
      done = version;
      if (this.isStopped && this.failed !== version && this.complete !== version) this.rested();
    }
    this.pursuing = false;
  }

  /** After a failure: whether the same frames are asked for once more, because others have ended them, and nobody has
   * cancelled them. */
  async again(error, version) {
    const wanted = () => version === this.version && !this.closed;
    if (!wanted()) return false;
    if (error.name !== "AbortError") this.refused(error);
    if (error.name !== "AbortError" || this.stopped === version) return false;
    do await pause(REST);
    while (this.lent > 0 && wanted());
    return wanted();
  }

  /** The next moving frames have so many cells that they take no longer than they may. */
  measure(milliseconds) {
    const change = Math.max(0.6, Math.min(1.2, SMOOTH / milliseconds));
    this.most = Math.max(FEWEST, Math.min(MOST_MOVING, this.most * change));
  }

  /** One request whose coarse levels already are as right as the last, which has several samples a pixel. */
  async rest(version) {
    const { quality } = this.state;
    const samples = Number(this.state.samples);
    this.say(this, "computing", quality === "exact" ? "deciding every label ..." : "computing more samples ...", 0);
    // What is seen meanwhile
    if (quality === "exact" && this.most < MOST_MOVING) await this.frame(
      { quality: "moving", levels: [1], samples: 1 });
    if (quality === "exact" || samples > 1 || this.most < MOST_MOVING) await this.frame(
      { quality, levels: [8, 4, 2, 1], samples });
    if (version === this.version) await this.shade();
    if (version !== this.version) return;
    this.complete = version;
    this.say(this, "done", this.words());
    const isPlain = this.top && sharesOf(this.top).filter(({ share }) => share > 0).length === 1;
    this.offer.hidden = !isPlain;
    if (isPlain) this.onPlain();
    const key = JSON.stringify(this.pendulum);
    if (!this.inset.wants(this.state.window, key)) return;
    this.inset.frame = Object.assign(await this.glance(this.state.home, this.inset.size), { key });
    this.draw();
  }

  /** Gives the picture its relief: times that vary smoothly, of fewer cells, because they take longer than labels. */
  async shade() {
    const { top } = this;
    if (this.state.shade !== "relief" || !top || top.raised) return;
    await this.raise(top, top.window, this.basins);
    this.painter.forget(top);
    this.draw();
  }

  async raise(frame, window, size, engine) {
    raise(frame, await this.glance(window, size, { shade: "settling", most: COARSE, engine }));
  }

  /** A frame of any window, of that many cells; quick unless `quality` and `shade` say otherwise; of another program
   * where `engine` is given. */
  async glance(window, size, { quality = "moving", shade = "none", most = undefined, engine = this.engine } = {}) {
    const settings = { quality, shade, most, levels: [1], samples: 1, largest: LARGEST };
    const request = requestOf(window, this.pendulum, size, settings);
    const controller = new AbortController();
    if (engine === this.engine) this.controller = controller;
    const [header, bytes] = await engine.answer(request, controller.signal);
    if (header.answer !== "frame") throw overtaken();
    const palette = paletteOf(inColoursOf(engine.catalogue, this.engine.catalogue));
    return frameOf({ ...header, full: [request.rows, request.columns] }, decoded(header, bytes), window, palette);
  }

  async frame({ quality, levels, samples, most = undefined }) {
    const { pendulum } = this;
    // A whole circle that is its own mirror image takes half the work
    const window = this.state.window.centred("down");
    const settings = {
      quality,
      levels,
      samples,
      largest: this.painter.largest,
      shade: this.state.shade,
      most,
    };
    const listed = quality === "moving" ? listedAt(this.state.ground, pendulum) : {};
    const request = { ...requestOf(window, pendulum, this.basins, settings), ...listed };
    const key = JSON.stringify(pendulum);
    this.controller = new AbortController();
    this.begun = performance.now();
    this.arrived = false;
    let last = null;
    for await (const [header, bytes] of this.engine.answers(request, this.controller.signal)) {
      if (header.answer !== "frame") throw overtaken();
      const same = this.frames.at(-1)?.key === key;
      if (!same && !header.final && performance.now() - this.begun < QUIET) continue;
      const { catalogue } = this.engine;
      const full = { ...header, full: [request.rows, request.columns] };
      const made = Object.assign(frameOf(full, decoded(header, bytes), window, paletteOf(catalogue, this.state.lit)),
        { key, catalogue, quality, samples });
      this.keep(made, last);
      this.arrived = true;
      last = made;
      this.say(this, null, null, 1 / header.level ** 2);
    }
  }

  /** Colours of the frames, after another basin is lit. */
  light() {
    for (const frame of this.frames) frame.palette = paletteOf(frame.catalogue, this.state.lit);
    this.draw();
  }

  /** A new frame, which takes the place of the coarser one of the same request. */
  keep(frame, coarser) {
    const covered = (old) => old.key !== frame.key || old === coarser
      || (frame.level === 1 && old.window.equals(frame.window));
    for (const old of this.frames.filter(covered)) this.painter.forget(old);
    this.frames = [...this.frames.filter((old) => !covered(old)), frame].sort((one, two) => cellOf(two) - cellOf(one));
    while (this.frames.length > MOST_FRAMES) this.painter.forget(
      ...this.frames.splice(this.frames[0] === frame ? 1 : 0, 1));
    this.latest = frame;
    this.blur();
    this.blurLate();
    this.draw();
    this.report(this);
  }

  refused(error) {
    this.failed = this.version;
    this.blur(this.isStale);
    this.draw();
    this.report(this);
    this.say(this, "error", error.message);
  }

  /** Gives up the labels that are being decided. The quick ones before them, without which nothing shows the window
   * wanted, are given up BLIND after they were asked for, or when this is called again. */
  cancel() {
    if (!this.pursuing || this.complete === this.version) return;
    const left = this.resting || this.stopped === this.version ? 0 : BLIND - (performance.now() - this.begun);
    this.stopped = this.version;
    clearTimeout(this.waiting);
    const end = () => {
      this.ended = this.stopped;
      this.controller.abort();
      this.engine.cancel().catch(() => {});
    };
    if (left > 0) this.waiting = setTimeout(end, left);
    else end();
  }

  /** What a cancelled picture is. */
  rested() {
    this.blur(this.isStale);
    this.draw();
    this.report(this);
    this.say(this, "done", "Cancelled. The picture is what was computed until then.");
  }

  words() {
    const top = this.top;
    if (!top || !this.over.clientWidth) return ""; // the motion fills the page
    const samples = top.samples > 1 ? `, ${top.samples} × ${top.samples} a pixel` : "";
    const right = top.quality === "exact" ? decidedWords(top.doubtful) : "quick labels";
    return `${top.columns} × ${top.rows} starts${samples}, ${right}`;
  }

  /** The frame and the cell of it that lie at a place of the window (shares): {frame, cell}, or null. */
  cellAt(across, up) {
    const key = JSON.stringify(this.pendulum);
    for (const frame of this.drawnFrames.filter((one) => one.key === key).reverse()) {
      const { place, period } = placementOf(frame, this.window);
      const x = ((across - place[0]) / place[2]) % period;
      const [column, row] = [Math.floor((x < 0 ? x + period : x) * frame.columns),
        Math.floor(((up - place[1]) / place[3]) * frame.rows)];
      if (column >= 0 && column < frame.columns && row >= 0 && row < frame.rows) return { frame,
        cell: row * frame.columns + column };
    }
    return null;
  }

  /** At the next picture of the screen, however often it is asked for. */
  draw() {
    this.drawn ??= requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    cancelAnimationFrame(this.drawn);
    this.drawn = null;
    this.painter.draw(seen(this.drawnFrames, this.window), this.window, shadingOf(this.state.shade));
    this.drawAbove();
    this.inset.draw(this.window);
  }

  /** What lies over the basins, which stay as they are: all that a motion changes. */
  drawAbove() {
    const ratio = devicePixelRatio || 1;
    const context = this.over.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.over.clientWidth, this.over.clientHeight);
    const surface = new CanvasSurface(context, this.state.colours, lettersOf(document.body));
    if (!this.isStale) this.blur();
    drawOverBasins(surface, this.plane, this.plain, this.state, this.isStopped && this.isStale ? null : this.top);
  }

  /** All that lies over the basins but the pointer, on any surface. */
  drawOver(surface, plane) {
    drawOverBasins(surface, plane, { ...this.plain, pointed: null, cursor: null }, this.state, this.top);
  }

  /** Ends its program. */
  close() {
    this.closed = true;
    this.version++; // nothing more is wanted
    this.controller.abort();
    this.engine.close();
  }
}

/** What a frame ends with that a newer one of the same program has ended. */
const overtaken = () => new DOMException("another frame was asked for", "AbortError");

const pause = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

/** Width of a cell, by which frames are laid over each other; of equal ones the exact frame lies on top. */
function cellOf(frame) {
  return ((frame.window.theta.width * frame.level) / frame.full[1]) * (frame.quality === "exact" ? 0.999 : 1);
}

function decidedWords(doubtful) {
  if (doubtful === undefined) return "exact labels";
  return doubtful === 0 ? "every label decided" : `${doubtful} undecided (striped)`;
}
