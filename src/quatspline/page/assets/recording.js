/* Recorded motions as the player reads them: points in the world, the true ones and those that schemes rebuilt. */
"use strict";
quatspline.Recording = class extends quatspline.Sampled {
  constructor(packed) {
    super();
    const { title, source, every, unit, frames, start, upright, lines, joints, tips, bases, refused } = packed;
    Object.assign(this, { title, source, every, unit, frames, start, upright, lines, joints, tips, bases, refused });
    Object.assign(this, { closed: false, divided: true });
    this.t = quatspline.data.floats(packed.times);
    this.span = this.t[this.t.length - 1];
    this.isKey = Array.from(this.t, () => false);
    packed.keyframes.forEach((frame) => { this.isKey[frame] = true; });
    this.knots = packed.keyframes.map((frame) => this.t[frame]);
    this.packed = packed;
    this.known = new Map();
    this.schemes = Object.keys(packed.schemes);
    this.pair = packed.pair;
    this.truth = this._places(packed.truth);
    this.size = this.truth.length / this.t.length;
    this._measure();
  }

  _places(text) {
    const whole = quatspline.data.signed(text), { origin, step } = this.packed;
    return Float64Array.from(whole, (v, i) => origin[i % 3] + step * v);
  }

  /* A scheme's figure, decoded when first asked for. */
  curve(name) {
    if (!this.known.has(name)) {
      const packed = this.packed.schemes[name];
      const angles = quatspline.data.integers(packed.angles);
      this.known.set(name, { name, title: packed.title, places: this._places(packed.places), angles, step: packed.angle_step, errors: new Map(), distances: new Map() });
    }
    return this.known.get(name);
  }

  /* The angle (degrees) by which a joint is off at all frames; of joint -1, the root mean square of all joints. */
  errors(curve, joint) {
    const { angles, step, errors } = curve, width = this.joints.length;
    if (!errors.has(joint)) {
      const row = (i) => angles.subarray(i * width, (i + 1) * width);
      const rms = (i) => step * Math.sqrt(row(i).reduce((sum, v) => sum + v * v, 0) / width);
      errors.set(joint, Array.from(this.t, (_, i) => (joint < 0 ? rms(i) : step * angles[i * width + joint])));
    }
    return errors.get(joint);
  }

  /* The joint that a scheme has farthest off, by its root mean square. */
  worst(curve) {
    if (curve.worst === undefined) {
      const power = this.joints.map((_, joint) => this.errors(curve, joint).reduce((sum, v) => sum + v * v, 0));
      curve.worst = power.indexOf(Math.max(...power));
    }
    return curve.worst;
  }

  /* How far a point is from where it was, at all frames, and the root mean square of that. */
  distance({ places, distances }, p) {
    if (!distances.has(p)) {
      const list = Array.from(this.t, (_, i) => Math.hypot(...quatspline.geometry.add(this.point(places, i, p), this.point(this.truth, i, p), -1)));
      distances.set(p, { list, rms: Math.sqrt(list.reduce((sum, v) => sum + v * v, 0) / list.length) });
    }
    return distances.get(p);
  }

  /* A length as text, in the file's unit where that is not metres. */
  length(size) {
    const { shown } = quatspline.data, round = (v) => shown(Number(v.toPrecision(2)));
    if (this.unit !== "m") return `${round(size)} of the file's unit`;
    return size < 0.01 ? `${round(1000 * size)} mm` : `${round(100 * size)} cm`;
  }

  /* What is shown of it, and where it comes from. */
  told() {
    const { every, frames: [first, last, all], source } = this, kept = { 2: "2nd", 3: "3rd" }[every] || `${every}th`;
    const part = last - first + 1 + every < all ? `Showing frames ${first} to ${last} of ${all}. ` : "";
    return `Rebuilt from every ${kept} frame. ${part}${source}`.trim();
  }

  /* All points at a time, straight between frames. */
  pose(places, t) {
    const { i, next, u } = this.locate(t), { size } = this;
    return Array.from({ length: size / 3 }, (_, p) => [0, 1, 2].map((k) => {
      const from = places[i * size + 3 * p + k];
      return from + u * (places[next * size + 3 * p + k] - from);
    }));
  }

  /* A point at frame i. */
  point(places, i, p) { return Array.from(places.subarray(i * this.size + 3 * p, i * this.size + 3 * p + 3)); }

  /* How far a figure reaches from its first point, how low it comes, and the box of the first point's path. */
  _measure() {
    const count = this.size / 3, { t, truth } = this, up = this.upright ? 1 : 2;
    let reach = 0, low = Infinity;
    const path = Array.from(t, (_, i) => this.point(truth, i, 0));
    path.forEach((root, i) => {
      for (let p = 0; p < count; p++) {
        const place = this.point(truth, i, p);
        reach = Math.max(reach, Math.hypot(...place.map((v, k) => v - root[k])));
        low = Math.min(low, place[up]);
      }
    });
    Object.assign(this, { reach: reach || 1, low, path });
  }
};
