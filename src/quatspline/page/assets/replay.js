/* The player of recorded motion: the truth as a ghost, two schemes over it, and the error of a joint over time. */
"use strict";
quatspline.Replay = class extends quatspline.Clock {
  static WIDTHS = { a: 4.5, b: 2.2 }; /* so that A shows where B lies upon it */
  static VIEWS = { true: [12, -58], false: [24, -50] }; /* of skeletons, of bodies */

  constructor(place, motions) {
    super(place, motions);
    const view = (name, kind) => new kind(place.querySelector(`canvas.${name}`), (turned) => this._turned(turned));
    this.views = [view("figure", quatspline.FigureView), view("near", quatspline.NearView)];
    this._redraw("a", "b", "joint", "follow");
    this.choose(0);
  }

  _turned(view) {
    if (view) this.views.forEach((other) => { other.turn = [...view.turn]; });
    this.draw();
  }

  choose(index) {
    this._open(index);
    const { controls, motion, place } = this;
    this._fill(controls.joint, [["-1", "all (rms)"], ...motion.joints.map((name, i) => [String(i), name])]);
    controls.joint.value = "-1";
    controls.joint.parentElement.hidden = motion.joints.length < 2;
    controls.follow.checked = motion.upright;
    this.views.forEach((view) => { view.turn = [...quatspline.Replay.VIEWS[motion.upright]]; });
    place.querySelector(".told").textContent = motion.told();
    this.seek(0);
  }

  /* Recorded motion runs as fast as it was. */
  get pace() { return Number(this.controls.speed.value); }

  /* The joint picked, -1 for all; and the one that is marked and seen from near, for all that with the largest error. */
  get picked() { return this.motion.joints.length > 1 ? Number(this.controls.joint.value) : 0; }
  get joint() { return this.picked < 0 ? this.motion.worst(this.motion.curve(this.controls.a.value)) : this.picked; }

  draw() {
    if (!this.motion) return;
    const { motion, time, picked, joint } = this;
    const sides = this._sides().map((side) => ({ ...side, width: quatspline.Replay.WIDTHS[side.side], points: motion.pose(side.curve.places, time), errors: motion.errors(side.curve, picked) }));
    this.shown = { truth: motion.pose(motion.truth, time), sides, joint, time, follow: this.controls.follow.checked };
    this.views.forEach((view) => view.draw(motion, this.shown));
    const curves = sides.map(({ errors, color, dash }) => ({ curve: { norms: { error: errors } }, color, dash }));
    this.strips[0].draw(motion, curves, time);
    this._tell(sides, joint, picked);
  }

  _tell(sides, joint, picked) {
    const { motion, time, controls } = this, key = motion.keyframeAt(time);
    const moment = (time + motion.start).toFixed(2), name = picked < 0 ? "all joints, rms" : motion.joints[joint];
    controls.time.value = time;
    controls.time.setAttribute("aria-valuetext", `${moment} s${key >= 0 ? ", a keyframe" : ""}`);
    const apart = (curve) => motion.length(motion.between(motion.distance(curve, motion.tips[joint]).list, time));
    const off = sides.map(({ side, curve, errors }) => `${side.toUpperCase()} ${motion.between(errors, time).toFixed(2)}°${picked < 0 ? "" : `, ${apart(curve)}`}`);
    controls.readout.textContent = `${moment} s${key >= 0 ? " (keyframe)" : ""} · ${off.join(" · ")}`;
    const [from, until] = this.strips[0].part.map((share) => (share * motion.span + motion.start).toFixed(1));
    const state = [from, until, controls.scene.value, picked, ...sides.map((side) => side.curve.name)].join();
    if (state !== this.state) this._label(sides, joint, name, until - from < motion.span - 0.1 ? ` Shown: ${from} s to ${until} s.` : "");
    this.state = state;
  }

  /* What stays while time goes on. */
  _label(sides, joint, name, part) {
    const { motion, place } = this, caption = (part, text) => { place.querySelector(part).textContent = text; };
    const names = sides.map(({ side, curve }) => `${side.toUpperCase()} ${curve.name} ${side === "a" ? "solid" : "dashed"}`).join(", ");
    const near = motion.upright ? `The point moved by ${motion.joints[joint]}` : "The body's path";
    caption("figcaption.figure", `Pale: the motion itself. ${names}. The ring marks the close-up.`);
    caption("figcaption.near", `${near}, from near; circles are keyframes.`);
    caption("figcaption.error", `Angle (degrees) from the motion itself: ${motion.upright ? name : "the body"}. Grey lines are keyframes.${part}`);
    this.views[0].canvas.setAttribute("aria-label", `The motion itself as a pale figure, with ${names}`);
    this.views[1].canvas.setAttribute("aria-label", `${near}, from near: the motion itself and ${names}`);
    this.strips[0].view.canvas.setAttribute("aria-label", `Angle from the motion itself over time, ${name}: ${names}`);
  }

  /* What is drawn now: for tests, and for whoever asks the console. */
  pose() {
    const { truth, sides, joint } = this.shown, { time, motion } = this;
    const figures = Object.fromEntries(sides.map(({ side, curve, points }) => [side, { scheme: curve.name, points }]));
    return { time: time + motion.start, keyframe: motion.keyframeAt(time), joint: motion.joints[joint], truth, ...figures };
  }
};
