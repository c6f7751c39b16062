/* Draw your own: keyframes that a reader turns, moves in time, pastes and shares; the curves follow at once. */
"use strict";

/* A motion through keyframes that change: what `Motion` is, computed here. */
quatspline.OwnMotion = class extends quatspline.Sampled {
  static PARTS = 32; /* samples per segment ... */
  static SAMPLES = [9600, 4]; /* ... and fewer where there are many segments: in all, and per segment at least */
  static BEFORE = 1e-4; /* of a segment: the sample before its end, so that a jump is a step and not a slope */
  static APART = 1.15; /* bodies stand so far apart, in body lengths */

  constructor(body, times, quaternions) {
    super();
    Object.assign(this, { body, scale: 1, closed: false, view: [20, -60], pair: ["quartic", "slerp"], refused: {}, title: "Your keyframes", revision: 0 });
    this.set(times, quaternions);
  }

  get name() { return `own ${this.revision}`; }
  get parts() {
    const { PARTS, SAMPLES: [all, least] } = quatspline.OwnMotion;
    return Math.min(PARTS, Math.max(least, Math.floor(all / (this.knots.length - 1))));
  }
  get schemes() { return quatspline.curves.SCHEMES; }

  set(times, quaternions) {
    this.revision += 1;
    this.times = times;
    this.start = times[0];
    this.knots = times.map((t) => t - times[0]);
    this.span = this.knots[this.knots.length - 1];
    this.keyframes = quatspline.curves.aligned(quaternions);
    this.samples = this._samples();
    this.t = Float32Array.from(this.samples, ({ t }) => t);
    const width = quatspline.OwnMotion.APART * (this.knots.length - 1);
    this.places = this.samples.map(({ t }) => [width * t / this.span, 0, 0]);
    this.known = new Map();
  }

  /* Times since the first keyframe; the last of a segment is read from the segment that ends there. */
  _samples() {
    const { BEFORE } = quatspline.OwnMotion, { knots, parts } = this, all = [];
    for (let k = 0; k + 1 < knots.length; k++) {
      const h = knots[k + 1] - knots[k];
      for (let i = 0; i < parts; i++) all.push({ t: knots[k] + h * i / parts, at: knots[k] + h * i / parts, side: 1 });
      all.push({ t: knots[k + 1] - BEFORE * h, at: knots[k + 1], side: -1 });
    }
    return [...all, { t: this.span, at: this.span, side: -1 }];
  }

  curve(name) {
    if (!this.known.has(name)) {
      const { norm, log } = quatspline.geometry, at = quatspline.curves.build(name, this.knots, this.keyframes);
      const points = this.samples.map((sample) => at(sample.at, sample.side));
      const [q, omega, alpha] = ["q", "omega", "alpha"].map((key) => points.map((point) => point[key]));
      this.known.set(name, { name, title: name, q, omega, alpha, log: q.map(log), norms: { omega: omega.map(norm), alpha: alpha.map(norm) } });
    }
    return this.known.get(name);
  }

  orientation(name, t) {
    const { i, next, u } = this.locate(t), { q } = this.curve(name);
    return u === 0 ? q[i] : quatspline.geometry.slerp(q[i], q[next], u);
  }

  /* Degrees of rotation that a curve goes beyond a step's ends along its great circle, at most; during holds, away from it. */
  overshoot(name) {
    const { q } = this.curve(name), { keyframes } = this, per = this.parts + 1;
    const worst = keyframes.slice(1).map((end, k) => this._beyond(q.slice(k * per, (k + 1) * per), keyframes[k], end));
    return 360 / Math.PI * Math.max(...worst);
  }

  _beyond(points, start, end) {
    const g = quatspline.geometry, step = quatspline.curves.between(start, end), length = g.norm(step);
    if (length < 1e-12) return Math.max(...points.map((q) => g.norm(g.log(g.multiply(g.conjugate(start), q)))));
    const side = g.multiply(start, [0, ...g.scaled(step, 1 / length)]);
    let last = 0, most = 0;
    for (const q of points) {
      let psi = Math.atan2(g.dot(q, side), g.dot(q, start));
      psi += 2 * Math.PI * Math.round((last - psi) / (2 * Math.PI));
      most = Math.max(most, psi - length, -psi);
      last = psi;
    }
    return most;
  }
};

/* A stage on which a drag turns the body, where its owner wants that. */
quatspline.TurningStage = class extends quatspline.Stage {
  rotate(right, up) {
    if (!this.turning?.(this, right, up)) super.rotate(right, up);
  }
};

quatspline.Drawing = class extends quatspline.Player {
  static STAGE = quatspline.TurningStage;
  static CLOSE = 0.02; /* keyframes keep this share of the whole apart */
  static SOON = 60; /* ms after which all schemes are measured: a drag waits for the two that are shown only */
  static DIGITS = 6; /* decimals of numbers in the address */

  constructor(place, body, times, quaternions) {
    super(place, [new quatspline.OwnMotion(body, times, quaternions)]);
    this.first = { times, quaternions };
    this.stages.forEach((stage) => {
      stage.turning = (view, right, up) => this._turnKeyframe(view, right, up);
      stage.canvas.addEventListener("pointerup", () => this.share());
    });
    const { controls } = this, button = (name, action) => controls[name].addEventListener("click", action);
    button("add", () => this.addKeyframe());
    button("remove", () => this.removeKeyframe());
    button("reset", () => { this.replace(this.first.times, this.first.quaternions); this.share(); });
    button("paste", () => this.paste(controls.csv.value));
    button("save", () => quatspline.data.save("keyframes.csv", "text/csv;charset=utf-8", this.csv()));
    ["a", "b"].forEach((side) => controls[side].addEventListener("change", () => this.share()));
    quatspline.address.follow("draw", (values) => this.restore(values));
    this.measure();
  }

  /* -- keyframes -- */

  get selected() {
    const { knots } = this.motion;
    return knots.reduce((best, knot, k) => (Math.abs(knot - this.time) < Math.abs(knots[best] - this.time) ? k : best), 0);
  }

  replace(times, quaternions) {
    const { motion, controls } = this, time = this.time;
    motion.set(times, quaternions);
    controls.time.max = motion.span;
    this._marks();
    this.seek(Math.min(time, motion.span));
    this.soon ||= setTimeout(() => { this.soon = 0; this.measure(); }, quatspline.Drawing.SOON);
  }

  /* Turn the keyframe at the cursor, about the axes of the screen; right and up in degrees. */
  _turnKeyframe(view, right, up) {
    if (this.controls.drag.value !== "body" || this.playing) return false;
    const g = quatspline.geometry, k = this.selected, half = Math.PI / 360, [across, upright] = view.axes;
    const turn = g.exp(g.add(g.scaled(upright, right * half), across, up * half));
    this.time = this.motion.knots[k];
    this.replace(this.motion.times, this.motion.keyframes.map((q, i) => (i === k ? g.multiply(turn, q) : q)));
    return true;
  }

  /* Move a keyframe in time, between its neighbours. */
  move(k, time) {
    const { times, keyframes } = this.motion, room = quatspline.Drawing.CLOSE * this.motion.span;
    if (k === 0) return;
    const most = k + 1 < times.length ? times[k + 1] - room : Infinity;
    const moved = Math.min(Math.max(time, times[k - 1] + room), most);
    this.time = moved - times[0];
    this.replace(times.map((t, i) => (i === k ? moved : t)), keyframes);
  }

  addKeyframe() {
    const { motion, time, controls } = this, room = quatspline.Drawing.CLOSE * motion.span;
    if (motion.knots.some((knot) => Math.abs(knot - time) < room)) { this.say("Go to a time between two keyframes first."); return; }
    const k = motion.knots.findIndex((knot) => knot > time), q = motion.orientation(controls.a.value, time);
    this.replace(motion.times.toSpliced(k, 0, time + motion.start), motion.keyframes.toSpliced(k, 0, q));
    this.share();
  }

  removeKeyframe() {
    const { motion, selected } = this;
    if (motion.times.length <= 2) { this.say("A curve needs two keyframes."); return; }
    this.replace(motion.times.toSpliced(selected, 1), motion.keyframes.toSpliced(selected, 1));
    this.share();
  }

  /* -- the marks of the timeline, which are dragged -- */

  _marks() {
    super._marks();
    const marks = this.place.querySelector(".marks");
    [...marks.children].forEach((mark, k) => {
      mark.title = k ? "Drag to move in time, or Shift and the arrows" : "The first keyframe stays";
      mark.addEventListener("keydown", (event) => {
        const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        if (!event.shiftKey || !by) return;
        event.preventDefault();
        event.stopPropagation();
        this.move(k, this.motion.times[k] + 0.01 * by * this.motion.span);
        this.place.querySelectorAll(".marks button")[k].focus();
        this.share();
      });
    });
    if (this.draggable) return;
    this.draggable = true;
    let k = -1, shift = 0;
    marks.addEventListener("pointerdown", (event) => {
      k = [...marks.children].indexOf(event.target);
      shift = marks.getBoundingClientRect().width / this.motion.span; /* pixels a unit of time, while this drag lasts */
      if (k >= 0) { this.seek(this.motion.knots[k]); marks.setPointerCapture(event.pointerId); }
    });
    marks.addEventListener("pointermove", (event) => {
      if (k > 0) this.move(k, this.motion.start + (event.clientX - marks.getBoundingClientRect().left) / shift);
    });
    ["pointerup", "pointercancel"].forEach((kind) => marks.addEventListener(kind, () => { if (k > 0) this.share(); k = -1; }));
  }

  /* -- what is seen of the curves -- */

  measure() {
    const { motion } = this, { element: make, data } = quatspline, largest = (list) => list.reduce((m, v) => Math.max(m, v), 0);
    const rows = motion.schemes.map((name) => {
      const { norms } = motion.curve(name), numbers = [motion.overshoot(name), largest(norms.omega), largest(norms.alpha)];
      return make("tr", {}, make("th", { scope: "row" }, name), ...numbers.map((v) => make("td", { class: "number" }, data.shown(Number(v.toFixed(6))))));
    });
    this.place.querySelector(".measured tbody").replaceChildren(...rows);
  }

  say(text) { this.place.querySelector(".said").textContent = text; }

  /* -- files and addresses -- */

  csv() {
    const { times, keyframes } = this.motion;
    return `t,w,x,y,z\n${times.map((t, k) => [t, ...keyframes[k]].join(",")).join("\n")}\n`;
  }

  /* Keyframes from text, or a word on what is wrong with it. */
  paste(text) {
    const { rows, wrong } = quatspline.pasted.read(text);
    this.say(wrong || `${rows.length} keyframes taken.`);
    if (wrong) return;
    this._take(rows);
    this.share();
  }

  _take(rows) { this.replace(rows.map((row) => row[0]), rows.map((row) => row.slice(1))); }

  share() {
    const { motion, controls } = this, { DIGITS } = quatspline.Drawing, short = (v, digits) => Number(v.toFixed(digits));
    const closest = motion.knots.slice(1).reduce((least, knot, k) => Math.min(least, knot - motion.knots[k]), Infinity);
    const decimals = Math.min(Math.max(DIGITS - Math.floor(Math.log10(closest)), 0), 20); /* so that no two times become one */
    const keys = motion.times.map((t, k) => [short(t, decimals), ...motion.keyframes[k].map((v) => short(v, DIGITS))].join(",")).join(";");
    const view = { a: controls.a.value, b: controls.b.value, keys };
    quatspline.address.write("draw", view);
    this.place.querySelector("a.share").href = quatspline.address.of("draw", view);
  }

  restore(values) {
    const rows = (values.get("keys") || "").split(";").map((row) => row.split(",").map(Number)), { motion, controls } = this;
    const wrong = quatspline.pasted.fault(rows);
    this.say(wrong && `The address holds no motion. ${wrong}`);
    if (wrong) return;
    ["a", "b"].forEach((side) => { if (motion.schemes.includes(values.get(side))) controls[side].value = values.get(side); });
    this._take(rows);
    this.place.querySelector("a.share").href = location.hash;
  }
};
