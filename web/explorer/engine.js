// The engine of this page: the program behind `kapitza view`, or the library in this tab. Both have the same names.

const inTab = document.querySelector("meta[name=engine][content=tab]") !== null;

/** @type {typeof import("./served.js")} */
const own = inTab ? /** @type {any} */ (await import("./tab.js")) : await import("./served.js");

/** @typedef {import("./served.js").Engine} Engine */
export const { signIn, ask, stream, Engine } = own;
