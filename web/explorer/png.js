// Texts in PNG pictures (chunks iTXt): a picture holds the view that it shows, and opens it again.

import { crcOf } from "./zip.js";

const SIGNATURE = [137, 80, 78, 71, 13, 10, 26, 10];
const HEAD = 33; // bytes of the signature and of the first chunk, behind which texts may stand

/** A picture with texts, {keyword: text}; keywords are ASCII. */
export async function withTexts(blob, texts) {
  const bytes = new Uint8Array(await blob.arrayBuffer());
  return new Blob([bytes.subarray(0, HEAD), ...Object.entries(texts).map((entry) => chunkOf(...entry)),
    bytes.subarray(HEAD)], { type: "image/png" });
}

/** A chunk iTXt: keyword, no compression, no language, text. */
function chunkOf(keyword, text) {
  const data = new TextEncoder().encode(`iTXt${keyword}\0\0\0\0\0${text}`);
  const chunk = new Uint8Array(data.length + 8);
  const view = new DataView(chunk.buffer);
  view.setUint32(0, data.length - 4);
  chunk.set(data, 4);
  view.setUint32(data.length + 4, crcOf(data));
  return chunk;
}

/** The texts of a picture, {keyword: text}; none where the bytes are no PNG. */
export function textsIn(bytes) {
  const found = {};
  if (!SIGNATURE.every((value, i) => bytes[i] === value)) return found;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  for (let at = SIGNATURE.length; at + 12 <= bytes.length; ) {
    const length = view.getUint32(at);
    const kind = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    const parts = kind === "iTXt" && /^([^\0]*)\0\0\0[^\0]*\0[^\0]*\0([^]*)$/.exec(
      new TextDecoder().decode(bytes.subarray(at + 8, at + 8 + length)));
    if (parts) found[parts[1]] = parts[2];
    at += length + 12;
  }
  return found;
}
