// Requests to the server, which passes them on to the program, and the program's answers: headers, each followed by
// bytes.

const LINE_FEED = 10;
const KEY = `kapitza ${new URL(".", location.href).pathname}`; // of the token in the browser's storage
const storage = new Map(); // of this page; alone where the browser keeps nothing (a frame of another site)

/** The token of this page, traded once for the one in the address, which is then taken out of it. */
export async function signIn() {
  const given = new URLSearchParams(location.search).get("once");
  if (given) {
    history.replaceState(null, "", location.pathname + location.hash);
    const answer = await fetch("token", { method: "POST", body: JSON.stringify({ once: given }) });
    if (answer.ok) keep(KEY, (await answer.json()).token);
    else if (!kept(KEY)) throw new Error((await answer.json()).error);
  }
  if (!kept(KEY)) throw new Error(
    "Open the address that kapitza view has printed in the terminal. This one has no token.");
}

function keep(name, value) {
  storage.set(name, value);
  try {
    localStorage.setItem(name, value);
  } catch {
    // the page keeps it until it is closed
  }
}

function kept(name) {
  try {
    return storage.get(name) ?? localStorage.getItem(name); // the browser's may be that of a page of an earlier server
  } catch {
    return storage.get(name);
  }
}

async function post(path, body, signal) {
  const send = () => fetch(path, { method: "POST", headers: { "X-Kapitza-Token": kept(KEY) },
    body: JSON.stringify(body), signal });
  let answer = await send();
  // Of a server begun anew, the browser may know a newer one
  if (answer.status === 403 && storage.delete(KEY)) answer = await send();
  if (!answer.ok) throw new Error((await answer.json()).error);
  return answer;
}

/** JSON of a request that the server answers itself. */
export async function ask(path, body = {}) {
  return (await post(path, body)).json();
}

/** Each answer, [header, bytes], to a request that the server answers in parts. */
export async function* stream(path, body, signal) {
  yield* answersOf((await post(path, body, signal)).body);
}

/** Splits a stream into [header, bytes] as the program sent them. */
async function* answersOf(body) {
  let buffer = new Uint8Array(0);
  const reader = body.getReader();
  // Reads on until the buffer holds `count` bytes; joined once, so that a large frame is copied once.
  const hold = async (count) => {
    const parts = [buffer];
    let length = buffer.length;
    while (length < count) {
      const { value, done } = await reader.read();
      if (done) throw new Error("the program has ended");
      parts.push(value);
      length += value.length;
    }
    if (parts.length > 1) buffer = joined(parts, length);
  };
  const take = (count) => {
    const taken = buffer.slice(0, count);
    buffer = buffer.subarray(count);
    return taken;
  };
  for (;;) {
    let end = buffer.indexOf(LINE_FEED);
    for (; end < 0; end = buffer.indexOf(LINE_FEED)) await hold(buffer.length + 1);
    const header = JSON.parse(new TextDecoder().decode(take(end + 1)));
    await hold(header.bytes);
    yield [header, take(header.bytes)];
    if (header.final) return;
  }
}

function joined(parts, length) {
  const whole = new Uint8Array(length);
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}

/** One view's program. A newer request of a view ends the one before. */
export class Engine {
  constructor(view) {
    this.view = `${pageName()}-${view}`;
    this.catalogue = null;
    /** @type {(words: string) => void} */
    this.told = () => {}; // hears what happened to the view's program
  }

  /** Each answer to `request` in turn; throws the program's own words where it refuses. Catalogues are kept, not handed
   * on. */
  async *answers(request, signal) {
    for await (const [header, bytes] of stream(`ask?view=${this.view}`, request, signal)) {
      if (header.answer === "error") throw new Error(header.message);
      if (header.restarted) this.told(`${header.restarted}; it was started again`);
      if (header.answer === "catalogue") this.catalogue = header;
      if (header.answer === "catalogue" && request.request !== "catalogue") continue;
      yield [header, bytes];
    }
  }

  /** The last answer to a request that has one. */
  async answer(request, signal) {
    let last = null;
    for await (const answer of this.answers(request, signal)) last = answer;
    return last;
  }

  cancel() {
    return this.answer({ request: "cancel" });
  }

  /** Ends the view's program; also when the page is left. */
  close() {
    const body = JSON.stringify({ token: kept(KEY), view: this.view });
    navigator.sendBeacon("close", body);
  }
}

/** A name that tells this page from others of the same server, also after a reload. */
function pageName() {
  let name = null;
  try {
    name = sessionStorage.getItem("kapitza page");
    sessionStorage.setItem("kapitza page", (name ??= randomName()));
  } catch {
    name = storage.get("page") ?? randomName();
    storage.set("page", name);
  }
  return name;
}

function randomName() {
  return [...crypto.getRandomValues(new Uint32Array(3))].map((part) => part.toString(36)).join("");
}
