/* Numbers with their first two derivatives by u: what a curve is made of here, so that its rates need no formulas of their own. */
"use strict";
quatspline.jets = (() => {
  const constant = (v) => [v, 0, 0];
  const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const times = (k, a) => [k * a[0], k * a[1], k * a[2]];
  const product = (a, b) => [a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[0] * b[2] + 2 * a[1] * b[1] + a[2] * b[0]];

  /* A function of a jet, from its value and derivatives there. */
  const composed = ([, x1, x2], [f, f1, f2]) => [f, f1 * x1, f2 * x1 * x1 + f1 * x2];

  function quotient(a, b) {
    const r = 1 / b[0];
    return product(a, composed(b, [r, -r * r, 2 * r * r * r]));
  }

  /* Quaternions and vectors of jets. */
  function multiply([a, b, c, d], [e, f, g, h]) {
    const sum = (p, q, r, s, signs) => add(add(product(...p), times(signs[0], product(...q))), add(times(signs[1], product(...r)), times(signs[2], product(...s))));
    return [
      sum([a, e], [b, f], [c, g], [d, h], [-1, -1, -1]),
      sum([a, f], [b, e], [c, h], [d, g], [1, 1, -1]),
      sum([a, g], [b, h], [c, e], [d, f], [-1, 1, 1]),
      sum([a, h], [b, g], [c, f], [d, e], [1, -1, 1]),
    ];
  }
  const sum = (p, q) => p.map((a, k) => add(a, q[k]));
  const scaled = (f, p) => p.map((a) => product(f, a));
  const inner = (p, q) => p.map((a, k) => product(a, q[k])).reduce(add);
  const fixed = (p) => p.map(constant);

  /* sum of c_n z^n with its first two derivatives. */
  function series(coefficients, z) {
    let f = 0, f1 = 0, f2 = 0;
    for (let n = coefficients.length - 1; n >= 0; n--) {
      f2 = f2 * z + 2 * f1;
      f1 = f1 * z + f;
      f = f * z + coefficients[n];
    }
    return [f, f1, f2];
  }

  /* Entire functions of z = r^2; below NEAR by their series, which does not cancel. */
  const NEAR = 1, TERMS = 14;
  const factorial = (n) => (n < 2 ? 1 : n * factorial(n - 1));
  const SINC = Array.from({ length: TERMS }, (_, n) => (-1) ** n / factorial(2 * n + 1));
  const COSINE = Array.from({ length: TERMS }, (_, n) => (-1) ** n / factorial(2 * n));

  /* sin(r)/r: beyond NEAR its derivatives by 2 z f' = cos r - f and 4 z f'' = -6 f' - f. */
  function sinc(z) {
    if (z < NEAR) return series(SINC, z);
    const r = Math.sqrt(z), f = Math.sin(r) / r, f1 = (Math.cos(r) - f) / (2 * z);
    return [f, f1, -(6 * f1 + f) / (4 * z)];
  }

  /* cos r, whose derivative by z is -sinc/2. */
  function cosine(z) {
    if (z < NEAR) return series(COSINE, z);
    const [s, s1] = sinc(z);
    return [Math.cos(Math.sqrt(z)), -s / 2, -s1 / 2];
  }

  /* exp of a vector of jets. */
  function exp(v) {
    const z = inner(v, v);
    return [composed(z, cosine(z[0])), ...scaled(composed(z, sinc(z[0])), v)];
  }

  /* The point at v on the great arc from p to q, all jets: sin(w theta)/sin(theta) = w sinc(w^2 z)/sinc(z), z = theta^2. */
  function slerp(p, q, v) {
    const apart = p.map((a, k) => minus(a, q[k])), e = inner(apart, apart);
    const together = Math.hypot(...p.map((a, k) => a[0] + q[k][0]));
    const theta = 4 * Math.atan2(Math.sqrt(e[0]), together + 2);
    const [s, s1] = sinc(theta * theta); /* de/dz, for e = 2 (1 - cos theta) */
    const z = composed(e, [theta * theta, 1 / s, -s1 / (s * s * s)]);
    const whole = composed(z, sinc(z[0]));
    const weight = (w) => {
      const x = product(product(w, w), z);
      return quotient(product(w, composed(x, sinc(x[0]))), whole);
    };
    return sum(scaled(weight(minus(constant(1), v)), p), scaled(weight(v), q));
  }

  return { constant, add, minus, times, product, composed, multiply, sum, scaled, inner, fixed, series, exp, slerp };
})();
