// The engine in this tab: the library as WebAssembly, in a worker for each view. It has no files and no runs.

import { colouredRows } from "./colours.js";
import { flow } from "./flow.js";
import { asScene } from "./frames.js";

const BUILDS = ["engine.wasm", "engine-plain.wasm"]; // with fused multiply-adds, and without
const asked = new URL(import.meta.url).search.slice(1); // a test may ask for one of them
const DRAWN = ["frame", "chart"]; // requests that a newer one ends
const empty = new Uint8Array(0);
const json = (name) => fetch(name).then((answer) => answer.json());
const catalogue = json("page.json");
const builds = BUILDS.filter((name) => !asked || name === asked).map((name) => ({ name, module: null }));

/** A build, fetched once for all views; null where the browser cannot compile it. */
function moduleOf(build) {
  return (build.module ??= fetch(build.name)
    .then((answer) => answer.arrayBuffer())
    .then((bytes) => WebAssembly.compile(bytes))
    .catch(() => null));
}

/** Nobody asks who comes; the page stays in the browser. */
export async function signIn() {
  navigator.serviceWorker?.register("offline.js").catch(() => {}); // a page of a file, or of http, is not kept
}

/** The scene that the address names, else the first one. */
async function sceneOf() {
  const { scenes } = await catalogue;
  const name = new URLSearchParams(location.hash.slice(1)).get("scene");
  return scenes.find((scene) => scene.name === name) ?? scenes[0];
}

const ANSWERS = {
  state: async () => {
    const { kinds } = await catalogue;
    return { ...(await sceneOf()), kinds, overlays: {}, choices: { samples: "1" } };
  },
  link: async () => ({ once: null }), // anybody may open it
  stories: async ({ text }) => {
    if (text !== undefined) throw beyond("A story of your own");
    return { stories: (await catalogue).stories };
  },
  scene: async ({ window, pendulum, rows, columns }) => {
    const [theta, velocity] = [{ ...window.theta, count: columns }, { ...window.velocity, count: rows }];
    const basin = `  theta: ${flow(theta)}\n  velocity: ${flow(velocity)}\n  method: exact\n`;
    return { text: `pendulum: ${flow(pendulum)}\nbasin:\n${basin}` };
  },
};

const beyond = (what) => new Error(`${what} needs the program: kapitza view SCENE`);

export async function ask(path, body = {}) {
  if (!ANSWERS[path]) throw beyond("This");
  return ANSWERS[path](body);
}

// eslint-disable-next-line require-yield
export async function* stream(path) {
  throw beyond(path === "atlas" ? "The map's curves" : "This");
}

/** A worker with the library, of the first build that fits browser and processor. */
async function begun() {
  const { layout } = await catalogue;
  const { pendulum, basin } = await sceneOf();
  for (const build of builds) {
    const module = await moduleOf(build);
    if (!module) continue;
    const worker = new Worker(new URL("tab_worker.js", import.meta.url), { type: "module" });
    const said = new Promise((resolve) => (worker.onmessage = resolve));
    worker.postMessage({ module, layout, scene: { pendulum: asScene(pendulum), basin } });
    if (!(await said).data.misfit) return worker;
    worker.terminate();
  }
  throw new Error("This browser cannot run the engine: it lacks SIMD of WebAssembly. Use kapitza view SCENE.");
}

/** One view's engine. A newer frame or chart ends the one before. */
export class Engine {
  constructor() {
    this.catalogue = null;
    this.colours = new Map();
    this.waiting = new Map(); // numbers of requests, and who gets their answers
    this.last = 0;
    this.running = null; // the frame or chart that is being made
    this.begin();
  }

  begin() {
    this.worker = begun().then((worker) => {
      worker.onmessage = ({ data }) => this.waiting.get(data.header.sequence)?.(data);
      return worker;
    });
  }

  /** Each answer to `request` in turn. Catalogues are kept, not handed on. */
  async *answers(request, signal) {
    if (request.request === "cancel") {
      this.end();
      yield [{ answer: "ended", final: true }, empty];
      return;
    }
    const isDrawn = DRAWN.includes(request.request);
    if (isDrawn || this.running?.request.quality === "exact") this.end(); // single starts do not wait for exact frames
    const sequence = ++this.last;
    const url = URL.createObjectURL(new Blob([])); // whoever takes it back ends the request: the worker looks
    if (isDrawn) this.running = { url, request };
    const arrived = [];
    let wake = () => {};
    this.waiting.set(sequence, (answer) => (arrived.push(answer), wake()));
    const leave = () => (URL.revokeObjectURL(url), wake());
    signal?.addEventListener("abort", leave, { once: true });
    try {
      (await this.worker).postMessage({ request: { ...request, sequence }, url });
      for (;;) {
        signal?.throwIfAborted();
        if (arrived.length === 0) {
          await new Promise((resolve) => (wake = () => resolve(null)));
          continue;
        }
        const { header, bytes, fatal } = arrived.shift();
        if (fatal) this.begin(); // that one is lost, with its memory
        if (header.answer === "error") throw new Error(header.message);
        if (header.answer === "catalogue") await this.keep(header);
        if (header.answer !== "catalogue" || request.request === "catalogue") yield [header, bytes];
        if (header.final) return;
      }
    } finally {
      URL.revokeObjectURL(url);
      this.waiting.delete(sequence);
      signal?.removeEventListener("abort", leave);
    }
  }

  /** Ends the frame or chart that is being made. */
  end() {
    if (this.running) URL.revokeObjectURL(this.running.url);
    this.running = null;
  }

  async keep(header) {
    header.attractors = colouredRows(header.attractors, (await catalogue).kinds, this.colours);
    this.catalogue = header;
  }

  /** The last answer to a request that has one. */
  async answer(request, signal) {
    let last = null;
    for await (const answer of this.answers(request, signal)) last = answer;
    return last;
  }

  async cancel() {
    this.end();
  }

  close() {
    this.worker.then((worker) => worker.terminate());
  }
}
