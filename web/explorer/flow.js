// Values as a scene has them on one line.

const PLAIN = /^[\w.+-][\w .+-]*$/;

/** Numbers that are texts, for their digits, stand without quotes. */
export function flow(value) {
  if (Array.isArray(value)) return `[${value.map(flow).join(", ")}]`;
  if (value === null || typeof value !== "object") return PLAIN.test(value) ? String(value) : JSON.stringify(value);
  return `{${Object.entries(value).map(([name, own]) => `${name}: ${flow(own)}`).join(", ")}}`;
}
