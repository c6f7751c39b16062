/* A rate or an error over time for both schemes, with keyframes and the cursor. */
"use strict";
quatspline.Strip = class {
  static EDGE = 8; /* half the thumb of the slider above, so that times stand under each other */
  static NARROW = 14; /* pixels from keyframe to keyframe below which a strip that may be divided shows a part at a time */

  constructor(canvas, seek) {
    this.view = new quatspline.View(canvas, () => this.again && this.again());
    this.rate = canvas.dataset.rate;
    this.part = [0, 1];
    this.numbers = new WeakMap();
    this.count = 0;
    const to = (event) => {
      const box = canvas.getBoundingClientRect(), edge = quatspline.Strip.EDGE, [from, until] = this.part;
      seek(from + (until - from) * (event.clientX - box.left - edge) / (box.width - 2 * edge));
    };
    canvas.addEventListener("pointerdown", to);
    canvas.addEventListener("pointermove", (event) => event.buttons === 1 && to(event));
  }

  draw(motion, curves, t) {
    this.again = () => this.draw(motion, curves, t);
    const { view } = this, { theme } = quatspline;
    const values = curves.map(({ curve }) => curve.norms[this.rate]);
    this.part = this._part(motion, t);
    view.clear();
    const lines = values.map((list) => this._number(list));
    view.behind([motion.name, this.part, ...lines, ...curves.map(({ color }) => color)], () => this._still(motion, curves, values));
    const top = this.top;
    this._vertical(motion, t, theme.color("text"), 1.4);
    values.forEach((list, i) => view.dot(this._at(motion, t, motion.between(list, t), top), 4, curves[i].color, theme.color("ground")));
  }

  /* All but the cursor. */
  _still(motion, curves, values) {
    const { view } = this, { theme, data } = quatspline, [from, until] = this.part.map((share) => share * motion.span);
    const top = this.top = Math.max(...values.map((list) => list.reduce((m, v) => Math.max(m, v || 0), 0))) || 1;
    motion.knots.forEach((knot) => knot >= from && knot <= until && this._vertical(motion, knot, theme.color("line"), 1));
    values.forEach((list, i) => this._line(motion, list, top, curves[i]));
    view.text(data.shown(top) + (view.canvas.dataset.unit || ""), [quatspline.Strip.EDGE + 2, 9], theme.color("muted"));
  }

  /* Lists are told apart by a number each. */
  _number(list) {
    if (!this.numbers.has(list)) this.numbers.set(list, this.count++);
    return this.numbers.get(list);
  }

  /* The shares of the whole between which the strip shows it: all, or the part that holds the cursor. */
  _part(motion, t) {
    const room = (this.view.width - 2 * quatspline.Strip.EDGE) / quatspline.Strip.NARROW;
    const parts = motion.divided ? Math.max(Math.ceil((motion.knots.length - 1) / room), 1) : 1;
    const part = Math.min(Math.floor(parts * t / motion.span), parts - 1);
    return [part / parts, (part + 1) / parts];
  }

  _at(motion, t, value, top) {
    const { EDGE } = quatspline.Strip, { width, height } = this.view, [from, until] = this.part;
    return [EDGE + (width - 2 * EDGE) * (t / motion.span - from) / (until - from), height - 3 - (height - 22) * value / top];
  }

  _vertical(motion, t, color, width) {
    const [x] = this._at(motion, t, 0, 1);
    this.view.stroke([[x, 0], [x, this.view.height]], color, width);
  }

  _line(motion, list, top, { color, dash }) {
    if (list.some(Number.isNaN)) return; /* a scheme without this rate */
    const [from, until] = this.part.map((share) => motion.locate(share * motion.span));
    const points = list.slice(from.i, until.next + 1).map((v, i) => this._at(motion, motion.t[from.i + i], v, top));
    this.view.stroke(this._thinned(points), color, 2, dash);
  }

  /* No more than a screen shows: of each column of pixels the first point, the lowest, the highest and the last. */
  _thinned(points) {
    if (points.length <= 4 * this.view.width) return points;
    const kept = [];
    for (let i = 0; i < points.length;) {
      let last = i, low = i, high = i;
      for (; last < points.length && Math.floor(points[last][0]) === Math.floor(points[i][0]); last++) {
        if (points[last][1] < points[low][1]) low = last;
        if (points[last][1] > points[high][1]) high = last;
      }
      kept.push(...[...new Set([i, Math.min(low, high), Math.max(low, high), last - 1])].map((k) => points[k]));
      i = last;
    }
    return kept;
  }
};
