// The library in a worker (include/kapitza.h, as WebAssembly): requests of the page become calls, structures answers.

import { flow } from "./flow.js";

// Planes in the order of kapitza.h, and bytes of a cell.
const PLANES = { labels: 1, settling_time: 4, smooth_time: 4, doubt: 1, other: 1, turns: 4, evidence: 1 };
const CENTRES = ["down", "inverted", "rotating", "neither"];
const [OK, STOPPED] = [0, 75];
const NO_TURNS = -(2 ** 31);
const PAUSE = 50; // ms between two looks whether the request is still wanted
const text = new TextEncoder();
const words = new TextDecoder();
const empty = new Uint8Array(0);

/** @type {any} */
let engine;
let layout, scene, pendulum;
let orbits = { key: null, pendulum: null }; // the pendulum of the last orbit
let answering = null; // the request: {sequence, url, canStop, due, shown, version}
const views = () => new DataView(engine.memory.buffer);

onmessage = async ({ data }) => {
  if (data.module !== undefined) return begin(data).catch((error) => postMessage({ misfit: true, why: String(error) }));
  answer(data);
};

async function begin({ module, layout: own, scene: given }) {
  const page = {
    now: () => performance.timeOrigin + performance.now(),
    show: (_, part) => answering.shown(Number(part)),
    between: () => Number(isUnwanted()),
    stop: () => {
      throw new Error("the engine ran out of memory, or a call of it was left");
    },
  };
  const imports = { page, env: {} };
  for (const { module: from, name } of WebAssembly.Module.imports(module))
    imports[from][name] ??= () => {
      throw new Error("this needs the program: kapitza view SCENE");
    };
  engine = new WebAssembly.Instance(module, imports).exports;
  if (!engine.page_fits()) throw new Error("this processor does not fuse");
  [layout, scene] = [own, given];
  pendulum = pendulumOf(flow(scene));
  postMessage({ header: { answer: "ready" } });
}

/* ---- memory ---- */

/** Calls `work` with a function that puts texts, bytes and structures into memory, which is freed behind it. */
function within(work) {
  const taken = [];
  const put = (bytes) => {
    const at = engine.page_malloc(BigInt(bytes.length));
    taken.push(at);
    new Uint8Array(engine.memory.buffer, Number(at), bytes.length).set(bytes);
    return at;
  };
  try {
    return work(put, (line) => put(text.encode(`${line}\0`)));
  } finally {
    taken.forEach((at) => engine.kapitza_free(at));
  }
}

function textAt(at) {
  const bytes = new Uint8Array(engine.memory.buffer, at);
  return words.decode(bytes.slice(0, bytes.indexOf(0)));
}

const READ = {
  i1: (view, at) => view.getInt8(at),
  u1: (view, at) => view.getUint8(at),
  i2: (view, at) => view.getInt16(at, true),
  i4: (view, at) => view.getInt32(at, true),
  i8: (view, at) => Number(view.getBigInt64(at, true)),
  f4: (view, at) => view.getFloat32(at, true),
  f8: (view, at) => view.getFloat64(at, true),
  p8: (view, at) => view.getUint32(at, true),
  c1: (_, at) => textAt(at),
};

/** A structure as an object; pointers are addresses.
 * @returns {any} */
function read(name, at) {
  const view = views();
  const own = {};
  for (const [field, [offset, kind, count]] of Object.entries(layout[name].fields)) {
    const one = (i) => (kind in READ ? READ[kind](view, at + offset + i * Number(kind[1])) : read(kind, at + offset));
    own[field] = count === null || kind === "c1" ? one(0) : Array.from({ length: count }, (_, i) => one(i));
  }
  return own;
}

const doubles = (at, count) => Array.from(new Float64Array(engine.memory.buffer, at, count));
const listOf = (name, at, count) => Array.from({ length: count }, (_, i) => read(name, at + i * layout[name].size));

/** What a call has found; throws the library's own words where it refuses. */
function checked(status) {
  if (status === STOPPED) throw new DOMException("another request was made", "AbortError");
  if (status !== OK) throw new Error(textAt(Number(engine.kapitza_message())).replace(/^(scene|change):\d+:\d+: /, ""));
}

/** The structure whose address a call writes behind its arguments; freed after `use`. */
function given(call, use) {
  return within((put) => {
    const place = put(new Uint8Array(8));
    checked(call(place));
    const at = views().getUint32(Number(place), true);
    try {
      return use(at);
    } finally {
      engine.kapitza_free(BigInt(at));
    }
  });
}

function pendulumOf(line) {
  return within((put, say) => {
    const place = put(new Uint8Array(8));
    checked(engine.kapitza_pendulum_create(say(line), place));
    return BigInt(views().getUint32(Number(place), true));
  });
}

/* ---- answers ---- */

const finite = (value) => (Number.isFinite(value) ? value : null);
const changeOf = (changed, mappings = {}) => flow({ ...(changed && { pendulum: changed }), ...mappings }).slice(1, -1);

function tell(header, bytes = empty) {
  const moved = bytes.length ? [bytes.buffer] : [];
  postMessage({ header: { ...header, sequence: answering.sequence, bytes: bytes.length }, bytes }, { transfer: moved });
}

/** Whether the request has been given up: its address, by which a page can tell a worker that works, is gone. */
function isUnwanted() {
  if (!answering.canStop || performance.now() < answering.due) return false;
  answering.due = performance.now() + PAUSE;
  return !isThere(answering.url);
}

function isThere(url) {
  try {
    const asked = new XMLHttpRequest();
    asked.open("GET", url, false);
    asked.send();
    return true;
  } catch {
    return false;
  }
}

function answer({ request, url }) {
  answering = { sequence: request.sequence, url, canStop: url.startsWith("blob:http"), due: 0, version: 0 };
  try {
    if (isUnwanted()) throw new DOMException("ended before it began", "AbortError");
    REQUESTS[request.request](request);
  } catch (error) {
    if (error.name === "AbortError") tell({ answer: "ended", final: true });
    else {
      const fatal = error instanceof WebAssembly.RuntimeError || /^(the engine|this needs)/.test(error.message);
      const header = { answer: "error", final: true, sequence: request.sequence, message: error.message };
      postMessage({ header, bytes: empty, fatal });
    }
  }
}

/** The kind of a motion, as kapitza.style.kind says it. */
function kindOf({ period, winding, centre }) {
  if (period === 0 && winding === 0) return "chaotic";
  if (centre === 2) return `${period > 0 ? "rotation" : "running"} ${winding > 0 ? "+" : "-"}`;
  if (centre === 1) return { 1: "inverted", 2: "flutter" }[period] ?? "inverted nodding";
  if (centre === 0) return period === 1 ? "down" : "down nodding";
  return "other";
}

function catalogueAt(at) {
  const own = read("kapitza_catalogue", at);
  const { k, beta, m, quality_factor, drive_frequency, drive_amplitude } = own.parameters;
  const view = views();
  const attractors = listOf("kapitza_cycle", own.attractors.cycle, own.attractors.count).map((row, id) => {
    const [theta, velocity] = [row.theta, row.velocity].map((place) => (place ? doubles(place, row.period) : []));
    return {
      id,
      track: READ.i8(view, own.track + 8 * id),
      name: row.name,
      kind: kindOf(row),
      period: row.period,
      winding: row.winding,
      centre: CENTRES[row.centre],
      symmetric: row.symmetric === 1,
      mirror: row.mirror,
      mean_velocity: finite(row.mean_velocity),
      multiplier: row.period ? finite(Math.hypot(row.multiplier_re[0], row.multiplier_im[0])) : null,
      strobe: theta.map((angle, i) => [angle, velocity[i]]),
    };
  });
  const numbers = Object.entries({ k, damping: beta, m, quality_factor, drive_frequency, drive_amplitude });
  const pendulumNumbers = Object.fromEntries(numbers.map(([name, value]) => [name, finite(value)]));
  return { answer: "catalogue", version: own.version, pendulum: pendulumNumbers, attractors };
}

function bytesAt(pieces) {
  const bytes = new Uint8Array(pieces.reduce((sum, [, length]) => sum + length, 0));
  let at = 0;
  for (const [from, length] of pieces) {
    bytes.set(new Uint8Array(engine.memory.buffer, from, length), at);
    at += length;
  }
  return bytes;
}

const rasterOf = ({ coarseness: level, rows, columns, last }) => ({ level, rows, columns, final: last === 1 });

const REQUESTS = {
  frame({ pendulum: changed, window, rows, columns, quality = "exact", levels = [1], planes = ["labels"] }) {
    const names = Object.keys(PLANES).filter((name) => planes.includes(name));
    answering.shown = (at) => {
      const part = read("kapitza_frame_part", at);
      const own = catalogueAt(part.catalogue);
      if (own.version !== answering.version) tell({ ...own, final: false });
      answering.version = own.version;
      const cells = part.rows * part.columns;
      const bytes = bytesAt(names.map((name) => [part.plane[Object.keys(PLANES).indexOf(name)], cells * PLANES[name]]));
      const made = { quality, planes: names, catalogue: own.version, milliseconds: 1e3 * part.seconds };
      tell({ answer: "frame", ...rasterOf(part), ...made }, bytes);
      return 0;
    };
    const basin = { theta: { ...window?.theta, count: columns }, velocity: { ...window?.velocity, count: rows } };
    within((put, say) => {
      const { size, fields } = layout.kapitza_frame_request;
      const asked = new DataView(new ArrayBuffer(size));
      const set = (name, value, i = 0) => asked.setInt32(fields[name][0] + 4 * i, value, true);
      asked.setBigUint64(fields.change[0], say(changeOf(changed, { basin })), true);
      set("moving", Number(quality === "moving"));
      set("planes", names.reduce((sum, name) => sum + 2 ** Object.keys(PLANES).indexOf(name), 0));
      set("n_parts", levels.length);
      levels.forEach((level, i) => set("coarseness", level, i));
      checked(engine.page_frame(pendulum, put(new Uint8Array(asked.buffer))));
    });
  },

  chart({ pendulum: changed, x, y, levels = [1] }) {
    answering.shown = (at) => {
      const part = read("kapitza_chart_part", at);
      const cells = part.rows * part.columns;
      tell({ answer: "chart", ...rasterOf(part) }, bytesAt([[part.period, cells], [part.centre, cells]]));
      return 0;
    };
    const sweep = { measure: ["ends"], ends: { theta: [3] }, x, y };
    within((put, say) => {
      const steps = put(new Uint8Array(Int32Array.from(levels).buffer));
      checked(engine.page_chart(pendulum, say(changeOf(changed, { sweep })), levels.length, steps));
    });
  },

  catalogue({ pendulum: changed }) {
    within((_, say) => {
      const change = changed ? say(changeOf(changed)) : 0n;
      const show = (at) => tell({ ...catalogueAt(at), final: true });
      given((place) => engine.kapitza_catalogue_of(pendulum, change, place), show);
    });
  },

  where({ theta, velocity, pendulum: changed }) {
    within((put, say) => {
      const lines = [theta, velocity].map((number) => say(String(number)));
      const start = lines.map((at) => put(new Uint8Array(BigUint64Array.of(at).buffer)));
      const change = changed ? say(changeOf(changed)) : 0n;
      given(
        (place) => engine.kapitza_where(pendulum, change, 1n, ...start, place),
        (at) => tell({ answer: "where", ...endingAt(at), final: true }),
      );
    });
  },

  orbit({ theta, velocity, pendulum: changed, periods = 100, transient = 0, samples_per_period = 64 }) {
    const key = flow({ ...scene, ...(changed && { pendulum: changed }) });
    if (orbits.key !== key) {
      if (orbits.pendulum) engine.kapitza_pendulum_free(orbits.pendulum);
      orbits = { key: null, pendulum: null };
      orbits = { key, pendulum: pendulumOf(key) };
    }
    const samples = periods * samples_per_period + 1;
    within((put) => {
      const [angles, speeds] = [0, 0].map(() => put(new Uint8Array(8 * samples)));
      const counts = [transient, periods, samples_per_period].map(BigInt);
      checked(engine.kapitza_orbit(orbits.pendulum, Number(theta), Number(velocity), ...counts, angles, speeds));
      const turn = Float64Array.from({ length: samples_per_period }, (_, i) => (2 * Math.PI * i) / samples_per_period);
      const [times, places] = [put(new Uint8Array(turn.buffer)), put(new Uint8Array(16 * samples_per_period))];
      checked(engine.kapitza_pivot(orbits.pendulum, BigInt(samples_per_period), times, places));
      const place = doubles(Number(places), 2 * samples_per_period);
      const pivot = Array.from({ length: samples_per_period }, (_, i) => [place[2 * i], place[2 * i + 1]]);
      const own = put(new Uint8Array(layout.kapitza_parameters.size));
      checked(engine.kapitza_parameters_of(orbits.pendulum, own));
      const { k, beta, m } = read("kapitza_parameters", Number(own));
      const header = { answer: "orbit", final: true, samples, samples_per_period, transient, damping: beta, k, m };
      tell({ ...header, pivot }, bytesAt([angles, speeds].map((at) => [Number(at), 8 * samples])));
    });
  },
};

/** The row of a kapitza_endings, as `kapitza where --json` has it. */
function endingAt(at) {
  const own = read("kapitza_endings", at);
  const row = read("kapitza_ending", own.ending);
  const isSettled = row.attractor >= 0;
  const settled = (value) => (isSettled ? value : null);
  const pointsAt = (place) => (place ? doubles(place, row.period) : []);
  return {
    theta: row.theta,
    velocity: row.velocity,
    attractor: row.attractor,
    name: row.name || null,
    period: settled(row.period),
    winding: settled(row.winding),
    settling_time: settled(row.settling_time),
    decided: row.precision !== "",
    strobe_theta: pointsAt(row.strobe_theta),
    strobe_velocity: pointsAt(row.strobe_velocity),
    precision: row.precision || null,
    error: finite(row.error),
    other_attractor: row.other,
    other_name: row.other_name || null,
    near_time: row.near_time >= 0 ? row.near_time : null,
    turns: isSettled && row.turns !== NO_TURNS ? row.turns : null,
    mean_velocity: isSettled ? finite(row.mean_velocity) : null,
  };
}
