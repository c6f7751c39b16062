/* Five schemes through open keyframes, as the package computes them: each fit gives segments, functions of u that return
   the orientation as a quaternion of jets. Logarithms are half rotation vectors. */
"use strict";
quatspline.curves = (() => {
  const { geometry: g, jets } = quatspline;
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const zero = [0, 0, 0], range = (n) => Array.from({ length: n }, (_, i) => i);
  const OPPOSITE = 1e-12; /* nearer to a half turn of the logarithm, its direction is none */

  function log([w, ...v]) {
    const length = g.norm(v);
    if (length < 1e-300) return w < 0 ? [Math.PI, 0, 0] : g.scaled(v, 1 / w);
    return g.scaled(v, Math.atan2(length, w) / length);
  }
  function exp(v) {
    const a = g.norm(v);
    return [Math.cos(a), ...g.scaled(v, a < 1e-8 ? 1 : Math.sin(a) / a)];
  }
  const between = (p, q) => log(g.multiply(g.conjugate(p), q));

  /* -- segments -- */

  /* f0 at 0 and f0 + rise at 1 to the last digit: f0 + rise u + u (1 - u) (g0 + ... + g3 u^3). */
  function hermite(f0, d0, c0, f1, d1, c1) {
    const rise = f1 - f0, g0 = d0 - rise, end = rise - d1;
    const g1 = g0 + 0.5 * c0, slope = -end - 0.5 * c1;
    return [f0, rise, g0, g1, 3 * (end - g0) - 2 * g1 - slope, 2 * (g0 - end) + g1 + slope];
  }
  function polynomial([f0, rise, ...bend], u) {
    const t = [u, 1, 0], bump = [u - u * u, 1 - 2 * u, -2];
    return jets.add(jets.product(bump, jets.series(bend, u)), jets.add(jets.times(rise, t), jets.constant(f0)));
  }

  /* -- what schemes take of the keyframes -- */

  function slerpFit(q) {
    return range(q.length - 1).map((i) => {
      const step = between(q[i], q[i + 1]), base = jets.fixed(q[i]);
      return (u) => jets.multiply(base, jets.exp(step.map((x) => [x * u, x, 0])));
    });
  }

  /* Four keyframes, kappa = 3: products of exponentials about fixed axes. */
  function quarticFit(q, h) {
    const steps = [zero, ...range(q.length - 1).map((i) => between(q[i], q[i + 1])), zero];
    const k = 6, spacing = (i) => h[Math.min(Math.max(i, 0), h.length - 1)];
    return range(h.length).map((i) => {
      const h0 = spacing(i - 1), h1 = h[i], h2 = spacing(i + 1), left = h1 / (h0 + h1), right = h1 / (h1 + h2);
      const parts = [
        hermite(0, left * h1 / h0, -k * left * h1 / h0, 0, 0, 0),
        hermite(0, left * h0 / h1, k * left, 1, right * h2 / h1, -k * right),
        hermite(0, 0, 0, 0, right * h1 / h2, k * right * h1 / h2),
      ];
      const base = jets.fixed(q[i]);
      return (u) => parts.reduce((point, part, j) => {
        const f = polynomial(part, u);
        return jets.multiply(point, jets.exp(steps[i + j].map((x) => jets.times(x, f))));
      }, base);
    });
  }

  /* -- squad, with inner points for uneven times -- */

  function lifted(x, expected) {
    const r = g.norm(x);
    if (Math.abs(r - Math.PI) < OPPOSITE) return g.scaled(expected, Math.PI / (g.norm(expected) || Infinity));
    const other = g.scaled(x, r > 0 ? 1 - 2 * Math.PI / r : 1);
    return g.norm(g.add(other, expected, -1)) < g.norm(g.add(x, expected, -1)) ? other : x;
  }

  /* The slope at keyframe i of the parabola through three keyframes, in the chart there. */
  function chartVelocity(q, h, i) {
    const n = q.length, m = Math.min(3, n), first = Math.min(Math.max(i - 1, 0), n - m), points = new Map([[i, { x: zero, t: 0 }]]);
    const walk = (way, stop) => {
      for (let j = i; j !== stop; j += way) {
        const expected = g.add(points.get(j).x, between(q[j], q[j + way]));
        const t = points.get(j).t + way * h[way > 0 ? j : j - 1];
        points.set(j + way, { x: lifted(between(q[i], q[j + way]), expected), t });
      }
    };
    walk(1, first + m - 1);
    walk(-1, first);
    let v = zero;
    for (const [j, { x, t }] of points) {
      if (j === i) continue;
      let slope = 1 / t;
      for (const [k, other] of points) if (k !== i && k !== j) slope *= other.t / (other.t - t);
      v = g.add(v, x, slope);
    }
    return v;
  }

  function squadFit(q, h) {
    const v = range(q.length).map((i) => chartVelocity(q, h, i));
    return range(h.length).map((i) => {
      const p = q[i], r = q[i + 1], step = between(p, r);
      const a = g.multiply(p, exp(g.scaled(g.add(g.scaled(v[i], h[i]), step, -1), 0.5)));
      const b = g.multiply(r, exp(g.scaled(g.add(step, v[i + 1], -h[i]), 0.5)));
      const arc = (from, by, u) => jets.multiply(jets.fixed(from), jets.exp(by.map((x) => [x * u, x, 0])));
      const inner = between(a, b);
      return (u) => jets.slerp(arc(p, step, u), arc(a, inner, u), [2 * u * (1 - u), 2 - 4 * u, -4]);
    });
  }

  /* -- the local quintics: rates of a local cubic spline at every keyframe, joined by quintic rotation vectors -- */

  const WINDOW = 3, START = 2 * Math.PI / 3, STOP = 17 * Math.PI / 18; /* half angles: 240 and 340 degrees */

  /* One side of a spline through k keyframes, as a relation v = r - p a. */
  function half(point, gap, k, natural) {
    let e = 0, f = zero, outer = gap(k - 1), beyond = point(k);
    for (let j = k - 1; j > 0; j--) {
      const inner = gap(j - 1), x = point(j), before = j > 1 ? point(j - 1) : zero;
      let below = inner;
      if (j === k - 1 && !natural) { /* not-a-knot */
        const ratio = outer / inner;
        e = 1 + ratio;
        below -= ratio * outer;
      }
      const pivot = 1 / (2 * (inner + outer) + outer * e);
      const rise = g.scaled(g.add(beyond, x, -1), 6 / outer), fall = g.scaled(g.add(x, before, -1), 6 / inner);
      f = g.scaled(g.add(g.add(rise, fall, -1), f, -outer), pivot);
      e = -below * pivot;
      outer = inner;
      beyond = x;
    }
    return { p: (outer / 6) * (2 + e), r: g.add(g.scaled(beyond, 1 / outer), f, -outer / 6) };
  }

  function windowRates(chords, h, i, k) {
    const left = i, right = h.length - i, before = Math.min(k, left), after = Math.min(k, right);
    const ahead = after && half((j) => chords[j - 1][i], (j) => h[i + j], after, k >= right || after < 2);
    const behind = before && half((j) => g.scaled(chords[j - 1][i - j], -1), (j) => h[i - 1 - j], before, k >= left || before < 2);
    if (!before || !after) return { v: before ? g.scaled(behind.r, -1) : ahead.r, a: zero };
    const f = 1 / (ahead.p + behind.p);
    return { v: g.scaled(g.add(g.scaled(ahead.r, behind.p), behind.r, -ahead.p), f), a: g.scaled(g.add(ahead.r, behind.r), f) };
  }

  /* A bound of the half angle from keyframe i to any point on the arcs joining its window. */
  function turned(chords, h, i, k) {
    let bound = 0;
    const side = (count, far, link) => {
      let near = 0;
      for (let j = 0; j < count; j++) {
        bound = Math.max(bound, near + g.norm(far(j)) + g.norm(link(j)));
        near = g.norm(far(j));
      }
    };
    side(Math.min(k, h.length - i), (j) => chords[j][i], (j) => chords[0][i + j]);
    side(Math.min(k, i), (j) => chords[j][i - 1 - j], (j) => chords[0][i - 1 - j]);
    return 0.5 * bound;
  }

  /* Nested windows, each with its share of what wider ones leave where their charts would fold. */
  function localRates(chords, h, i) {
    let left = 1, v = zero, a = zero;
    for (let k = WINDOW; k > 0 && left > 0; k--) {
      let passed = 0;
      if (k > 1) {
        const xi = Math.min(Math.max((turned(chords, h, i, k) - START) / (STOP - START), 0), 1);
        passed = xi * xi * xi * (10 - xi * (15 - 6 * xi));
      }
      if (passed < 1) {
        const own = windowRates(chords, h, i, k), share = left * (1 - passed);
        v = g.add(v, own.v, share);
        a = g.add(a, own.a, share);
      }
      left *= passed;
    }
    return { v, a };
  }

  /* Coefficients of the right Jacobian, a and b with twice their derivatives by z, and k of its inverse: series below 1. */
  const factorial = (n) => (n < 2 ? 1 : n * factorial(n - 1)), TERMS = range(18);
  const A = TERMS.map((n) => (-1) ** n * 4 ** (n + 1) / (2 * factorial(2 * n + 2)));
  const B = TERMS.map((n) => (-1) ** n * 4 ** (n + 1) / factorial(2 * n + 3));
  const K = TERMS.map((n) => (-1) ** n * (2 * n + 2) / factorial(2 * n + 3));
  function coefficients(z) {
    if (z < 1) {
      const [a, a1] = jets.series(A, z), [b, b1] = jets.series(B, z);
      return { a, b, a1: 2 * a1, b1: 2 * b1 };
    }
    const r = Math.sqrt(z), s = Math.sin(r) / r, c = Math.cos(r), b = (1 - s * c) / z, e = (c - s) / z;
    return { a: s * s, b, a1: 2 * s * e, b1: (s * s - e * c - 2 * b) / z };
  }
  function inverseCoefficient(z) {
    const r = Math.sqrt(z);
    return z < 1 ? jets.series(K, z)[0] * (r > 0 ? r / Math.sin(r) : 1) : (1 - r * Math.cos(r) / Math.sin(r)) / z;
  }
  function inverseJacobian(v, w) {
    const t = cross(v, w);
    return g.add(g.add(w, t), cross(v, t), inverseCoefficient(g.dot(v, v)));
  }
  function bent(phi, d) { /* half the acceleration where phi'' = 0 */
    const { a1, b, b1 } = coefficients(g.dot(phi, phi)), t = cross(phi, d), k = g.dot(phi, d);
    return g.add(g.add(g.scaled(cross(d, t), b), t, -k * a1), cross(phi, t), k * b1);
  }

  function joined(q, h, limit) {
    const chords = range(WINDOW).map((k) => range(Math.max(q.length - k - 1, 0)).map((i) => between(q[i], q[i + k + 1])));
    const rates = range(q.length).map((i) => limit(localRates(chords, h, i), chords[0], h, i));
    return range(h.length).map((i) => {
      const step = chords[0][i], s = h[i], [p, r] = [rates[i], rates[i + 1]];
      const d = inverseJacobian(step, g.scaled(r.v, s)), e = inverseJacobian(step, g.add(g.scaled(r.a, s * s), bent(step, d), -1));
      const parts = step.map((x, k) => hermite(0, s * p.v[k], s * s * p.a[k], x, d[k], e[k])), base = jets.fixed(q[i]);
      return (u) => jets.multiply(base, jets.exp(parts.map((part) => polynomial(part, u))));
    });
  }

  /* -- limits under which no step about one axis is overshot -- */

  const shortened = (x, most) => (g.norm(x) > most ? g.scaled(x, most / g.norm(x)) : x);
  const ahead = (v, d) => g.add(v, d, -Math.min(g.dot(v, d), 0));
  const clamped = (a, d, low, high) => g.add(a, d, Math.min(Math.max(g.dot(a, d), low), high) - g.dot(a, d));
  const mean = (a, b) => g.scaled(g.add(a, b), 0.5);
  const unit = (v) => (g.norm(v) > 0 ? g.scaled(v, 1 / g.norm(v)) : v);
  function interval(v, l) { /* of h a after a keyframe; the slack is 0 */
    const low = -4 * v;
    return [low, Math.max(4 * (2.5 * l - 2 * v), low)];
  }
  function monotone({ v, a }, steps, h, i) {
    const b = Math.max(i - 1, 0), c = Math.min(i, h.length - 1), [h0, h1] = [h[b], h[c]];
    const s0 = g.scaled(steps[b], 1 / h0), s1 = g.scaled(steps[c], 1 / h1), [n, p, l0, l1] = [unit(s0), unit(s1), g.norm(s0), g.norm(s1)];
    let w = mean(ahead(ahead(v, n), p), ahead(ahead(v, p), n));
    w = shortened(w, Math.min(1.25 * (h0 * l1 + h1 * l0) / (h0 + h1), 2.5 * Math.min(l0, l1)));
    const e = shortened(a, 10 * Math.min(l0 / h0, l1 / h1));
    const [n0, n1] = interval(Math.max(g.dot(w, n), 0), l0), [p0, p1] = interval(Math.max(g.dot(w, p), 0), l1);
    const one = clamped(clamped(e, n, -n1 / h0, -n0 / h0), p, p0 / h1, p1 / h1);
    const other = clamped(clamped(e, p, p0 / h1, p1 / h1), n, -n1 / h0, -n0 / h0);
    return { v: w, a: mean(one, other) };
  }

  const SCHEMES = {
    "slerp": slerpFit,
    "squad": squadFit,
    "quartic": quarticFit,
    "local-quintic": (q, h) => joined(q, h, (rates) => rates),
    "monotone-quintic": (q, h) => joined(q, h, monotone),
  };

  /* -- curves -- */

  const FLIP = -4 * Number.EPSILON;
  function aligned(quaternions) {
    const all = [];
    for (const q of quaternions.map(g.unit)) all.push(all.length && g.dot(q, all[all.length - 1]) < FLIP ? g.scaled(q, -1) : q);
    return all;
  }

  /* A curve through keyframes: q, omega and alpha (body rates) at a time. */
  function build(scheme, times, quaternions) {
    const knots = times.map((t) => t - times[0]), h = range(times.length - 1).map((i) => knots[i + 1] - knots[i]);
    const segments = SCHEMES[scheme](aligned(quaternions), h);
    /* `side` -1 reads a keyframe from the segment that ends there. */
    return (t, side = 1) => {
      const since = t - times[0];
      let k = 0;
      while (k < h.length - 1 && (side > 0 ? knots[k + 1] <= since : knots[k + 1] < since)) k++;
      const point = segments[k]((since - knots[k]) / h[k]);
      const [q, d, e] = [0, 1, 2].map((order) => point.map((c) => c[order])), back = g.conjugate(g.unit(q));
      const rate = (x, power) => g.scaled(g.multiply(back, x).slice(1), 2 / h[k] ** power);
      return { q, omega: rate(d, 1), alpha: rate(e, 2) };
    };
  }

  return { SCHEMES: Object.keys(SCHEMES), build, aligned, between };
})();
