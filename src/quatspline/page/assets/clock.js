/* What runs in time: the controls that every player has, its keys, and how it plays. */
"use strict";
quatspline.Clock = class {
  static SNAP = 0.006; /* a click this near to a keyframe, as a share of the whole, means the keyframe */
  static STEPS = 200; /* arrow keys step by this share */
  static DASH = [7, 5];

  constructor(place, motions) {
    Object.assign(this, { place, motions, motion: null, time: 0, playing: false });
    this.calm = window.matchMedia("(prefers-reduced-motion: reduce)");
    this.controls = Object.fromEntries([...place.querySelectorAll("[name]")].map((c) => [c.name || c.getAttribute("name"), c]));
    this.strips = [...place.querySelectorAll("canvas.strip")].map((c) => new quatspline.Strip(c, (share) => this.scrub(share * this.motion.span)));
    this._listen();
    quatspline.theme.follow(() => this.draw());
  }

  /* -- controls -- */

  _fill(select, options) {
    select.replaceChildren(...options.map(([value, text]) => quatspline.element("option", { value }, text)));
  }

  _listen() {
    const { controls } = this;
    controls.scene.addEventListener("change", () => this.choose(Number(controls.scene.value)));
    this._fill(controls.scene, this.motions.map((m, i) => [String(i), m.title]));
    controls.play.addEventListener("click", () => (this.playing ? this.pause() : this.play()));
    controls.previous.addEventListener("click", () => this.jump(-1));
    controls.next.addEventListener("click", () => this.jump(1));
    controls.time.addEventListener("input", () => this.scrub(Number(controls.time.value)));
    this.place.addEventListener("keydown", (event) => this._key(event));
  }

  /* Controls that change nothing but what is drawn. */
  _redraw(...names) { names.forEach((name) => this.controls[name].addEventListener("change", () => this.draw())); }

  /* A motion by its number: the schemes that it has (those chosen before stay if they can) and its time. */
  _open(index) {
    this.pause();
    this.motion = this.motions[index];
    const { controls, motion } = this;
    controls.scene.value = String(index);
    ["a", "b"].forEach((side, i) => {
      const before = controls[side].value;
      this._fill(controls[side], motion.schemes.map((name) => [name, name]));
      controls[side].value = motion.schemes.includes(before) ? before : motion.pair[i] || motion.schemes[0];
    });
    Object.assign(controls.time, { min: 0, max: motion.span });
    const refused = Object.entries(motion.refused).map(([name, why]) => `${name} (${why})`);
    this.place.querySelector(".refused").textContent = refused.length ? `Not offered here: ${refused.join("; ")}.` : "";
  }

  /* The schemes compared, each with its looks. */
  _sides() {
    return [["a", []], ["b", quatspline.Clock.DASH]].map(([side, dash]) => {
      const name = this.controls[side].value, color = quatspline.plots.seriesColor(name);
      if (this.place.style.getPropertyValue(`--${side}`) !== color) this.place.style.setProperty(`--${side}`, color);
      return { side, dash, color, curve: this.motion.curve(name) };
    });
  }

  _key(event) {
    const kind = event.target.tagName;
    const own = kind === "SELECT" || kind === "TEXTAREA" || (kind === "INPUT" && event.target.type === "checkbox");
    if (own || event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.key === " " && kind === "BUTTON") return; /* the button's own */
    const step = this.motion.span / quatspline.Clock.STEPS;
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
    const near = this.motion.knots.find((knot) => Math.abs(knot - t) < quatspline.Clock.SNAP * this.motion.span);
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
};
