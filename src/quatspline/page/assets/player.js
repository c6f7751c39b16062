/* The player: two schemes on one motion, a timeline, and what all views show at one time. */
"use strict";
quatspline.Player = class extends quatspline.Clock {
  static STAGE = quatspline.Stage;
  static SECONDS = [4, 20]; /* a motion lasts 1.5 s a segment, between these */

  constructor(place, motions) {
    super(place, motions);
    this.stages = [...place.querySelectorAll("canvas.stage")].map((c) => new this.constructor.STAGE(c, (view) => this._turned(view)));
    this.path = new quatspline.PathView(place.querySelector("canvas.path"), () => this.draw());
    this._redraw("a", "b", "layout", "chart", "follow");
    this.choose(0);
  }

  _turned(view) {
    if (view) this.stages.forEach((stage) => { stage.turn = [...view.turn]; });
    this.draw();
  }

  /* -- the motion -- */

  choose(index) {
    this._open(index);
    this.stages.forEach((stage) => { stage.turn = [...this.motion.view]; });
    this._marks();
    this.seek(0);
  }

  _marks() {
    const { element: make } = quatspline, { knots, span, closed } = this.motion;
    const few = knots.length <= 24;
    const buttons = knots.map((knot, k) => {
      const label = closed && k === knots.length - 1 ? 0 : k;
      return make("button", { type: "button", style: `left: ${100 * knot / span}%`, "aria-label": `Keyframe ${label} at time ${knot + this.motion.start}`, onclick: () => this.seek(knot) }, String(label));
    });
    this.place.querySelector(".marks").replaceChildren(...(few ? buttons : []));
  }

  get pace() {
    const [least, most] = quatspline.Player.SECONDS;
    const seconds = Math.min(Math.max(1.5 * (this.motion.knots.length - 1), least), most);
    return Number(this.controls.speed.value) * this.motion.span / seconds;
  }

  /* -- drawing -- */

  _mover({ curve, color }) {
    const { motion, time } = this, { multiply, conjugate, scaled } = quatspline.geometry;
    const q = motion.orientation(curve.name, time), omega = motion.between(curve.omega, time);
    const world = multiply(multiply(q, [0, ...omega]), conjugate(q)).slice(1);
    const largest = curve.fastest ??= curve.norms.omega.reduce((m, v) => Math.max(m, v), 0) || 1;
    return { scheme: curve.name, q, place: motion.between(motion.places, time), color, spin: scaled(world, 1 / largest) };
  }

  draw() {
    if (!this.motion) return;
    const { controls, motion, time } = this, sides = this._sides();
    const over = controls.layout.value === "over", follow = controls.follow.checked;
    const grid = this.place.querySelector(".bodies");
    if (grid.classList.toggle("over", over) !== this.over) { this.over = over; this.stages.forEach((stage) => stage.resize()); this.path.resize(); }
    const movers = sides.map((side) => ({ ...this._mover(side), arrow: over ? side.color : quatspline.theme.color("text") }));
    if (over) this.stages[0].draw(motion, movers, follow);
    else this.stages.forEach((stage, i) => stage.draw(motion, [movers[i]], follow));
    this.path.draw(motion, controls.chart.value, sides, time);
    this.strips.forEach((strip) => strip.draw(motion, sides, time));
    this._tell(sides, over);
  }

  _tell(sides, over) {
    const { motion, time, controls } = this, { shown } = quatspline.data;
    const key = motion.keyframeAt(time), moment = shown(Number((time + motion.start).toPrecision(7)));
    const label = motion.closed && key === motion.knots.length - 1 ? 0 : key;
    controls.time.value = time;
    controls.time.setAttribute("aria-valuetext", `time ${moment}${key >= 0 ? `, keyframe ${label}` : ""}`);
    const rates = sides.map(({ side, curve }) => `${side.toUpperCase()}: |ω| ${motion.between(curve.norms.omega, time).toFixed(2)}, |α| ${motion.between(curve.norms.alpha, time).toFixed(2)}`);
    controls.readout.textContent = `t = ${moment}${key >= 0 ? ` (keyframe ${label})` : ""} · ${rates.join(" · ")}`;
    [...this.place.querySelectorAll(".marks button")].forEach((button, k) => button.setAttribute("aria-current", String(k === key)));
    const names = sides.map(({ side, curve }) => `${side.toUpperCase()}: ${curve.title}`);
    this.place.querySelectorAll(".bodies figcaption").forEach((caption, i) => { caption.textContent = over ? names.join(" · ") : names[i]; });
    this.stages.forEach((stage, i) => stage.canvas.setAttribute("aria-label", `The moving body. ${over ? names.join("; ") : names[i]}`));
    const chart = controls.chart.value === "log" ? "ln q(t)" : "Stereographic image of q(t)";
    this.place.querySelector(".paths figcaption").textContent = `${chart}: ${sides[0].curve.name} solid, ${sides[1].curve.name} dashed; circles are keyframes, arrows tangents.`;
    this.path.canvas.setAttribute("aria-label", `${chart} of ${sides[0].curve.name} and ${sides[1].curve.name} with their keyframes`);
  }

  /* What the canvases show now: for tests, and for whoever asks the console. */
  pose() {
    const shown = this.over ? [this.stages[0]] : this.stages;
    return { time: this.time + this.motion.start, keyframe: this.motion.keyframeAt(this.time), poses: shown.flatMap((stage) => stage.poses) };
  }
};
