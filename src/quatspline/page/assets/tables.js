/* Tables: sorted by any column, filtered by text and by value, shown page by page, downloaded as CSV. */
"use strict";
quatspline.Table = class {
  static PAGE = 15;
  static CHOICES = 40; /* a text column with more values than this is searched, not listed */
  static PRINTED = 9; /* more columns than these are printed row by row */
  static LISTS = 4;
  static LONG = 40; /* text longer than this wraps */

  constructor(place) {
    const { element: make, data } = quatspline;
    this.place = place;
    this.name = place.dataset.table;
    this.source = data.table(this.name);
    this.glossary = data.read("columns")[this.name] || {};
    this.ranking = data.read("rankings")[this.name] || null;
    this.order = null;
    this.criterion = "";
    this.page = 0;
    this.size = this.constructor.PAGE;
    this.cited = null;
    this.search = make("input", { type: "search", oninput: () => this.filtered() });
    this.lists = this._lists();
    this.count = make("span", { class: "order", role: "status" });
    this.line = make("p", { class: "order" });
    this.head = make("tr");
    this.body = make("tbody");
    this._build();
    if (this.ranking) this._rank();
    this.draw();
  }

  /* -- what stands around the rows -- */

  _lists() {
    const { element: make } = quatspline;
    const lists = [];
    this.source.columns.forEach((column, j) => {
      if (this.source.numeric[j] || lists.length >= this.constructor.LISTS) return;
      const values = [...new Set(this.source.rows.map((row) => row[j]).filter((v) => v !== null).map(String))];
      const listed = values.length >= 2 && values.length <= this.constructor.CHOICES && values.every((v) => v.length <= this.constructor.LONG);
      if (!listed) return;
      const options = values.sort().map((v) => make("option", { value: v }, v));
      const select = make("select", { onchange: () => this.filtered() }, make("option", { value: "" }, "all"), ...options);
      lists.push({ column, j, select });
    });
    return lists;
  }

  _build() {
    const { element: make, data } = quatspline;
    const save = () => data.save(`${this.name}.csv`, "text/csv;charset=utf-8", this.source.text);
    const lists = this.lists.map(({ column, select }) => make("label", {}, column.replaceAll("_", " "), select));
    const controls = make("div", { class: "bar" }, make("label", {}, "Filter", this.search), ...lists,
      make("button", { type: "button", class: "csv", onclick: save }, "Download CSV"));
    this.source.columns.forEach((column, j) => this.head.append(this._heading(column, j)));
    const grid = make("table", {}, make("thead", {}, this.head), this.body);
    const region = make("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": this.place.dataset.title }, grid);
    this.back = make("button", { type: "button", onclick: () => this.turn(-1) }, "Previous");
    this.forth = make("button", { type: "button", onclick: () => this.turn(1) }, "Next");
    this.all = make("button", { type: "button", onclick: () => this.resize() }, "Show all rows");
    const pager = make("div", { class: "bar pager" }, this.back, this.forth, this.all, this.count);
    this.place.classList.toggle("wide", this.source.columns.length > this.constructor.PRINTED);
    this.place.replaceChildren(controls, this.line, region, pager);
  }

  _heading(column, j) {
    const { element: make } = quatspline;
    const known = this.glossary[column];
    const unit = known && known.unit ? `, in ${known.unit}` : "";
    const button = make("button", { type: "button", title: known ? known.meaning + unit : column, onclick: () => this.sort(j) }, column.replaceAll("_", " "));
    return make("th", { scope: "col", "data-column": column, "aria-sort": "none" }, button);
  }

  /* -- order -- */

  _rank() {
    const { column: by, descending: down, criterion } = this.ranking;
    const j = this.source.columns.indexOf(by);
    if (by !== null && j < 0) return;
    if (by !== null) this.order = { j, down }; /* else the file is in this order */
    this.criterion = `Ranked${by === null ? "" : ` by ${by}`}: ${criterion}.`;
    for (const { column, select } of this.lists) {
      const wanted = this.ranking.among[column];
      if ([...select.options].some((option) => option.value === wanted)) select.value = wanted;
    }
  }

  /* Ascending at first; where more is better, descending. */
  sort(j) {
    const column = this.source.columns[j];
    const { meaning, better } = this.glossary[column] || { meaning: column, better: "" };
    const again = this.order && this.order.j === j;
    const down = again ? !this.order.down : better === "more";
    this.order = { j, down };
    const wish = better ? `; ${better} is better` : "";
    this.criterion = `Sorted by ${column.replaceAll("_", " ")} (${meaning}), ${down ? "descending" : "ascending"}${wish}.`;
    this.page = 0;
    this.draw();
  }

  _compare(p, q) {
    const { j, down } = this.order;
    const a = p[j], b = q[j];
    if (a === null || b === null) return (a === null) - (b === null); /* what is missing comes last */
    const both = typeof a === "number" && typeof b === "number";
    const sign = both ? (a < b ? -1 : a > b ? 1 : 0) : String(a).localeCompare(String(b), "en", { numeric: true });
    return down ? -sign : sign;
  }

  /* -- rows -- */

  rows() {
    const terms = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const wanted = this.lists.filter(({ select }) => select.value !== "");
    const kept = this.source.rows.filter((row) => {
      if (!wanted.every(({ j, select }) => String(row[j]) === select.value)) return false;
      const text = row.map((v) => String(v ?? "")).join(" ").toLowerCase();
      return terms.every((term) => text.includes(term));
    });
    return this.order ? [...kept].sort((p, q) => this._compare(p, q)) : kept;
  }

  filtered() { this.page = 0; this.draw(); }
  turn(by) { this.page += by; this.draw(); }
  resize() {
    this.size = this.size === Infinity ? this.constructor.PAGE : Infinity;
    this.page = 0;
    this.draw();
  }

  draw() {
    const rows = this.rows();
    const pages = this.size === Infinity ? 1 : Math.max(1, Math.ceil(rows.length / this.size));
    this.page = Math.min(Math.max(this.page, 0), pages - 1);
    const from = this.size === Infinity ? 0 : this.page * this.size;
    const visible = rows.slice(from, from + this.size);
    this.body.replaceChildren(...visible.map((row) => this._row(row)));
    [...this.head.children].forEach((th, j) => {
      const here = this.order && this.order.j === j;
      th.setAttribute("aria-sort", here ? (this.order.down ? "descending" : "ascending") : "none");
    });
    this.line.textContent = this.criterion || "In the order of the file.";
    const last = from + visible.length;
    const of = rows.length === this.source.rows.length ? "" : ` (of ${this.source.rows.length} in all)`;
    this.count.textContent = visible.length ? `Rows ${from + 1} to ${last} of ${rows.length}${of}` : `No row of ${this.source.rows.length} matches`;
    this.back.disabled = this.page === 0;
    this.forth.disabled = this.page >= pages - 1;
    this.all.hidden = this.source.rows.length <= this.constructor.PAGE;
    this.all.textContent = this.size === Infinity ? "Show page by page" : "Show all rows";
  }

  _row(row) {
    const { element: make, data } = quatspline;
    const cells = row.map((v, j) => {
      const number = this.source.numeric[j];
      const long = !number && String(v ?? "").length > this.constructor.LONG;
      const kind = number ? "number" : long ? "long" : null;
      return make(j ? "td" : "th", { scope: j ? null : "row", "data-label": this.source.columns[j].replaceAll("_", " "), class: kind, title: number && v !== null ? String(v) : null }, data.shown(v));
    });
    const made = make("tr", {}, ...cells);
    if (this.cited && this.cited.row === row) {
      made.classList.add("cited");
      cells[this.cited.j]?.classList.add("cited");
    }
    return made;
  }

  /* Show the row that a finding quotes, marked. */
  cite(key, column) {
    const { columns, rows } = this.source;
    const wanted = Object.entries(key).map(([name, v]) => [columns.indexOf(name), v]);
    const row = rows.find((r) => wanted.every(([j, v]) => (typeof v === "boolean" ? String(r[j]) === (v ? "True" : "False") : r[j] === v)));
    if (!row) return;
    this.search.value = "";
    this.lists.forEach(({ select }) => { select.value = ""; });
    this.cited = { row, j: columns.indexOf(column) };
    if (this.size !== Infinity) this.page = Math.floor(this.rows().indexOf(row) / this.size);
    this.place.closest("details").open = true;
    this.draw();
    const mark = this.body.querySelector("tr.cited");
    mark.scrollIntoView({ block: "center" });
    mark.querySelector("td.cited")?.scrollIntoView({ block: "center", inline: "center" });
  }
};
