// One process that evaluates curves of JavaScript libraries for Python, all samples of a curve at once.
//
// A request: four bytes, the length of the JSON that follows as an unsigned integer, least byte first; the JSON,
// {"call", "keyframes": [rows, columns], "samples": [rows, columns]}; both tables as float64, row by row.
// Columns of keyframes are time, x, y, z, w, and what the call needs besides; of samples time, segment, and
// share of the segment.  The answer is a line of JSON, {} or {"error"}, and without an error x, y, z, w of
// every sample.

import { readSync, writeSync } from 'node:fs';

const CALLS = {
  async 'three slerp'() {
    const { QuaternionLinearInterpolant } = await import('three');
    return (keyframes, samples, out) => {
      const [times, values] = [keyframes.column(0), keyframes.columns(1, 5)];
      const curve = new QuaternionLinearInterpolant(times, values, 4, new Float64Array(4));
      for (let k = 0; k < samples.rows; k++) out.set(curve.evaluate(samples.at(k, 0)), 4 * k);
    };
  },

  async 'gl-matrix slerp'() {
    const quat = await doubles();
    return (keyframes, samples, out) => {
      const q = keyframes.list(1, 5), result = quat.create();
      for (let k = 0; k < samples.rows; k++) {
        const i = samples.at(k, 1);
        out.set(quat.slerp(result, q[i], q[i + 1], samples.at(k, 2)), 4 * k);
      }
    };
  },

  async 'gl-matrix sqlerp'() {
    const quat = await doubles();
    return (keyframes, samples, out) => {
      const q = keyframes.list(1, 5), after = keyframes.list(5, 9), before = keyframes.list(9, 13);
      const result = quat.create();
      for (let k = 0; k < samples.rows; k++) {
        const i = samples.at(k, 1);
        quat.sqlerp(result, q[i], after[i], before[i + 1], q[i + 1], samples.at(k, 2));
        out.set(result, 4 * k);
      }
    };
  },

  async 'babylon animation'() {
    const { Quaternion } = await import('@babylonjs/core/Maths/math.vector.js');
    const { Animation } = await import('@babylonjs/core/Animations/animation.js');
    const kind = Animation.ANIMATIONTYPE_QUATERNION;
    return (keyframes, samples, out) => {
      const value = (row) => new Quaternion(...row);
      const tangents = keyframes.width > 5 ? keyframes.list(5, 9).map(value) : null;
      const key = (row, i) => ({
        frame: keyframes.at(i, 0), value: value(row),
        ...(tangents && { inTangent: tangents[i], outTangent: tangents[i] }),
      });
      const animation = new Animation('curve', 'rotationQuaternion', 1, kind);
      animation.setKeys(keyframes.list(1, 5).map(key));
      for (let k = 0; k < samples.rows; k++) {
        const q = animation.evaluate(samples.at(k, 0));
        out.set([q.x, q.y, q.z, q.w], 4 * k);
      }
    };
  },
};

async function doubles() {
  // Single precision is its default; what sqlerp keeps between calls is made as the library is imported.
  const { default: common } = await import('gl-matrix/cjs/common.js');
  common.setMatrixArrayType(Float64Array);
  return (await import('gl-matrix')).quat;
}

class Table {
  constructor([rows, width], bytes) {
    Object.assign(this, { rows, width, data: new Float64Array(bytes.buffer) });
  }

  at(row, column) {
    return this.data[row * this.width + column];
  }

  list(first, end) {
    const row = (_, i) => this.data.slice(i * this.width + first, i * this.width + end);
    return Array.from({ length: this.rows }, row);
  }

  column(index) {
    return Float64Array.from({ length: this.rows }, (_, i) => this.at(i, index));
  }

  columns(first, end) {
    return Float64Array.from(this.list(first, end).flatMap((row) => Array.from(row)));
  }
}

// -- pipes, read and written synchronously: a request is answered before the next is looked at ----

function read(count) {
  const bytes = Buffer.from(new ArrayBuffer(count));
  for (let have = 0, got; have < count; have += got) {
    got = readSync(0, bytes, have, count - have, null);
    if (got === 0) process.exit(0); // the other side has closed
  }
  return bytes;
}

function write(bytes) {
  for (let done = 0; done < bytes.length; ) done += writeSync(1, bytes, done);
}

const ready = {};

for (;;) {
  const request = JSON.parse(read(read(4).readUInt32LE()).toString('utf8'));
  const table = (shape) => new Table(shape, read(8 * shape[0] * shape[1]));
  const keyframes = table(request.keyframes), samples = table(request.samples);
  try {
    const evaluate = (ready[request.call] ??= await CALLS[request.call]());
    const out = new Float64Array(4 * samples.rows);
    evaluate(keyframes, samples, out);
    write(Buffer.from('{}\n'));
    write(Buffer.from(out.buffer));
  } catch (error) {
    write(Buffer.from(`${JSON.stringify({ error: String(error.message) })}\n`));
  }
}
