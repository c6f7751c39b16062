/* The unit-quaternion path of both schemes in a chart, with the tangents that arrive at keyframes and leave them. */
"use strict";
quatspline.PathView = class extends quatspline.View {
  static MARGIN = 34;
  static TANGENT = 0.22; /* arrows span this share of the mean keyframe spacing */
  static STEP = 1e-3; /* rad, for pushing a rate forward through the chart */
  static FOLD = 0.2; /* a jump of the chart over one step: no tangent is drawn across it */

  /* Charts: a quaternion of the curve, relative to a reference, to a point; and the radius of half a turn. */
  static CHARTS = {
    log: { point: (q) => quatspline.geometry.log(q), radius: Math.PI / 2, shell: "half a turn, |ln q| = π/2" },
    stereographic: { point: ([w, x, y, z]) => [x, y, z].map((v) => v / Math.max(1 + w, 0.05)), radius: 1, shell: "half a turn from the centre" },
  };

  /* Curves: [{curve, color, dash}]; `t` is the cursor. */
  draw(motion, chart, curves, t) {
    const { theme } = quatspline;
    this.chart = quatspline.PathView.CHARTS[chart];
    this.clear();
    const state = [motion.name, chart, ...curves.flatMap(({ curve, color }) => [curve.name, color])];
    this.behind(state, () => this._still(motion, chart, curves, theme));
    curves.forEach((item, i) => this._cursor(motion, item, this.lines[i], t));
  }

  /* All but the cursor. */
  _still(motion, chart, curves, theme) {
    this._reference(motion, chart, curves);
    this.lines = curves.map(({ curve }) => this._line(curve, chart));
    this.fit(this._box(this.lines.flat(), this.axes), quatspline.PathView.MARGIN);
    this._shell(theme);
    curves.forEach((item, i) => this.stroke(this.lines[i].map((p) => this._at(p)), item.color, 2.4, item.dash));
    curves.forEach((item) => this._tangents(motion, item, chart));
    this._keyframes(motion, chart, theme);
  }

  /* The stereographic chart looks from the mean of the first curve, so that it stays away from the pole. */
  _reference(motion, chart, curves) {
    const { unit, conjugate } = quatspline.geometry;
    const mean = [0, 1, 2, 3].map((k) => curves[0].curve.q.reduce((sum, q) => sum + q[k], 0));
    this.back = chart === "log" || Math.hypot(...mean) < 1e-6 ? [1, 0, 0, 0] : conjugate(unit(mean));
  }

  _point(q) { return this.chart.point(quatspline.geometry.multiply(this.back, q)); }
  _line(curve, chart) { return chart === "log" ? curve.log : curve.q.map((q) => this._point(q)); }
  _at(p) { return this.at(quatspline.geometry.apply(this.axes, p)); }

  /* The same size for every angle of the camera, so that turning does not zoom. */
  _box(points) {
    const low = [0, 1, 2].map((k) => points.reduce((m, p) => Math.min(m, p[k]), Infinity));
    const high = [0, 1, 2].map((k) => points.reduce((m, p) => Math.max(m, p[k]), -Infinity));
    const middle = low.map((v, k) => (v + high[k]) / 2);
    const reach = 0.5 * Math.hypot(...low.map((v, k) => high[k] - v)) || 1;
    const centre = quatspline.geometry.apply(this.axes, middle);
    return [[centre[0] - reach, centre[1] - reach], [centre[0] + reach, centre[1] + reach]];
  }

  _shell(theme) {
    const { radius, shell } = this.chart, color = theme.color("shell");
    const angles = Array.from({ length: 73 }, (_, i) => i * Math.PI / 36);
    const circle = (f) => this.stroke(angles.map((a) => this._at(f(radius * Math.cos(a), radius * Math.sin(a)))), color, 0.8, [2, 4]);
    circle((c, s) => [c, s, 0]);
    circle((c, s) => [c, 0, s]);
    circle((c, s) => [0, c, s]);
    this.text(`dotted: ${shell}`, [10, this.height - 12], theme.color("muted"));
    [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]].forEach(([name, axis]) => this._axis(name, axis, theme));
  }

  /* A small triad in the corner. */
  _axis(name, axis, theme) {
    const [x, y] = quatspline.geometry.apply(this.axes, axis), from = [32, 36];
    const to = [from[0] + 22 * x, from[1] - 22 * y];
    this.stroke([from, to], theme.color("muted"), 1);
    this.text(name, [from[0] + 30 * x, from[1] - 30 * y], theme.color("muted"), "center");
  }

  /* How fast the path's point moves in the chart when the body turns by omega from q; null across a fold. */
  tangent(q, omega) {
    const { multiply, exp, scaled, norm, add } = quatspline.geometry, { STEP, FOLD } = quatspline.PathView;
    const speed = norm(omega);
    if (!(speed > 0)) return null;
    const ahead = this._point(multiply(q, exp(scaled(omega, 0.5 * STEP / speed))));
    const moved = add(ahead, this._point(q), -1);
    return norm(moved) > FOLD ? null : scaled(moved, speed / STEP);
  }

  _tangents(motion, { curve, color }, chart) {
    const line = this._line(curve, chart), { add } = quatspline.geometry;
    const length = quatspline.PathView.TANGENT * motion.span / (motion.knots.length - 1);
    if (motion.knots.length > 40) return;
    motion.knots.forEach((knot, k) => {
      const { i } = motion.locate(knot);
      const before = k > 0 && this.tangent(curve.q[i - 1], curve.omega[i - 1]);
      const after = k < motion.knots.length - 1 && this.tangent(curve.q[i], curve.omega[i]);
      if (before) this.stroke([this._at(add(line[i], before, -length)), this._at(line[i])], color, 1.6);
      if (after) this.arrow(this._at(line[i]), this._at(add(line[i], after, length)), color, 1.6);
    });
  }

  _keyframes(motion, chart, theme) {
    const count = motion.closed ? motion.keyframes.length - 1 : motion.keyframes.length;
    if (count > 200) return;
    motion.keyframes.slice(0, count).forEach((q, k) => {
      const p = this._at(this._point(q));
      this.dot(p, 4, theme.color("ground"), theme.color("text"));
      if (count <= 24) this.text(String(k), [p[0] + 8, p[1] - 9], theme.color("text"));
    });
  }

  _cursor(motion, { curve, color }, line, t) {
    const p = motion.between(line, t), { add } = quatspline.geometry;
    const push = this.tangent(motion.orientation(curve.name, t), motion.between(curve.omega, t));
    const length = 1.5 * quatspline.PathView.TANGENT * motion.span / (motion.knots.length - 1);
    if (push) this.arrow(this._at(p), this._at(add(p, push, length)), quatspline.theme.color("text"), 2.2);
    this.dot(this._at(p), 5.5, color, quatspline.theme.color("ground"));
  }
};
