/* A canvas that shows bodies in space: orthographic camera, faces sorted by depth (painter's algorithm). */
"use strict";

/* A canvas at the screen's resolution, turned by dragging or by Shift and the arrows. */
quatspline.View = class {
  static FONT = "12px system-ui, sans-serif";

  constructor(canvas, changed) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    this.changed = changed;
    this.turn = [20, -60];
    this._drag();
    canvas.addEventListener("keydown", (event) => this._key(event));
    const paper = window.matchMedia("print"); /* which shows the picture as it was on the screen */
    new ResizeObserver(() => { if (!paper.matches) { this.resize(); changed(); } }).observe(canvas);
    this.resize();
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    this.canvas.width = Math.round(this.width * ratio);
    this.canvas.height = Math.round(this.height * ratio);
    this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  get axes() { return quatspline.geometry.camera(...this.turn); }

  rotate(right, up) {
    this.turn = [Math.min(Math.max(this.turn[0] + up, -89), 89), this.turn[1] - right];
    this.changed(this);
  }

  _drag() {
    let last = null;
    this.canvas.addEventListener("pointerdown", (event) => { last = [event.clientX, event.clientY]; this.canvas.setPointerCapture(event.pointerId); });
    this.canvas.addEventListener("pointermove", (event) => {
      if (!last) return;
      this.rotate(0.5 * (event.clientX - last[0]), 0.5 * (event.clientY - last[1]));
      last = [event.clientX, event.clientY];
    });
    ["pointerup", "pointercancel"].forEach((kind) => this.canvas.addEventListener(kind, () => { last = null; }));
  }

  _key(event) {
    const by = { ArrowLeft: [-6, 0], ArrowRight: [6, 0], ArrowUp: [0, -6], ArrowDown: [0, 6] }[event.key];
    if (!event.shiftKey || !by) return;
    event.preventDefault();
    event.stopPropagation();
    this.rotate(...by);
  }

  /* -- drawing in canvas coordinates: `at` maps view coordinates to points -- */

  fit(points, margin) {
    const xs = points.map((p) => p[0]), ys = points.map((p) => p[1]);
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const size = Math.min((this.width - 2 * margin) / (right - left || 1), (this.height - 2 * margin) / (high - low || 1));
    this.zoom = Math.max(size, 1e-9);
    this.centre = [(left + right) / 2, (low + high) / 2];
  }

  at([x, y]) {
    return [this.width / 2 + this.zoom * (x - this.centre[0]), this.height / 2 - this.zoom * (y - this.centre[1])];
  }

  clear() { this.pen.clearRect(0, 0, this.width, this.height); }

  /* What stays while time goes on: painted anew only when its state, the camera, the size or the look changed. */
  behind(state, paint) {
    const { canvas } = this, key = [...state, this.turn, this.width, this.height, canvas.width, quatspline.theme.look()].join();
    this.still ??= document.createElement("canvas");
    if (key !== this.painted) {
      this.painted = key;
      Object.assign(this.still, { width: canvas.width, height: canvas.height });
      const own = this.pen;
      this.pen = this.still.getContext("2d");
      this.pen.setTransform(own.getTransform());
      paint();
      this.pen = own;
    }
    if (canvas.width && canvas.height) this.pen.drawImage(this.still, 0, 0, this.width, this.height);
  }

  stroke(points, color, width, dash = []) {
    const { pen } = this;
    pen.beginPath();
    points.forEach((p, i) => (i ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1])));
    Object.assign(pen, { strokeStyle: color, lineWidth: width, lineJoin: "round", lineCap: "round" });
    pen.setLineDash(dash);
    pen.stroke();
    pen.setLineDash([]);
  }

  dot([x, y], radius, fill, edge = null) {
    const { pen } = this;
    pen.beginPath();
    pen.arc(x, y, radius, 0, 2 * Math.PI);
    pen.fillStyle = fill;
    pen.fill();
    if (!edge) return;
    Object.assign(pen, { strokeStyle: edge, lineWidth: 1.5 });
    pen.stroke();
  }

  arrow(from, to, color, width) {
    const along = [to[0] - from[0], to[1] - from[1]], length = Math.hypot(...along);
    if (!(length > 2)) return;
    const [x, y] = along.map((v) => v / length), head = Math.min(9, 0.5 * length);
    this.stroke([from, [to[0] - 0.6 * head * x, to[1] - 0.6 * head * y]], color, width);
    const { pen } = this;
    pen.beginPath();
    pen.moveTo(to[0], to[1]);
    pen.lineTo(to[0] - head * x - 0.45 * head * y, to[1] - head * y + 0.45 * head * x);
    pen.lineTo(to[0] - head * x + 0.45 * head * y, to[1] - head * y - 0.45 * head * x);
    pen.closePath();
    pen.fillStyle = color;
    pen.fill();
  }

  text(label, [x, y], color, align = "left") {
    Object.assign(this.pen, { font: quatspline.View.FONT, fillStyle: color, textAlign: align, textBaseline: "middle" });
    this.pen.fillText(label, x, y);
  }
};

quatspline.Stage = class extends quatspline.View {
  static GHOST = 0.16;
  static MARGIN = 14;
  static NEAR = 1.9; /* extent shown around a body that is followed, in body lengths */

  constructor(canvas, changed) {
    super(canvas, changed);
    this.poses = [];
  }

  /* Draw what moves: [{scheme, q, place, color, spin, arrow}], spin being the world's angular velocity as a share of the largest. */
  draw(motion, movers, follow) {
    const { geometry } = quatspline, axes = this.axes;
    if (follow) this._aim(motion, axes, movers[0].place);
    this.clear();
    this.behind([motion.name, follow && this.centre], () => this._backdrop(motion, axes, follow));
    const posed = movers.map((mover) => ({ ...mover, matrix: geometry.matrix(mover.q) }));
    this._paint(motion, posed, axes, this.pen);
    for (const mover of posed) this._spin(motion, mover, axes);
    /* What stands on the canvas now, read back from the matrices that it was drawn with. */
    this.poses = posed.map(({ scheme, matrix }) => ({ scheme, q: geometry.quaternion(matrix) }));
  }

  _aim(motion, axes, centre) {
    const { apply, add } = quatspline.geometry;
    const reach = 0.56 * motion.scale;
    const around = centre ? [centre] : motion.places;
    const wide = centre ? 0.5 * quatspline.Stage.NEAR * motion.scale : reach;
    const seen = around.map((p) => apply(axes, p));
    this.fit(seen.flatMap((p) => [add(p, [-wide, -wide, 0]), add(p, [wide, wide, 0])]), quatspline.Stage.MARGIN);
  }

  /* The path and pale bodies at the keyframes. */
  _backdrop(motion, axes, follow) {
    const { theme } = quatspline, { pen } = this;
    if (!follow) this._aim(motion, axes, null);
    const { apply, matrix } = quatspline.geometry;
    this.stroke(motion.places.map((p) => this.at(apply(axes, p))), theme.color("muted"), 1);
    pen.globalAlpha = quatspline.Stage.GHOST;
    const count = motion.closed ? motion.knots.length - 1 : motion.knots.length;
    if (count <= 40) {
      const ghosts = motion.knots.slice(0, count).map((t, k) => ({ place: motion.between(motion.places, t), matrix: matrix(motion.keyframes[k]), color: theme.color("muted") }));
      ghosts.forEach((ghost) => this._paint(motion, [ghost], axes, pen));
    }
    pen.globalAlpha = 1;
  }

  _paint(motion, movers, axes, pen) {
    const faces = movers.flatMap((mover) => this._faces(motion, mover, axes));
    faces.sort((p, q) => p.depth - q.depth);
    pen.lineWidth = 0.7;
    pen.lineJoin = "round";
    for (const { corners, color } of faces) {
      pen.beginPath();
      corners.forEach((p, i) => (i ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1])));
      pen.closePath();
      pen.fillStyle = color;
      pen.fill();
      if (pen.globalAlpha === 1) { pen.strokeStyle = color; pen.stroke(); } /* closes the hairlines between faces */
    }
  }

  /* The faces turned to the camera, shaded by Lambert's law with ambient light from above. */
  _faces(motion, { matrix, place, color }, axes) {
    const { apply, product, unit, dot } = quatspline.geometry;
    const { vertices, normals, cells, tint, lift } = motion.body, base = quatspline.Stage.rgb(color);
    const turn = product(axes, matrix), shift = apply(axes, place), light = unit([-0.45, 0.7, 0.55]);
    const seen = vertices.map((v) => apply(turn, v).map((c, k) => motion.scale * c + shift[k]));
    const drawn = seen.map((p) => this.at(p)), faces = [];
    cells.forEach((cell, i) => {
      const n = apply(turn, normals[i]);
      if (n[2] <= 0) return;
      const lit = tint[i] * (0.42 + 0.1 * n[1] + 0.62 * Math.max(0, 0.75 * dot(n, light) + 0.25));
      const depth = (seen[cell[0]][2] + seen[cell[1]][2] + seen[cell[2]][2] + seen[cell[3]][2]) / 4 + motion.scale * lift[i];
      const shade = base.map((c) => Math.round(Math.min(255, c * lit)));
      faces.push({ depth, corners: cell.map((k) => drawn[k]), color: `rgb(${shade})` });
    });
    return faces;
  }

  _spin(motion, { place, spin, arrow }, axes) {
    const { apply, add } = quatspline.geometry;
    if (!spin) return;
    const tip = add(place, spin, 0.95 * motion.scale);
    this.arrow(this.at(apply(axes, place)), this.at(apply(axes, tip)), arrow, 2.2);
  }

  /* "#rrggbb" lightened a little, so that shading has room. */
  static rgb(color) {
    return [1, 3, 5].map((i) => 30 + 1.05 * parseInt(color.slice(i, i + 2), 16));
  }
};
