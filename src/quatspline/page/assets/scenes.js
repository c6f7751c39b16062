/* Motions as the players read them: sampled curves of several schemes on common times. */
"use strict";

/* What is known at times `t` (from 0 to `span`), keyframes being at `knots`. */
quatspline.Sampled = class {
  /* The last sample not after t, and the share of the way to the next. */
  locate(t) {
    let low = 0, high = this.t.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.t[middle] <= Math.fround(t)) low = middle; else high = middle - 1;
    }
    const next = Math.min(low + 1, this.t.length - 1), gap = this.t[next] - this.t[low];
    return { i: low, next, u: gap > 0 ? Math.min(Math.max((t - this.t[low]) / gap, 0), 1) : 0 };
  }

  /* Samples (rows of `list`, or numbers) between the two neighbours. */
  between(list, t) {
    const { i, next, u } = this.locate(t);
    const mix = (a, b) => (u === 0 ? a : a + u * (b - a));
    return Array.isArray(list[i]) ? list[i].map((a, k) => mix(a, list[next][k])) : mix(list[i], list[next]);
  }

  /* The number of a keyframe at this time, or -1. */
  keyframeAt(t) { return this.knots.findIndex((knot) => Math.abs(knot - t) <= 1e-9 * this.span); }
};

quatspline.Motion = class extends quatspline.Sampled {
  constructor(packed) {
    super();
    const { floats, integers } = quatspline.data;
    Object.assign(this, { name: packed.name, title: packed.title, start: packed.start, closed: packed.closed });
    Object.assign(this, { knots: packed.knots, keyframes: packed.keyframes, view: packed.view, scale: packed.scale });
    Object.assign(this, { pair: packed.pair, refused: packed.refused });
    this.span = this.knots[this.knots.length - 1];
    this.t = floats(packed.t);
    this.places = this._rows(floats(packed.positions), 3);
    const { vertices, normals, tint, lift, cells } = packed.body;
    this.body = {
      vertices: this._rows(floats(vertices), 3), normals: this._rows(floats(normals), 3),
      tint: floats(tint), lift: floats(lift), cells: this._rows(integers(cells), 4),
    };
    this.packed = packed.curves;
    this.known = new Map();
  }

  get schemes() { return Object.keys(this.packed); }

  _rows(flat, width) {
    return Array.from({ length: flat.length / width }, (_, i) => Array.from(flat.subarray(i * width, (i + 1) * width)));
  }

  /* A scheme's samples, decoded when first asked for. */
  curve(name) {
    if (!this.known.has(name)) {
      const { floats } = quatspline.data, { norm } = quatspline.geometry;
      const packed = this.packed[name];
      const [omega, alpha, log] = ["omega", "alpha", "log"].map((key) => this._rows(floats(packed[key]), 3));
      const norms = { omega: omega.map(norm), alpha: alpha.map(norm) };
      this.known.set(name, { name, title: packed.title, q: this._rows(floats(packed.q), 4), omega, alpha, log, norms });
    }
    return this.known.get(name);
  }

  orientation(name, t) {
    const { i, next, u } = this.locate(t), { q } = this.curve(name);
    return u === 0 ? q[i] : quatspline.geometry.slerp(q[i], q[next], u);
  }
};

/* Log-curves in space and strips of the rates, of all schemes, by Plotly. */
quatspline.MotionPlot = class {
  static MANY = 200; /* keyframes: with more, curves in space are drawn when they are asked for, and keyframes not marked one by one */
  static FINE = 1e-3; /* of a curve's extent: nearer points would fall into one pixel of the picture */

  constructor(place, motions) {
    const { plots, element: make } = quatspline;
    this.kind = place.dataset.motion;
    this.motions = motions;
    this.asked = new Set();
    this.picked = new Map();
    this.chart = make("div", { class: "chart" });
    this.ask = make("p", { class: "ask", hidden: true });
    const redraw = () => this.draw();
    this.motion = plots.chooser("Motion", motions.map((m, i) => [String(i), m.title]), redraw);
    place.replaceChildren(make("div", { class: "bar" }, this.motion.label), this.ask, this.chart);
    plots.lazily(place, redraw);
  }

  draw() {
    const motion = this.motions[Number(this.motion.select.value)], log = this.kind === "log";
    const waits = log && motion.knots.length > quatspline.MotionPlot.MANY && !this.asked.has(motion);
    this.ask.hidden = !waits;
    this.chart.hidden = waits;
    if (waits) this._offer(motion);
    else if (log && !quatspline.MotionPlot.canTurn()) {
      this.chart.textContent = "This plot needs WebGL, which this browser does not offer; the player above shows the same curves.";
    } else if (log) this._log(motion);
    else this._rates(motion);
  }

  /* A button in place of the curves; paper shows what is said beside it. */
  _offer(motion) {
    const { element: make } = quatspline;
    const draw = () => { this.asked.add(motion); this.draw(); };
    const button = make("button", { type: "button", onclick: draw }, "Draw the log-curves");
    this.ask.replaceChildren(`${motion.title} has ${motion.knots.length} keyframes; its curves in space are drawn when asked for. `, button);
  }

  /* No more of a curve than its picture shows: a point wherever it has gone on by a pixel, and its end. */
  static thinned(points) {
    const { norm, add } = quatspline.geometry, axes = [0, 1, 2].map((k) => points.map((p) => p[k]));
    const extent = Math.max(...axes.map((values) => values.reduce((m, v) => Math.max(m, v), -Infinity) - values.reduce((m, v) => Math.min(m, v), Infinity)));
    const least = quatspline.MotionPlot.FINE * extent, kept = [];
    points.forEach((p, i) => { if (!kept.length || i === points.length - 1 || norm(add(p, kept[kept.length - 1], -1)) >= least) kept.push(p); });
    return kept;
  }

  static canTurn() {
    const canvas = document.createElement("canvas");
    return Boolean(canvas.getContext("webgl") || canvas.getContext("webgl2"));
  }

  /* The schemes that are drawn of a motion: at first its pair, then as the reader clicks in the legend. */
  _drawn(motion) {
    if (!this.picked.has(motion)) this.picked.set(motion, new Set(motion.pair));
    return this.picked.get(motion);
  }

  /* Curves of those drawn; the others stand in the legend, undecoded, and on paper not at all. */
  _traces(motion, make) {
    const { plots } = quatspline, drawn = this._drawn(motion), nothing = { x: [null], y: [null], z: [null] };
    const first = motion.pair, rest = motion.schemes.filter((name) => !first.includes(name));
    return [...first, ...rest].filter((name) => drawn.has(name) || !plots.onPaper()).flatMap((name) => {
      const shows = drawn.has(name), line = { color: plots.seriesColor(name), dash: plots.look(name).dash, width: 2 };
      const traces = make(shows && motion.curve(name), { name, meta: name, visible: shows || "legendonly", line });
      return shows ? traces : [{ ...traces[0], ...nothing }];
    });
  }

  _show(motion, traces, more) {
    quatspline.plots.show(this.chart, traces, { ...more, uirevision: motion.name });
    if (this.listening) return;
    this.listening = true;
    this.chart.on("plotly_legendclick", ({ data, curveNumber }) => this._pick(data[curveNumber].meta, (drawn, name) => { if (!drawn.delete(name)) drawn.add(name); }));
    this.chart.on("plotly_legenddoubleclick", ({ data, curveNumber }) => this._pick(data[curveNumber].meta, (drawn, name) => { drawn.clear(); drawn.add(name); }));
  }

  /* Keyframes, which are no scheme's, are left to the plot's own ways. */
  _pick(name, change) {
    if (!name) return true;
    change(this._drawn(this.motions[Number(this.motion.select.value)]), name);
    this.draw();
    return false;
  }

  _log(motion) {
    const { theme, plots, geometry } = quatspline;
    const along = (points) => ({ x: points.map((v) => v[0]), y: points.map((v) => v[1]), z: points.map((v) => v[2]) });
    const traces = this._traces(motion, (curve, common) => [{
      ...common, type: "scatter3d", mode: "lines", line: { ...common.line, width: 5 }, ...along(curve ? quatspline.MotionPlot.thinned(curve.log) : []),
    }]);
    const keys = motion.closed ? motion.keyframes.slice(0, -1) : motion.keyframes;
    const points = keys.map(geometry.log), many = points.length > quatspline.MotionPlot.MANY;
    const marker = { size: 5, color: theme.color("ground"), line: { color: theme.color("text"), width: 2 } };
    traces.push({
      name: "keyframes", type: "scatter3d", mode: many ? "markers" : "markers+text", visible: many ? "legendonly" : true, marker,
      text: points.map((_, i) => String(i)), textfont: { color: theme.color("text") }, ...along(points),
    });
    const face = (text) => ({ ...plots.axis(text, false), showbackground: false, gridcolor: theme.color("line") });
    const scene = { aspectmode: "data", xaxis: face("x"), yaxis: face("y"), zaxis: face("z"), camera: { projection: { type: "orthographic" } } };
    this._show(motion, traces, { scene, margin: { l: 0, r: 0, t: 0, b: 0 } });
  }

  _rates(motion) {
    const { plots, theme } = quatspline;
    const t = Array.from(motion.t, (v) => v + motion.start);
    const traces = this._traces(motion, (curve, common) => ["omega", "alpha"].map((rate, i) => ({
      ...common, type: "scatter", mode: "lines", x: t, y: curve ? curve.norms[rate] : [], yaxis: i ? "y2" : "y", showlegend: i === 0,
    })));
    const line = { color: theme.color("shell"), width: 1, dash: "dot" };
    const marked = motion.knots.length > quatspline.MotionPlot.MANY ? [] : motion.knots;
    const shapes = marked.map((k) => ({ type: "line", xref: "x", yref: "paper", x0: k + motion.start, x1: k + motion.start, y0: 0, y1: 1, line, layer: "below" }));
    const upper = { ...plots.axis("|ω| (rad/t)", false), domain: [0.54, 1], rangemode: "tozero" };
    const lower = { ...plots.axis("|α| (rad/t²)", false), domain: [0, 0.46], rangemode: "tozero" };
    this._show(motion, traces, { xaxis: { ...plots.axis("t", false), showgrid: false, anchor: "y2" }, yaxis: upper, yaxis2: lower, shapes });
  }
};
