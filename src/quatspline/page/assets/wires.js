/* Canvases for recorded motion: figures of joints and lines, and what one joint does, seen from near. */
"use strict";

/* A view of motions whose second axis (of skeletons) or third (of bodies) points up. */
quatspline.WireView = class extends quatspline.View {
  static GHOST = { width: 11, alpha: 0.6 };

  get axes() {
    const camera = quatspline.geometry.camera(...this.turn);
    return this.motion.upright ? camera.map(([x, y, z]) => [y, z, x]) : camera;
  }

  _at(p) { return this.at(quatspline.geometry.apply(this.seen, p)); }

  /* A figure as one path of all its lines. */
  _figure(points, lines, { color, width, dash = [], alpha = 1 }) {
    const { pen } = this, drawn = points.map((p) => this._at(p));
    pen.beginPath();
    for (const [from, to] of lines) {
      pen.moveTo(drawn[from][0], drawn[from][1]);
      pen.lineTo(drawn[to][0], drawn[to][1]);
    }
    Object.assign(pen, { strokeStyle: color, lineWidth: width, lineJoin: "round", lineCap: "round", globalAlpha: alpha });
    pen.setLineDash(dash);
    pen.stroke();
    pen.setLineDash([]);
    pen.globalAlpha = 1;
  }

  _ghost(points, lines) {
    const { width, alpha } = quatspline.WireView.GHOST;
    this._figure(points, lines, { color: quatspline.theme.color("ghost"), width, alpha });
  }
};

/* The whole figure; its ground, where it stands on one; and the way of the point that a joint moves. */
quatspline.FigureView = class extends quatspline.WireView {
  static MARGIN = 22;
  static TILE = 0.5; /* of the ground, as a share of the figure's reach */
  static TRAIL = 1; /* seconds of the way of a skeleton's point, on either side; a body shows all of it */

  draw(motion, { truth, sides, joint, time, follow }) {
    this.motion = motion;
    this.seen = this.axes;
    const { theme } = quatspline;
    this._aim(motion, follow ? truth[0] : null);
    this.clear();
    if (motion.upright) this._ground(motion, theme.color("line"));
    this.stroke(this._trail(motion, joint, time), theme.color("muted"), 1);
    this._ghost(truth, motion.lines);
    for (const { points, color, width, dash } of sides) this._figure(points, motion.lines, { color, width, dash });
    const marked = this._at(truth[motion.tips[joint]]);
    this.pen.beginPath();
    this.pen.arc(marked[0], marked[1], 13, 0, 2 * Math.PI);
    Object.assign(this.pen, { strokeStyle: theme.color("text"), lineWidth: 1.3 });
    this.pen.stroke();
  }

  /* What the picture holds: the figure where it is, or all of its way. */
  _aim(motion, root) {
    const { apply, add } = quatspline.geometry, { reach } = motion;
    const around = root ? [root] : motion.path;
    const seen = around.map((p) => apply(this.seen, p));
    this.fit(seen.flatMap((p) => [add(p, [-reach, -reach, 0]), add(p, [reach, reach, 0])]), quatspline.FigureView.MARGIN);
  }

  _trail(motion, joint, time) {
    const reach = motion.upright ? quatspline.FigureView.TRAIL : motion.span;
    const from = motion.locate(time - reach).i, to = motion.locate(time + reach).i;
    return Array.from({ length: to - from + 1 }, (_, i) => this._at(motion.point(motion.truth, from + i, motion.tips[joint])));
  }

  /* Squares under the whole way. */
  _ground(motion, color) {
    const side = quatspline.FigureView.TILE * motion.reach, { low, path, reach } = motion;
    const [x, z] = [0, 2].map((k) => {
      const along = path.map((p) => p[k]);
      return [Math.floor((Math.min(...along) - reach) / side), Math.ceil((Math.max(...along) + reach) / side)];
    });
    const line = (a, b) => this.stroke([this._at(a), this._at(b)], color, 1);
    for (let i = x[0]; i <= x[1]; i++) line([i * side, low, z[0] * side], [i * side, low, z[1] * side]);
    for (let i = z[0]; i <= z[1]; i++) line([x[0] * side, low, i * side], [x[1] * side, low, i * side]);
  }
};

/* The point that a joint moves, from near: its way in truth and as schemes rebuild it, with the keyframes. */
quatspline.NearView = class extends quatspline.WireView {
  static WIDE = 7; /* half the picture, as a multiple of the larger rms distance ... */
  static MOST = 0.35; /* ... and at most this share of the figure's reach */
  static SPACINGS = 3; /* of keyframes, for which the way is shown on either side */

  draw(motion, { truth, sides, joint, time }) {
    this.motion = motion;
    this.seen = this.axes;
    const { theme } = quatspline, tip = motion.tips[joint], from = motion.bases[joint];
    this._aim(motion, truth[tip], sides, tip);
    this.clear();
    const frames = this._frames(motion, time), way = (places) => frames.map((i) => this._at(motion.point(places, i, tip)));
    this.pen.globalAlpha = quatspline.WireView.GHOST.alpha;
    this.stroke(way(motion.truth), theme.color("ghost"), 0.9 * quatspline.WireView.GHOST.width);
    this.pen.globalAlpha = 1;
    if (tip !== from) this._ghost(truth, [[from, tip]]);
    for (const { curve, points, color, width, dash } of sides) {
      this.stroke(way(curve.places), color, width, dash);
      if (tip !== from) this._figure(points, [[from, tip]], { color, width: 0.5 * width, dash });
    }
    this._keyframes(motion, frames, tip, theme);
    for (const { points, color, width } of sides) this.dot(this._at(points[tip]), 2.8 + width, color, theme.color("raised"));
    this._scale(motion, theme.color("muted"));
  }

  _aim(motion, centre, sides, tip) {
    const { WIDE, MOST } = quatspline.NearView, most = MOST * motion.reach;
    const far = Math.max(...sides.map(({ curve }) => motion.distance(curve, tip).rms));
    const half = Math.min(WIDE * far || most, most), [x, y] = quatspline.geometry.apply(this.seen, centre);
    this.fit([[x - half, y - half], [x + half, y + half]], 0);
  }

  /* Frames around a time, whole ones. */
  _frames(motion, time) {
    const reach = quatspline.NearView.SPACINGS * motion.span / Math.max(motion.knots.length - 1, 1);
    const from = motion.locate(time - reach).i, to = motion.locate(time + reach).next;
    return Array.from({ length: to - from + 1 }, (_, i) => from + i);
  }

  _keyframes(motion, frames, tip, theme) {
    for (const i of frames) {
      if (motion.isKey[i]) this.dot(this._at(motion.point(motion.truth, i, tip)), 4, theme.color("ground"), theme.color("text"));
    }
  }

  /* A bar of a round length. */
  _scale(motion, color) {
    const size = quatspline.NearView.round(0.3 * this.width / this.zoom), y = this.height - 16;
    const bar = [[14, y], [14 + size * this.zoom, y]];
    this.stroke(bar, color, 2);
    Object.assign(this.pen, { font: quatspline.View.FONT, strokeStyle: quatspline.theme.color("raised"), lineWidth: 4 });
    this.pen.textBaseline = "middle";
    this.pen.strokeText(motion.length(size), bar[1][0] + 8, y); /* the label stands clear of lines */
    this.text(motion.length(size), [bar[1][0] + 8, y], color);
  }

  /* The largest of 1, 2, 5 times a power of ten that is not larger. */
  static round(size) {
    const power = 10 ** Math.floor(Math.log10(size));
    return power * [5, 2, 1].find((k) => k * power <= size);
  }
};
