/* A rate over time for both schemes, with keyframes and the cursor. */
"use strict";
quatspline.Strip = class {
  static EDGE = 8; /* half the thumb of the slider above, so that times stand under each other */

  constructor(canvas, seek) {
    this.view = new quatspline.View(canvas, () => this.again && this.again());
    this.rate = canvas.dataset.rate;
    const to = (event) => {
      const box = canvas.getBoundingClientRect(), edge = quatspline.Strip.EDGE;
      seek((event.clientX - box.left - edge) / (box.width - 2 * edge));
    };
    canvas.addEventListener("pointerdown", to);
    canvas.addEventListener("pointermove", (event) => event.buttons === 1 && to(event));
  }

  draw(motion, curves, t) {
    this.again = () => this.draw(motion, curves, t);
    const { view } = this, { theme, data } = quatspline;
    const values = curves.map(({ curve }) => curve.norms[this.rate]);
    const top = Math.max(...values.map((list) => list.reduce((m, v) => Math.max(m, v || 0), 0))) || 1;
    view.clear();
    motion.knots.forEach((knot) => this._vertical(motion, knot, theme.color("line"), 1));
    values.forEach((list, i) => this._line(motion, list, top, curves[i]));
    view.text(data.shown(top), [quatspline.Strip.EDGE + 2, 9], theme.color("muted"));
    this._vertical(motion, t, theme.color("text"), 1.4);
    values.forEach((list, i) => view.dot(this._at(motion, t, motion.between(list, t), top), 4, curves[i].color, theme.color("ground")));
  }

  _at(motion, t, value, top) {
    const { EDGE } = quatspline.Strip, { width, height } = this.view;
    return [EDGE + (width - 2 * EDGE) * t / motion.span, height - 3 - (height - 22) * value / top];
  }

  _vertical(motion, t, color, width) {
    const [x] = this._at(motion, t, 0, 1);
    this.view.stroke([[x, 0], [x, this.view.height]], color, width);
  }

  _line(motion, list, top, { color, dash }) {
    if (list.some(Number.isNaN)) return; /* a scheme without this rate */
    this.view.stroke(list.map((v, i) => this._at(motion, motion.t[i], v, top)), color, 2, dash);
  }
};
