/* Six questions narrow a table of schemes; the rows stand in the page, the script hides and orders them. */
"use strict";
quatspline.Chooser = class {
  static RELATIONS = {
    "=": (a, b) => a === b,
    "!=": (a, b) => a !== b,
    ">=": (a, b) => a >= b,
    "<=": (a, b) => a <= b,
  };

  constructor(place, data) {
    this.place = place;
    this.questions = data.questions;
    this.facts = new Map(data.rows.map((row) => [row.scheme, row.facts]));
    this.body = place.querySelector("tbody");
    this.rows = [...this.body.rows];
    this.told = place.querySelector("output");
    this.link = place.querySelector("a.share");
    this.order = null;
    this.selects = new Map([...place.querySelectorAll("select")].map((select) => [select.name, select]));
    this.selects.forEach((select) => select.addEventListener("change", () => this.changed()));
    this.heads = [...place.querySelectorAll("thead th")];
    this.heads.forEach((th, j) => th.querySelector("button").addEventListener("click", () => { this.sort(j); this.changed(); }));
    place.querySelector("button.clear").addEventListener("click", () => { this.restore(new URLSearchParams()); this.changed(); });
    quatspline.address.follow("choosing", (values) => this.restore(values));
    this.draw();
  }

  /* -- the view -- */

  answers() {
    return Object.fromEntries([...this.selects].map(([name, select]) => [name, select.value]).filter(([, value]) => value));
  }

  view() {
    const sort = this.order ? { sort: `${this.heads[this.order.j].dataset.column}${this.order.down ? "-" : ""}` } : {};
    return { ...this.answers(), ...sort };
  }

  restore(values) {
    this.selects.forEach((select, name) => {
      const wanted = values.get(name) || "";
      select.value = [...select.options].some((option) => option.value === wanted) && !select.disabled ? wanted : "";
    });
    const [, column, down] = /^(\w+)(-?)$/.exec(values.get("sort") || "") || [];
    const j = this.heads.findIndex((th) => th.dataset.column === column);
    this.order = j < 0 ? null : { j, down: down === "-" };
    this.draw();
  }

  changed() {
    quatspline.address.write("choosing", this.view());
    this.draw();
  }

  /* -- rows -- */

  /* Whether a scheme meets an answer; what is not known is not met. */
  meets(scheme, name, value) {
    const facts = this.facts.get(scheme);
    const answer = this.questions.find((question) => question.key === name).answers.find(({ key }) => key === value);
    return answer.conditions.every(([column, relation, bound]) => {
      const fact = facts[column];
      return fact !== null && this.constructor.RELATIONS[relation](fact, bound);
    });
  }

  qualify(answers) {
    const asked = Object.entries(answers);
    return this.rows.filter((row) => asked.every(([name, value]) => this.meets(row.dataset.scheme, name, value)));
  }

  sort(j) {
    this.order = this.order && this.order.j === j ? (this.order.down ? null : { j, down: true }) : { j, down: false };
  }

  /* Cells hold what they are sorted by, so that the better comes first; what is missing comes last. */
  sorted() {
    if (!this.order) return this.rows;
    const { j, down } = this.order;
    const key = (row) => row.cells[j].dataset.order;
    const text = (row) => row.cells[j].textContent.trim();
    return [...this.rows].sort((p, q) => {
      const [a, b] = [key(p), key(q)];
      if (a === undefined) return (down ? -1 : 1) * text(p).localeCompare(text(q), "en");
      if (a === "" || b === "") return (a === "") - (b === "");
      return (down ? -1 : 1) * (Number(a) - Number(b));
    });
  }

  draw() {
    const answers = this.answers(), kept = new Set(this.qualify(answers));
    this.rows.forEach((row) => { row.hidden = !kept.has(row); });
    this.body.replaceChildren(...this.sorted());
    this.heads.forEach((th, j) => {
      const here = this.order && this.order.j === j;
      th.setAttribute("aria-sort", here ? (this.order.down ? "descending" : "ascending") : "none");
    });
    this.link.href = quatspline.address.of("choosing", this.view());
    this.told.textContent = this.sentence(answers, kept);
  }

  sentence(answers, kept) {
    const all = `${kept.size} of ${this.rows.length} schemes ${kept.size === 1 ? "qualifies" : "qualify"}.`;
    if (!Object.keys(answers).length) return `${this.rows.length} schemes. Answer a question to narrow them.`;
    if (!kept.size) return `No scheme of ${this.rows.length} qualifies. ${this.relief(answers)}`;
    const torque = (row) => row.querySelector("[data-cell=torque]").firstChild.textContent.trim();
    const measured = this.rows.filter((row) => kept.has(row) && /\d/.test(torque(row))); /* rows arrive by torque */
    if (!measured.length) return all;
    const [best] = measured, sound = measured.find((row) => row.querySelector("[data-cell=failure]").dataset.order === "0");
    const least = `${all} The least torque among them has ${best.dataset.scheme}: ${torque(best)} times the least possible.`;
    return sound && sound !== best ? `${least} Of those of which no failure was found, ${sound.dataset.scheme}: ${torque(sound)}.` : least;
  }

  /* Which single answer, left out, would let schemes through. */
  relief(answers) {
    const counts = Object.keys(answers).map((name) => {
      const { [name]: _, ...rest } = answers;
      return [this.questions.find((question) => question.key === name).text, this.qualify(rest).length];
    });
    const [text, count] = counts.reduce((p, q) => (q[1] > p[1] ? q : p));
    return count ? `Without the answer to “${text}”, ${count} would.` : "";
  }
};
