// The panes of basins together: one or two, their hands, their legend, the motion from a start, what the page says of
// them.

import { onBoundary } from "./boundary.js";
import { element } from "./element.js";
import { asScene, sharesOf } from "./frames.js";
import { listen } from "./gestures.js";
import { listenLegend, rowsOf, shareWords, writeLegend } from "./legend.js";
import { endingWords, Motion, plainEnding, settledAfter } from "./motion.js";
import { Pane } from "./pane.js";
import { Passport } from "./passport.js";
import { Stage } from "./stage.js";
import { likelyWords, rowAt, wordsAt } from "./pointed.js";
import { Skeleton } from "./skeleton.js";
import { signed } from "./ticks.js";
import { Units } from "./units.js";
import { veilOf } from "./veil.js";
import { TURN } from "./window.js";
import { kindOf, sentenceOf, verdictOf } from "./words.js";

const SECOND = 1.2; // drive periods that a second shows
const SAMPLES = 48; // of a motion, a drive period
const RESTS = 400; // ms after which the pointer rests, and the smallest push out of the basin under it is looked for
// The start that is played until one is chosen: near inverted, at rest
const FIRST = { theta: "3", velocity: "0", pane: "a" };
const [LEAST, MOST] = [24, 400]; // drive periods of a motion
const FRAME_KEYS = ["window", "pendulum", "other", "quality", "samples", "shade"];
// A wish of the reader's system: nothing moves until it is asked to
const stillness = matchMedia("(prefers-reduced-motion: reduce)");

export class Basins {
  constructor(state) {
    this.state = state;
    /** @type {Pane[]} */
    this.panes = [];
    /** @type {((pane: Pane, start: any) => void) | null} who takes a click instead */
    this.onClick = null;
    this.overlays = new Set(Object.keys(state.overlays));
    this.states = new Map();
    this.followed = 0;
    this.stage = new Stage(element("pendulum"));
    this.skeleton = new Skeleton(state, this, (words) => (element("status").textContent = words));
    this.passport = new Passport(state, this);
    state.listen((keys) => this.changed(keys));
    listenLegend(element("legend"), state, (key) => this.playAttractor(key));
    requestAnimationFrame((now) => this.tick(now));
  }

  get active() {
    return this.panes.find((pane) => pane.name === this.state.pane) ?? this.panes[0];
  }

  get units() {
    return new Units(this.state.units, this.state.pivotFrequency);
  }

  show() {
    this.arrange();
    this.write();
    this.follow();
  }

  /** The start whose motion is played. */
  get start() {
    return this.state.start ?? FIRST;
  }

  /** As many panes as there are pendulums. */
  arrange() {
    const wanted = this.state.other ? ["a", "b"] : ["a"];
    for (const pane of this.panes.filter(({ name }) => !wanted.includes(name))) {
      pane.root.remove();
      pane.close();
      this.states.delete(pane);
    }
    this.panes = wanted.map((name) => this.panes.find((pane) => pane.name === name) ?? this.add(name));
    for (const pane of this.panes)
      pane.over.setAttribute(
        "aria-label",
        `Basins ${this.state.other ? pane.name.toUpperCase() : ""}: wheel or + and − zoom, dragging or arrows move, ` +
          "a click plays the pendulum",
      );
  }

  add(name) {
    const root = element("pane").content.firstElementChild.cloneNode(true);
    element("panes").insertBefore(root, element("panes").querySelector(".chart"));
    const pane = new Pane(root, name, this.state,
      { report: () => this.write(), say: (...words) => this.say(...words) });
    listen(pane.over, this.handsOn(pane));
    pane.offer.onclick = () => element("nearest").click();
    pane.onPlain = () => this.state.drawn === "on" && this.inward === this.state.window && element("nearest").click();
    pane.plain.overlays = this.overlaysOf(pane);
    return pane;
  }

  handsOn(pane) {
    const shares = (x, y) => pane.plane.sharesOf(x, y);
    return {
      holds: (x, y) => pane.plane.holds(x, y),
      zoom: (factor, x, y) => this.zoom(factor, ...shares(x, y)),
      move: (dx, dy) => {
        const [, , width, height] = pane.plane.box;
        this.state.change({ window: this.state.window.moved(-dx / width, dy / height), jump: true });
      },
      click: (x, y) => this.click(pane, ...shares(x, y)),
      hover: (at) => this.point(pane, at && shares(...at)),
      grip: () => (this.before = this.state.window),
      release: () => {
        if (!this.before.equals(this.state.window)) this.state.keep(null, this.before);
        this.state.change({ window: this.state.window.wrapped(), jump: true });
      },
    };
  }

  zoom(factor, x = 0.5, y = 0.5) {
    const zoomed = this.state.window.zoomed(factor, x, y);
    const isHeld = this.state.drawn === "on" && factor < 1;
    const frame = this.active?.top;
    const window = isHeld && frame && this.active.shows(frame) ? onBoundary(zoomed, frame) : zoomed;
    this.inward = isHeld ? window : null; // which goes on to a boundary where it turns out to have one colour
    this.state.keep("zoom");
    this.state.change({ window, jump: false });
  }

  /** The start at shares of the window asked for, as decimal texts. */
  startAt(across, up) {
    const { theta, velocity } = this.state.window;
    return { theta: theta.at(across).toString(), velocity: velocity.at(up).toString() };
  }

  click(pane, across, up) {
    const start = this.startAt(across, up);
    if (this.onClick) return this.onClick(pane, start);
    this.state.change({ start: { ...start, pane: pane.name } });
  }

  changed(keys) {
    if (keys.has("other")) this.arrange();
    if (FRAME_KEYS.some((key) => keys.has(key))) for (const pane of this.panes) pane.changed();
    if (keys.has("pendulum") || keys.has("other")) this.forgetMotion();
    if (keys.has("start")) this.awaitMotion();
    if (keys.has("units") || keys.has("level")) this.writeEnding();
    if (keys.has("window") || keys.has("scene")) this.verdict = null;
    if (keys.has("letters")) for (const pane of this.panes) pane.resized();
    if (keys.has("view") || keys.has("colours")) this.drawStage();
    if (keys.has("start") || keys.has("pendulum") || keys.has("other")) this.followSoon();
    if (keys.has("lit")) for (const pane of this.panes) pane.light();
    else for (const pane of this.panes) pane.draw();
    this.write();
  }

  /** Asks again for what was given up or refused. */
  resume() {
    for (const pane of this.panes) pane.resume();
  }

  /** Follows an attractor itself, from one of its strobe points. */
  playAttractor(key) {
    const rows = this.active.top ? sharesOf(this.active.top).filter((one) => one.key === key || one.kind === key) : [];
    const row = rows.sort((one, other) => other.share - one.share).find(({ strobe }) => strobe?.length);
    if (row) this.state.change(
      { start: { theta: String(row.strobe[0][0]), velocity: String(row.strobe[0][1]), pane: this.active.name } });
  }

  // ---- the motion from a start ----

  forgetMotion() {
    this.motion = null;
    for (const pane of this.panes) Object.assign(pane.plain, { motion: null, overlays: this.overlaysOf(pane),
      skeleton: null });
    this.awaitMotion();
    this.drawStage();
  }

  /** Another motion is asked for; that of before is played on until it is there. */
  awaitMotion() {
    element("ending").textContent = "…";
    delete element("ending").dataset.ending;
    element("save-csv").disabled = element("play").disabled = true;
  }

  followSoon() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.follow(), 220);
  }

  async follow() {
    const { start } = this;
    const order = ++this.followed;
    const pane = this.panes.find(({ name }) => name === start.pane) ?? this.panes[0];
    const request = { theta: start.theta, velocity: start.velocity, pendulum: asScene(pane.pendulum) };
    let found = "";
    try {
      const [ending] = await pane.engine.answer({ request: "where", ...request });
      if (order !== this.followed) return;
      Object.assign(ending, start);
      found = `${signed(this.endingWords(ending))}\n`;
      const wanted = settledAfter(ending) + 4 * (ending.period || 1) + 8;
      const periods = Math.round(Math.max(LEAST, Math.min(MOST, wanted)));
      const orbit = { request: "orbit", ...request, samples_per_period: SAMPLES };
      const [header, bytes] = await pane.engine.answer({ ...orbit, periods });
      const strobe = () => ({ theta: ending.strobe_theta[0], velocity: ending.strobe_velocity[0],
        periods: ending.period });
      const cycle = ending.period > 0 ? await pane.engine.answer({ ...orbit, ...strobe() }) : null;
      if (order === this.followed) this.play(pane, new Motion(header, bytes, ending, cycle));
    } catch (error) {
      // A motion is not shown for every release
      if (order === this.followed) element("ending").textContent = found + error.message;
    }
  }

  play(pane, motion) {
    this.motion = motion;
    for (const other of this.panes) other.plain.motion = other === pane ? motion : null;
    this.writeEnding();
    element("ending").dataset.ending = JSON.stringify(motion.ending);
    element("save-csv").disabled = element("play").disabled = false;
    this.state.change({ playing: this.state.start !== null || !stillness.matches });
    this.drawStage(); // where it stands still, too
  }

  drawStage() {
    const { pivotFrequency, speed, view, colours } = this.state;
    const slower = pivotFrequency ? pivotFrequency / (TURN * SECOND * speed) : null;
    const rows = this.panes.flatMap(({ top, engine }) => (top?.catalogue ?? engine.catalogue)?.attractors ?? []);
    const name = this.motion?.ending.name; // whose basin may be too thin for the list
    const bob = name && (rows.find((row) => row.name === name)?.colour ?? this.state.kinds[kindOf(name)]);
    for (const pane of this.panes) pane.plain.bob = bob;
    this.stage.draw(this.motion, view, bob ? { ...colours, bob } : colours, this.units, slower);
  }

  writeEnding() {
    if (this.motion) element("ending").textContent = signed(this.endingWords(this.motion.ending));
  }

  endingWords(ending) {
    return this.state.level === "measure" ? endingWords(ending, this.units) : plainEnding(ending);
  }

  /** Thirty pictures a second; the rest of the time is theirs that are computed. */
  tick(now) {
    requestAnimationFrame((next) => this.tick(next));
    if (now - this.last < 30) return;
    const seconds = Math.min(0.1, (now - (this.last ?? now)) / 1000);
    this.last = now;
    if (this.motion && this.state.playing) {
      this.motion.advance(seconds * SECOND * this.state.speed);
      this.drawStage();
      for (const pane of this.panes) if (pane.plain.motion) pane.drawAbove();
    }
  }

  // ---- words ----

  overlaysOf(pane) {
    const same = JSON.stringify(pane.pendulum) === JSON.stringify(this.state.scene);
    return same ? [...this.overlays].map((name) => this.state.overlays[name]) : [];
  }

  /** Linked cursors; `at`: shares of the window, null where the pointer has left. */
  point(pane, at) {
    const half = this.spread;
    for (const other of this.panes) {
      other.plain[other === pane ? "pointed" : "cursor"] = at;
      other.plain[other === pane ? "cursor" : "pointed"] = null;
      other.plain.spread = at && half && [at, half];
      other.drawAbove();
    }
    this.pointed = at;
    clearTimeout(this.resting);
    const row = at && rowAt(pane, ...at);
    const measured = () => document.body.dataset.state === "done" && this.passport.measure(pane, row);
    if (row) this.resting = setTimeout(measured, RESTS);
    this.writePointed();
  }

  /** Half axes of the spread of releases by hand, in shares of the window: as much in angle (its setting) as in
   * velocity; null = none. */
  get spread() {
    const reach = (Number(this.state.spread) * Math.PI) / 180;
    const { theta, velocity } = this.state.window;
    const slow = this.state.home.velocity.width / TURN; // an angle counts as the same part of the first window
    return reach > 0 ? [reach / theta.width, (reach * slow) / velocity.width] : null;
  }

  /** What lies under the pointer, also when other frames come there. */
  writePointed() {
    const at = this.pointed;
    const wordsOf = (pane) => (this.spread ? likelyWords(pane, at, this.spread) : wordsAt(pane, this, ...at));
    const words = at ? this.panes.map(wordsOf).join("  |  ") : "";
    const start = at && this.startAt(...at);
    const [angle, speed] = at ? this.units.start(start).map(brief) : [];
    const place = this.state.level === "look" ? "A start here" : `θ ${angle}  velocity ${speed} `;
    element("pointer").textContent = at ? signed(`${place} ${words}`) : "";
  }

  say(pane, state, words, progress) {
    if (pane.closed) return; // its last frame may still come
    const known = this.states.get(pane) ?? {};
    this.states.set(pane, {
      state: state ?? known.state,
      words: words ?? known.words,
      progress: progress ?? (state === "done" ? 1 : known.progress),
    });
    const all = [...this.states.values()];
    const worst = ["error", "computing", "moving", "done"].find((name) => all.some((one) => one.state === name))
      ?? "starting";
    document.body.dataset.state = worst;
    element("status").textContent = all.find((one) => one.state === worst)?.words ?? "";
    element("progress").value = Math.min(...all.map((one) => one.progress ?? 0));
    const isStopped = worst === "done" && this.panes.some((one) => one.isStopped);
    element("cancel").textContent = isStopped ? "Resume" : "Cancel";
    element("cancel").disabled = !isStopped && worst !== "computing" && worst !== "moving";
    pane.root.querySelector(".wait").textContent =
      `${Math.round(100 * (this.states.get(pane).progress ?? 0))} % of the new picture`;
    const refusal = pane.root.querySelector(".refusal");
    refusal.hidden = this.states.get(pane).state !== "error";
    refusal.textContent = refusal.hidden ? "" : this.states.get(pane).words;
  }

  /** The legend and the window in words, once for each picture of the screen. */
  write() {
    this.written ??= requestAnimationFrame(() => {
      this.written = null;
      this.writeNow();
    });
  }

  writeNow() {
    this.writePointed();
    if (!this.state.playing) this.drawStage(); // the catalogue has the bob's colour
    const rows = rowsOf(this.panes, this.state.level === "look");
    writeLegend(element("legend"), rows);
    element("legend").classList.toggle("stale", this.panes.some((pane) => pane.isStale));
    this.writeSentence();
    const [one, other] = this.panes.map((pane) => !pane.isStale && pane.top);
    for (const pane of this.panes) pane.plain.veil = one && other ? veilOf(one, other) : null;
    this.passport.write(rows);
    const { theta, velocity } = this.state.window;
    const depth = this.state.home.theta.width / theta.width;
    const digits = Math.max(2, 3 - Math.floor(Math.log10(theta.width)));
    const middle = (range) => range.centre.rounded(digits).toString();
    const { units } = this;
    const centre = [units.angle(middle(theta), digits), units.velocity(middle(velocity), digits)];
    const [angle, speed] = centre.map((words) => signed(brief(words)));
    element("where").textContent =
      `Depth ${depth < 1e6 ? Number(depth.toPrecision(3)) : depth.toExponential(1)}×` +
      `  centre θ ${angle}, velocity ${speed}`;
    element("where").dataset.window = JSON.stringify(this.state.window.toRequest());
    element("where").dataset.depth = depth;
    for (const pane of this.panes) pane.root.querySelector(".caption").textContent = this.captionOf(pane);
  }

  /** What the ends of the window say of the pendulum, and whether that is new: of the last picture of it alone. */
  writeSentence() {
    const { active, state } = this;
    const top = active.isStale ? null : active.top;
    if (!top) return void (element("sentence").textContent = "");
    const found = verdictOf(top);
    const { key, kind, isNew: was } = this.verdict ?? { key: top.key };
    const isNew = Boolean(was) || (key !== top.key && kind !== found.kind);
    this.verdict = { key: top.key, kind: found.kind, isNew };
    element("sentence").textContent = sentenceOf(found, shareWords, state.window.equals(state.home), isNew);
    element("sentence").classList.toggle("new", isNew);
  }

  /** What tells a pane's pendulum from the other's. */
  captionOf(pane) {
    if (!this.state.other) return "";
    const differing = Object.keys(this.state.pendulum)
      .filter((name) => this.state.pendulum[name] !== this.state.other[name]);
    const values = differing.map((name) => `${name.replace(/_/g, " ")} ${pane.pendulum[name]}`);
    return `${pane.name.toUpperCase()}  ${values.join(", ")}`;
  }
}

const brief = (text) => (text.length > 26 ? `${text.slice(0, 12)}…${text.slice(-12)}` : text);
