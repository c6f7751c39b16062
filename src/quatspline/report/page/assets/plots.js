/* Interactive plots by Plotly, drawn from the tables: columns chosen, axes switched, a series picked out or hidden. */
"use strict";
quatspline.plots = (() => {
  const { element: make, data, theme } = quatspline;
  const looks = data.read("looks") || {};
  const drawn = [];

  const OPTIONS = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d", "sendDataToCloud"] };
  const FAINT = 0.12;

  function look(name) {
    return looks[name] || { light: "#444444", dark: "#bbbbbb", symbol: "circle", dash: "solid" };
  }

  function seriesColor(name) { return look(name)[theme.look() === "dark" ? "dark" : "light"]; }

  function axis(title, log) {
    const line = theme.color("line");
    return {
      title: { text: title, standoff: 8 }, type: log ? "log" : "linear", gridcolor: line, zeroline: false,
      linecolor: theme.color("muted"), ticks: "outside", tickcolor: line, exponentformat: "power", automargin: true,
    };
  }

  function layout(more) {
    const narrow = window.innerWidth < 640;
    const legend = narrow ? { orientation: "h", y: -0.28, yanchor: "top" } : { x: 1.02, y: 1 };
    return {
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", hovermode: "closest",
      font: { family: "system-ui, sans-serif", size: narrow ? 12 : 14, color: theme.color("text") },
      margin: { l: 60, r: 20, t: 16, b: 50 },
      hoverlabel: { bgcolor: theme.color("raised"), bordercolor: theme.color("line"), font: { color: theme.color("text") } },
      legend: { ...legend, font: { size: 12 }, itemclick: "toggle", itemdoubleclick: "toggleothers" },
      ...more,
    };
  }

  function show(place, traces, more) {
    return Plotly.react(place, traces, layout(more), OPTIONS);
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
    drawn.push(place);
  }

  return { axis, show, chooser, checkbox, lazily, seriesColor, look, FAINT, all: drawn };
})();

quatspline.TablePlot = class {
  constructor(place) {
    const { data, plots, element: make } = quatspline;
    this.spec = JSON.parse(place.dataset.plot);
    this.source = data.table(this.spec.table);
    this.chart = make("div", { class: "chart" });
    const redraw = () => this.draw();
    const pairs = (list) => list.map(({ column, label }) => [column, label]);
    this.x = plots.chooser("Across", pairs(this.spec.x), redraw);
    this.y = plots.chooser("Up", pairs(this.spec.y), redraw);
    this.z = plots.chooser("Colour", pairs(this.spec.z), redraw);
    this.facets = this.spec.facets.map(({ column, label }) => ({ column, ...plots.chooser(label, this._values(column), redraw) }));
    this.facets.forEach(({ column, select }) => { if (column in this.spec.start) select.value = this.spec.start[column]; });
    this.picked = plots.chooser("Pick out", [["", "none"], ...this._values(this.spec.series)], redraw);
    this.logs = ["x", "y"].map((name, i) => plots.checkbox(`log ${name}`, this.spec.log[i], redraw));
    place.replaceChildren(make("div", { class: "bar" }, ...this._controls()), this.chart);
    plots.lazily(place, redraw);
  }

  _controls() {
    const map = this.spec.kind === "map";
    const several = [[this.x, this.spec.x], [this.y, this.spec.y], [this.z, this.spec.z]];
    const chosen = several.filter(([, options]) => options.length > 1).map(([chooser]) => chooser.label);
    const rest = map ? [] : [this.picked.label, ...this.logs.map((log) => log.label)];
    return [...chosen, ...this.facets.map((facet) => facet.label), ...rest];
  }

  _values(column) {
    const j = this.source.columns.indexOf(column);
    return [...new Set(this.source.rows.map((row) => row[j]))].filter((v) => v !== null).map((v) => [String(v), String(v)]);
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
    const axes = { xaxis: plots.axis(text(this.x), !map && xlog), yaxis: plots.axis("", !map && ylog) };
    /* What goes up stands above the plot: long names would not fit along the axis. */
    const above = map ? `${text(this.z)}; up: ${text(this.y)}` : text(this.y);
    const title = { text: above, x: 0, xref: "container", xanchor: "left", y: 1, yref: "container", yanchor: "top", pad: { t: 6 }, font: { size: 14 } };
    plots.show(this.chart, traces, { ...axes, title, showlegend: !map, margin: { l: 60, r: 20, t: 40, b: 50 } });
  }

  _lines(i, j) {
    const { plots } = quatspline;
    const s = this.source.columns.indexOf(this.spec.series);
    const groups = new Map();
    for (const row of this._rows()) {
      if (row[i] === null || row[j] === null) continue;
      if (!groups.has(row[s])) groups.set(row[s], []);
      groups.get(row[s]).push([row[i], row[j]]);
    }
    const picked = this.picked.select.value;
    return [...groups].map(([name, points]) => {
      points.sort((p, q) => p[0] - q[0]);
      const look = plots.look(name), color = plots.seriesColor(name), chosen = picked === String(name);
      return {
        name: String(name), x: points.map((p) => p[0]), y: points.map((p) => p[1]), type: "scatter",
        mode: this.spec.kind === "points" ? "markers" : "lines+markers", opacity: picked && !chosen ? plots.FAINT : 1,
        line: { color, dash: look.dash, width: chosen ? 3.5 : 1.6 }, marker: { color, symbol: look.symbol, size: chosen ? 10 : 7 },
      };
    });
  }

  _map(i, j, k) {
    const rows = this._rows().filter((row) => row[i] !== null && row[j] !== null);
    const color = { colorscale: "Cividis", colorbar: { thickness: 12, outlinewidth: 0 } };
    return [{ type: "heatmap", x: rows.map((r) => r[i]), y: rows.map((r) => r[j]), z: rows.map((r) => r[k]), hoverongaps: false, ...color }];
  }
};
