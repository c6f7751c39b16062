/* The player: two schemes on one motion, a timeline, and what all views show at one time. */
"use strict";
quatspline.Player = class {
  static SECONDS = [4, 20]; /* a motion lasts 1.5 s a segment, between these */
  static SNAP = 0.006; /* a click this near to a keyframe, as a share of the whole, means the keyframe */
  static STEPS = 200; /* arrow keys step by this share */
  static DASH = [7, 5];

  constructor(place, motions) {
    Object.assign(this, { place, motions, motion: null, time: 0, playing: false });
    this.calm = window.matchMedia("(prefers-reduced-motion: reduce)");
    this.controls = Object.fromEntries([...place.querySelectorAll("[name]")].map((c) => [c.name || c.getAttribute("name"), c]));
    const redraw = () => this.draw(), turned = (view) => this._turned(view);
    this.stages = [...place.querySelectorAll("canvas.stage")].map((c) => new quatspline.Stage(c, turned));
    this.path = new quatspline.PathView(place.querySelector("canvas.path"), redraw);
    this.strips = [...place.querySelectorAll("canvas.strip")].map((c) => new quatspline.Strip(c, (share) => this.scrub(share * this.motion.span)));
    this._listen();
    this._fill(this.controls.scene, motions.map((m, i) => [String(i), m.title]));
    this.choose(0);
    quatspline.theme.follow(redraw);
  }

  /* -- controls -- */

  _fill(select, options) {
    select.replaceChildren(...options.map(([value, text]) => quatspline.element("option", { value }, text)));
  }

  _listen() {
    const { controls } = this;
    controls.scene.addEventListener("change", () => this.choose(Number(controls.scene.value)));
    for (const name of ["a", "b", "layout", "chart", "follow"]) controls[name].addEventListener("change", () => this.draw());
    controls.play.addEventListener("click", () => (this.playing ? this.pause() : this.play()));
    controls.previous.addEventListener("click", () => this.jump(-1));
    controls.next.addEventListener("click", () => this.jump(1));
    controls.time.addEventListener("input", () => this.scrub(Number(controls.time.value)));
    this.place.addEventListener("keydown", (event) => this._key(event));
  }

  _key(event) {
    const kind = event.target.tagName;
    const own = kind === "SELECT" || (kind === "INPUT" && event.target.type === "checkbox");
    if (own || event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.key === " " && kind === "BUTTON") return; /* the button's own */
    const step = this.motion.span / quatspline.Player.STEPS;
    const action = {
      " ": () => (this.playing ? this.pause() : this.play()),
      ArrowLeft: () => this.seek(this.time - step), ArrowRight: () => this.seek(this.time + step),
      ArrowDown: () => this.seek(this.time - step), ArrowUp: () => this.seek(this.time + step),
      PageUp: () => this.jump(-1), PageDown: () => this.jump(1), Home: () => this.seek(0), End: () => this.seek(this.motion.span),
    }[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  _turned(view) {
    if (view) this.stages.forEach((stage) => { stage.turn = [...view.turn]; });
    this.draw();
  }

  /* -- the motion -- */

  choose(index) {
    this.pause();
    this.motion = this.motions[index];
    const { controls, motion } = this;
    const before = [controls.a.value, controls.b.value];
    const options = motion.schemes.map((name) => [name, name]);
    ["a", "b"].forEach((side, i) => {
      this._fill(controls[side], options);
      controls[side].value = motion.schemes.includes(before[i]) ? before[i] : motion.pair[i] || motion.schemes[0];
    });
    Object.assign(controls.time, { min: 0, max: motion.span });
    this.stages.forEach((stage) => { stage.turn = [...motion.view]; });
    this._marks();
    const refused = Object.entries(motion.refused).map(([name, why]) => `${name} (${why})`);
    this.place.querySelector(".refused").textContent = refused.length ? `Not offered here: ${refused.join("; ")}.` : "";
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

  /* -- time -- */

  seek(t) {
    const { knots, span } = this.motion;
    this.time = Math.min(Math.max(t, 0), span);
    const near = this.motion.keyframeAt(this.time);
    if (near >= 0) this.time = knots[near];
    this.draw();
  }

  /* As `seek`, caught by a keyframe that is near. */
  scrub(t) {
    const near = this.motion.knots.find((knot) => Math.abs(knot - t) < quatspline.Player.SNAP * this.motion.span);
    this.seek(near ?? t);
  }

  jump(by) {
    const { knots, span } = this.motion, slack = 1e-9 * span;
    const later = knots.filter((knot) => knot > this.time + slack), earlier = knots.filter((knot) => knot < this.time - slack);
    this.seek(by > 0 ? later[0] ?? span : earlier[earlier.length - 1] ?? 0);
  }

  play() {
    if (this.playing) return;
    if (this.time >= this.motion.span) this.time = 0;
    this.playing = true;
    this.controls.play.textContent = "Pause";
    if (this.calm.matches) this._step();
    else requestAnimationFrame((now) => this._frame(now, now));
  }

  pause() {
    this.playing = false;
    this.controls.play.textContent = "Play";
  }

  get pace() {
    const [least, most] = quatspline.Player.SECONDS;
    const seconds = Math.min(Math.max(1.5 * (this.motion.knots.length - 1), least), most);
    return Number(this.controls.speed.value) * this.motion.span / seconds;
  }

  _frame(now, last) {
    if (!this.playing) return;
    const next = this.time + this.pace * (now - last) / 1000, { span, closed } = this.motion;
    this.seek(closed && next > span ? next % span : next);
    if (!closed && this.time >= span) this.pause();
    else requestAnimationFrame((later) => this._frame(later, now));
  }

  /* For readers who asked for less motion: from keyframe to keyframe, without movement between. */
  _step() {
    if (!this.playing) return;
    if (this.time >= this.motion.span) { this.pause(); return; }
    this.jump(1);
    setTimeout(() => this._step(), 1000 / Number(this.controls.speed.value));
  }

  /* -- drawing -- */

  _sides() {
    const { theme } = quatspline;
    return [["a", []], ["b", quatspline.Player.DASH]].map(([side, dash]) => ({ side, dash, color: theme.color(side), curve: this.motion.curve(this.controls[side].value) }));
  }

  _mover({ curve, color }) {
    const { motion, time } = this, { multiply, conjugate, scaled } = quatspline.geometry;
    const q = motion.orientation(curve.name, time), omega = motion.between(curve.omega, time);
    const world = multiply(multiply(q, [0, ...omega]), conjugate(q)).slice(1);
    const largest = curve.norms.omega.reduce((m, v) => Math.max(m, v), 0) || 1;
    return { scheme: curve.name, q, place: motion.between(motion.places, time), color, spin: scaled(world, 1 / largest) };
  }

  draw() {
    if (!this.motion || !this.controls) return;
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
