/* Quaternions (w, x, y, z), rotation matrices as rows, and the camera. */
"use strict";
quatspline.geometry = (() => {
  function multiply([a, b, c, d], [e, f, g, h]) {
    return [a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e];
  }
  const conjugate = ([w, x, y, z]) => [w, -x, -y, -z];
  const dot = (p, q) => p.reduce((sum, v, i) => sum + v * q[i], 0);
  const norm = (v) => Math.hypot(...v);
  const unit = (v) => { const n = norm(v) || 1; return v.map((c) => c / n); };
  const add = (p, q, k = 1) => p.map((v, i) => v + k * q[i]);
  const scaled = (p, k) => p.map((v) => v * k);

  function matrix([w, x, y, z]) {
    return [
      [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
      [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
      [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ];
  }

  /* The quaternion of a rotation matrix, w >= 0; Shepperd's choice of the largest component. */
  function quaternion(m) {
    const trace = m[0][0] + m[1][1] + m[2][2];
    const sizes = [trace, m[0][0], m[1][1], m[2][2]];
    const k = sizes.indexOf(Math.max(...sizes));
    const q = [1 + trace, m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]];
    if (k > 0) {
      const i = k - 1, j = (i + 1) % 3, l = (i + 2) % 3;
      q[0] = m[l][j] - m[j][l];
      q[k] = 1 + 2 * m[i][i] - trace;
      q[j + 1] = m[i][j] + m[j][i];
      q[l + 1] = m[i][l] + m[l][i];
    }
    return scaled(unit(q), q[0] < 0 ? -1 : 1);
  }

  const apply = (m, v) => [dot(m[0], v), dot(m[1], v), dot(m[2], v)];
  const product = (m, n) => m.map((row) => [0, 1, 2].map((j) => row[0] * n[0][j] + row[1] * n[1][j] + row[2] * n[2][j]));

  /* Slerp the short way; between samples the angle is small. */
  function slerp(p, q, u) {
    let c = dot(p, q);
    const end = c < 0 ? scaled(q, -1) : q;
    c = Math.min(Math.abs(c), 1);
    const angle = Math.acos(c);
    if (angle < 1e-6) return unit(add(scaled(p, 1 - u), end, u));
    const s = Math.sin(angle);
    return unit(add(scaled(p, Math.sin((1 - u) * angle) / s), end, Math.sin(u * angle) / s));
  }

  /* exp of half a rotation vector, and its inverse. */
  function exp(v) {
    const a = norm(v), k = a < 1e-9 ? 1 : Math.sin(a) / a;
    return [Math.cos(a), ...scaled(v, k)];
  }
  function log([w, x, y, z]) {
    const n = Math.hypot(x, y, z), a = Math.atan2(n, w);
    return scaled([x, y, z], n < 1e-12 ? 1 : a / n);
  }

  /* Rows: right, up, towards the camera; angles in degrees. */
  function camera(elevation, azimuth) {
    const e = elevation * Math.PI / 180, a = azimuth * Math.PI / 180;
    const right = [-Math.sin(a), Math.cos(a), 0];
    const towards = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
    const up = [towards[1] * right[2] - towards[2] * right[1], towards[2] * right[0] - towards[0] * right[2], towards[0] * right[1] - towards[1] * right[0]];
    return [right, up, towards];
  }

  return { multiply, conjugate, dot, norm, unit, add, scaled, matrix, quaternion, apply, product, slerp, exp, log, camera };
})();
