/* Keyframes as a reader pastes them: lines of a time and a quaternion, in the order of a heading where there is one. */
"use strict";
quatspline.pasted = (() => {
  const TIMES = ["t", "time", "times", "timestamp", "timestamps", "stamp", "stamps"];
  const COLUMNS = { t: TIMES, w: ["w", "qw"], x: ["x", "qx"], y: ["y", "qy"], z: ["z", "qz"] };
  const LATEST = 1e15; /* beyond it, neighbouring times are the same number */
  const LEAST = 1e-9; /* shorter quaternions have no direction to go by */

  /* Fields between semicolons or tabs, where a comma is the decimal mark; else between commas, or blanks. */
  function split(line) {
    const mark = [";", "\t", ","].find((each) => line.includes(each)) || /\s+/;
    const fields = line.split(mark).map((field) => field.trim().replace(/^"(.*)"$/, "$1"));
    return mark === "," ? fields : fields.map((field) => field.replace(",", "."));
  }

  const number = (field) => (field ? Number(field) : NaN);

  /* Rows [t, w, x, y, z], or a sentence that says what is wrong. */
  function read(text) {
    const lines = text.split(/\r\n|\r|\n/).map((line) => line.trim()).filter((line) => line && !line.startsWith("#")).map(split);
    const headed = lines.length > 0 && lines[0].every((field) => Number.isNaN(number(field)));
    const heading = headed ? lines.shift().map((name) => name.toLowerCase()) : [];
    const order = Object.values(COLUMNS).map((names) => heading.findIndex((name) => names.includes(name)));
    const lacking = Object.keys(COLUMNS).filter((_, k) => order[k] < 0);
    if (headed && lacking.length) return { wrong: `The first line does not name ${lacking.join(", ")}: the columns t,w,x,y,z are needed.` };
    const rows = lines.map((fields) => (headed ? order.map((j) => number(fields[j])) : fields.map(number)));
    return { rows, wrong: fault(rows) };
  }

  /* What keeps rows from being keyframes; nothing where they are. */
  function fault(rows) {
    if (rows.length < 2) return "At least two lines are needed, each with t,w,x,y,z.";
    for (const [k, row] of rows.entries()) {
      if (row.length !== 5 || !row.every(Number.isFinite)) return `Keyframe ${k}: expected five numbers, t,w,x,y,z.`;
      if (Math.abs(row[0]) > LATEST) return `Keyframe ${k}: its time ${row[0]} is beyond ${LATEST}.`;
      if (Math.hypot(...row.slice(1)) < LEAST) return `Keyframe ${k}: its quaternion has no length.`;
      if (k && !(row[0] > rows[k - 1][0])) return `Keyframe ${k}: its time ${row[0]} does not come after ${rows[k - 1][0]}.`;
    }
    return "";
  }

  return { read, fault };
})();
