// Elements of the page.

/** The element with an id. Which kind it is, and so what it can do, stands in index.html.
 * @param {string} id
 * @returns {any} */
export const element = (id) => document.getElementById(id);
