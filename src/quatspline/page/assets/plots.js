/* Interactive plots by Plotly, drawn from the tables: columns chosen, axes switched, a series picked out or hidden. */
"use strict";
quatspline.plots = (() => {
  const { element: make, data, theme } = quatspline;
  const looks = data.read("looks") || {};
  const PAPER = { width: 680, height: 410 }; /* pixels: across A4 between margins, and the height that the style gives a plot there */
  const printed = new Set();
  let printing = false;

  const OPTIONS = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d", "sendDataToCloud"] };
  const FAINT = 0.12;
  const LEAST_EXCESS = 1e-4; /* a smaller excess over 1 is drawn there */

  function look(name) {
    return looks[name] || { light: "#444444", dark: "#bbbbbb", symbol: "circle", dash: "solid" };
  }

  function seriesColor(name) { return look(name)[theme.look() === "dark" ? "dark" : "light"]; }

  function axis(title, log) {
    const line = theme.color("line");
    return {
      title: { text: title, standoff: 8 }, type: log ? "log" : "linear", gridcolor: line, zeroline: false,
      linecolor: theme.color("muted"), ticks: "outside", tickcolor: line, tickfont: { size: 12 }, exponentformat: "power", automargin: true,
      ...(log ? { dtick: 1, minor: { ticks: "outside", ticklen: 3, tickcolor: line } } : {}),
    };
  }

  function layout(more) {
    const narrow = printing || window.innerWidth < 640;
    const legend = narrow ? { orientation: "h", y: -0.28, yanchor: "top" } : { x: 1.02, y: 1 };
    return {
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", hovermode: "closest",
      font: { family: "system-ui, sans-serif", size: narrow ? 12 : 14, color: theme.color("text") },
      margin: { l: 60, r: 20, t: 16, b: 50 }, ...(printing ? PAPER : { width: undefined, height: undefined, autosize: true }),
      hoverlabel: { bgcolor: theme.color("raised"), bordercolor: theme.color("line"), font: { color: theme.color("text") } },
      legend: { ...legend, font: { size: 12 }, itemclick: "toggle", itemdoubleclick: "toggleothers" },
      ...more,
    };
  }

  /* What is said in place of a plot without data. */
  function nothing(text) {
    const font = { size: 15, color: theme.color("muted") };
    return [{ text, showarrow: false, xref: "paper", yref: "paper", x: 0.5, y: 0.5, font }];
  }

  function show(place, traces, more) {
    return Plotly.react(place, traces, layout(more), { ...OPTIONS, displayModeBar: window.innerWidth < 640 ? false : "hover" });
  }

  function chooser(label, options, change) {
    const list = options.map(([value, text]) => make("option", { value }, text));
    const select = make("select", { onchange: change }, ...list);
    return { select, label: make("label", {}, label, select) };
  }

  function checkbox(label, checked, change) {
    const box = make("input", { type: "checkbox", onchange: change, checked });
    return { box, label: make("label", { class: "check" }, box, label) };
  }

  /* One that draws itself when it comes near, and again when the look changes. */
  function lazily(place, draw) {
    let near = false;
    const watch = new IntersectionObserver((entries) => {
      if (near || !entries.some((entry) => entry.isIntersecting)) return;
      near = true;
      watch.disconnect();
      draw();
    }, { rootMargin: "400px" });
    watch.observe(place);
    theme.follow(() => near && draw());
    printed.add(() => { near = near || printing; if (near) draw(); });
  }

  /* Paper shows every plot, as wide as it is. */
  const drawAll = (on) => () => { printing = on; printed.forEach((draw) => draw()); };
  window.addEventListener("beforeprint", drawAll(true));
  window.addEventListener("afterprint", drawAll(false));

  return { axis, show, nothing, chooser, checkbox, lazily, seriesColor, look, onPaper: () => printing, FAINT, LEAST_EXCESS };
})();

quatspline.TablePlot = class {
  static DASHES = ["solid", "dash", "dot", "dashdot"];
  static MOST = 8; /* lines in colour at first; the others are grey until they are picked in the legend */

  constructor(place) {
    const { data, plots, element: make } = quatspline;
    this.spec = JSON.parse(place.dataset.plot);
    this.source = data.table(this.spec.table);
    this.chart = make("div", { class: "chart" });
    this.heading = make("h4");
    const redraw = () => this.draw();
    const pairs = (list) => list.map(({ column, label }) => [column, label]);
    this.x = plots.chooser("Across", pairs(this.spec.x), redraw);
    this.y = plots.chooser("Up", pairs(this.spec.y), redraw);
    this.z = plots.chooser("Colour", pairs(this.spec.z), redraw);
    this.facets = this.spec.facets.map(({ column, label }) => ({ column, ...plots.chooser(label, [], () => { this._narrow(); redraw(); }) }));
    this._narrow();
    if (this.spec.kind === "map") this._seek();
    this.lit = this._lit();
    this.picked = plots.chooser("Pick out", [["", "none"], ...this._values(this.spec.series)], redraw);
    this.logs = ["x", "y"].map((name, i) => plots.checkbox(`log ${name}`, this.spec.log[i], redraw));
    place.replaceChildren(make("div", { class: "bar" }, ...this._controls()), this.heading, this.chart);
    plots.lazily(place, redraw);
  }

  _controls() {
    const map = this.spec.kind === "map";
    const several = [[this.x, this.spec.x], [this.y, this.spec.y], [this.z, this.spec.z]];
    const chosen = several.filter(([, options]) => options.length > 1).map(([chooser]) => chooser.label);
    const rest = map ? [] : [this.picked.label, ...this.logs.map((log) => log.label)];
    return [...chosen, ...this.facets.map((facet) => facet.label), ...rest];
  }

  _values(column, rows = this.source.rows) {
    const j = this.source.columns.indexOf(column);
    return [...new Set(rows.map((row) => row[j]))].map((v) => [String(v), v === null ? "–" : String(v)]);
  }

  /* Each facet offers what there is for the choices before it, and keeps its own where it can. */
  _narrow() {
    let rows = this.source.rows;
    for (const { column, select } of this.facets) {
      const values = this._values(column, rows), j = this.source.columns.indexOf(column);
      const wish = select.value || this.spec.start[column];
      select.replaceChildren(...values.map(([value, text]) => quatspline.element("option", { value }, text)));
      if (values.some(([value]) => value === wish)) select.value = wish;
      rows = rows.filter((row) => String(row[j]) === select.value);
    }
  }

  /* What is in colour at first: the schemes that lead, and from the table what there is room for. */
  _lit() {
    const there = this._values(this.spec.series).map(([value]) => value);
    const leading = this.spec.lit.filter((name) => there.includes(name));
    const rest = there.filter((name) => !leading.includes(name));
    return new Set([...leading, ...rest].slice(0, quatspline.TablePlot.MOST));
  }

  /* A map opens where it has data: on the first choices for which a row holds all three numbers. */
  _seek() {
    const shown = [this.x, this.y, this.z].map(({ select }) => this.source.columns.indexOf(select.value));
    const full = (row) => shown.every((j) => row[j] !== null);
    if (this._rows().some(full)) return;
    const first = this.source.rows.find(full);
    if (!first) return;
    for (const { column, select } of this.facets) {
      select.value = String(first[this.source.columns.indexOf(column)]);
      this._narrow();
    }
  }

  _rows() {
    const kept = this.facets.map(({ column, select }) => [this.source.columns.indexOf(column), select.value]);
    return this.source.rows.filter((row) => kept.every(([j, v]) => String(row[j]) === v));
  }

  draw() {
    const at = (chooser) => this.source.columns.indexOf(chooser.select.value);
    const text = (chooser) => chooser.select.selectedOptions[0]?.textContent || "";
    const { plots } = quatspline;
    const [xlog, ylog] = this.logs.map((log) => log.box.checked);
    const traces = this.spec.kind === "map" ? this._map(at(this.x), at(this.y), at(this.z)) : this._lines(at(this.x), at(this.y));
    const map = this.spec.kind === "map";
    const excess = (chooser, log) => !map && log && this.spec.ratios.includes(chooser.select.value);
    const axes = { xaxis: plots.axis(text(this.x), !map && xlog), yaxis: plots.axis("", !map && ylog) };
    if (map) Object.values(axes).forEach((axis) => { axis.type = "category"; axis.showgrid = false; });
    /* What goes up stands above the plot: long names would not fit along the axis. */
    const above = map ? `${text(this.z)}; up: ${text(this.y)}` : `${text(this.y)}${excess(this.y, ylog) ? ": excess over 1" : ""}`;
    const annotations = traces.some((trace) => trace.x.length) ? [] : plots.nothing("no data for this choice");
    this.heading.textContent = above;
    plots.show(this.chart, traces, { ...axes, annotations, showlegend: !map, margin: { l: 60, r: 20, t: 30, b: 50 } });
    this._legend();
  }

  /* A click in the legend takes a series into colour or back into grey. */
  _legend() {
    if (this.listening) return;
    this.listening = true;
    this.chart.on("plotly_legendclick", ({ data, curveNumber }) => {
      const name = data[curveNumber].meta;
      if (!this.lit.delete(name)) this.lit.add(name);
      this.draw();
      return false;
    });
    this.chart.on("plotly_legenddoubleclick", ({ data, curveNumber }) => {
      this.lit = new Set([data[curveNumber].meta]);
      this.draw();
      return false;
    });
  }

  _lines(i, j) {
    const { plots, theme } = quatspline;
    /* Of ratios to a least value, a logarithmic axis shows what exceeds 1. */
    const excess = [i, j].map((c, k) => this.logs[k].box.checked && this.spec.ratios.includes(this.source.columns[c]));
    const shown = (v, k) => (excess[k] ? Math.max(v - 1, plots.LEAST_EXCESS) : v);
    const [s, ...split] = [this.spec.series, ...this.spec.split].map((name) => this.source.columns.indexOf(name));
    const groups = new Map();
    for (const row of this._rows()) {
      if (row[i] === null || row[j] === null) continue;
      const part = split.map((c) => row[c]).filter((v) => v !== null).join(", "), label = [row[s], part].filter((v) => v !== "" && v !== null).join(", ");
      if (!groups.has(label)) groups.set(label, { name: row[s], part, points: [] });
      groups.get(label).points.push([shown(row[i], 0), shown(row[j], 1)]);
    }
    const picked = this.picked.select.value, dashes = quatspline.TablePlot.DASHES;
    const parts = [...new Set([...groups.values()].map(({ part }) => part))]; /* of series: told apart by dash, the same in all */
    return [...groups].map(([label, { name, part, points }]) => {
      points.sort((p, q) => p[0] - q[0]);
      const key = String(name), gray = !this.lit.has(key) && picked !== key;
      const look = { ...plots.look(name) }, color = gray ? theme.color("ghost") : plots.seriesColor(name), chosen = picked === key;
      if (parts.length > 1) look.dash = dashes[parts.indexOf(part) % dashes.length];
      return {
        name: label, meta: key, x: points.map((p) => p[0]), y: points.map((p) => p[1]), type: "scatter", zorder: gray ? 0 : 1, legendrank: gray ? 1001 : 1, showlegend: !(gray && plots.onPaper()),
        mode: this.spec.kind === "points" ? "markers" : "lines+markers", opacity: picked && !chosen ? plots.FAINT : 1,
        line: { color, dash: look.dash, width: chosen ? 3.5 : gray ? 1 : 1.8 }, marker: { color, symbol: look.symbol, size: chosen ? 10 : gray ? 5 : 7 },
      };
    });
  }

  /* Numbers that span more than a thousandfold are coloured by their logarithm, and written as they are. */
  _map(i, j, k) {
    const { data } = quatspline, wide = 1e3;
    const rows = this._rows().filter((row) => [i, j, k].every((c) => row[c] !== null));
    const values = rows.map((row) => row[k]), least = Math.min(...values), most = Math.max(...values);
    const log = least > 0 && most / least > wide;
    const shared = { type: "heatmap", x: rows.map((r) => r[i]), y: rows.map((r) => r[j]), text: values.map(data.shown) };
    const bar = { thickness: 12, outlinewidth: 0, title: { text: log ? "log10" : "" } };
    return [{ ...shared, z: log ? values.map(Math.log10) : values, texttemplate: "%{text}", hovertemplate: "%{text}<extra></extra>", colorscale: "Cividis", colorbar: bar }];
  }
};
