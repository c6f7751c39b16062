/* The data that stands in this page: JSON elements, CSV, packed arrays; and how numbers are written. */
"use strict";
const quatspline = window.quatspline = {};

quatspline.data = (() => {
  const known = new Map();

  function read(id) {
    const element = document.getElementById(id);
    return element ? JSON.parse(element.textContent) : null;
  }

  /* RFC 4180: quoted fields may hold commas, quotes (doubled) and line ends. */
  function parseCsv(text) {
    const rows = [];
    let row = [], field = "", quoted = false;
    for (let i = 0; i < text.length; i++) {
      const c = text[i];
      if (quoted) {
        if (c === '"' && text[i + 1] === '"') { field += c; i++; }
        else if (c === '"') quoted = false;
        else field += c;
      } else if (c === '"') quoted = true;
      else if (c === ",") { row.push(field); field = ""; }
      else if (c === "\n") { row.push(field); rows.push(row); row = []; field = ""; }
      else if (c !== "\r") field += c;
    }
    if (field || row.length) { row.push(field); rows.push(row); }
    return rows;
  }

  const SPECIAL = { inf: Infinity, "-inf": -Infinity };
  const NUMERAL = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

  /* A field as a number, null where it is empty, otherwise its text. */
  function value(field) {
    if (field === "") return null;
    if (field in SPECIAL) return SPECIAL[field];
    return NUMERAL.test(field) ? Number(field) : field;
  }

  /* A table: its text, columns, rows of values; a column is numeric when all that it holds are numbers. */
  function table(name) {
    if (!known.has(name)) {
      const text = read(`csv-${name}`);
      const [columns, ...fields] = parseCsv(text);
      const rows = fields.map((row) => row.map(value));
      const numeric = columns.map((_, j) => {
        const there = rows.map((row) => row[j]).filter((v) => v !== null);
        return there.length > 0 && there.every((v) => typeof v === "number");
      });
      known.set(name, { name, text, columns, rows, numeric });
    }
    return known.get(name);
  }

  function bytes(text) {
    return Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  }

  /* Four significant digits, without trailing zeros. */
  function shown(v) {
    if (v === null || typeof v !== "number") return v === null ? "" : String(v);
    if (!Number.isFinite(v)) return v > 0 ? "∞" : "−∞";
    if (Number.isInteger(v) && Math.abs(v) < 1e9) return String(v).replace("-", "−");
    const size = Math.abs(v);
    if (size < 1e-3 || size >= 1e6) return v.toExponential(2).replace("-", "−").replace("e-", "e−");
    return String(Number(v.toPrecision(4))).replace("-", "−");
  }

  function save(name, kind, content) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([content], { type: kind }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  /* What was deflated (zlib), as a blob of a kind. */
  async function inflated(text, kind) {
    const stream = new Blob([bytes(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Blob([await new Response(stream).arrayBuffer()], { type: kind });
  }

  const floats = (text) => new Float32Array(bytes(text));
  const integers = (text) => new Uint16Array(bytes(text));
  const signed = (text) => new Int16Array(bytes(text));
  return { read, parseCsv, table, floats, integers, signed, inflated, shown, save };
})();

/* An element with attributes and children; text is never read as markup. */
quatspline.element = (name, attributes = {}, ...children) => {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, "");
    else if (value !== false && value !== null) made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
};
