// The data of a scene's script element, unpacked on demand.

function unpacked(text, kind) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return kind === Uint8Array ? bytes : new kind(bytes.buffer);
}

// Writes a quantity with a prefix to its unit: 0.0123 N is 12.3 mN. The prefix may be chosen for a larger value.
const PREFIXES = [["", 1], ["m", 1e-3], ["µ", 1e-6], ["n", 1e-9], ["p", 1e-12]];
function prefixFor(largest) {
  return PREFIXES.find(([, factor]) => Math.abs(largest) >= factor) || ["", 1];
}
function number(value) {
  return String(value).replace("-", "\u2212");
}
function si(value, unit, largest = value) {
  const [prefix, factor] = prefixFor(largest);
  const scaled = value / factor;
  return `${number(Math.abs(scaled) < 1e-9 ? 0 : Number(scaled.toPrecision(3)))}\u00a0${prefix}${unit}`;
}

// Returns the next smaller one of 1, 2, 5, 10, 20 ...
function roundBelow(value) {
  const decade = 10 ** Math.floor(Math.log10(value));
  return decade * [5, 2, 1].find((digit) => digit * decade <= value);
}

class Recording {
  constructor(packed) {
    Object.assign(this, packed);
    this.dim3 = packed.dim === 3;
    this.count = packed.frames.length;
    this.t = packed.frames.map((frame) => packed.curves.t[frame]);
    this.edges = unpacked(packed.edges, Uint16Array);
    this.faces = unpacked(packed.faces, Uint16Array);
    this.edgeCount = this.edges.length / 2;
    this.lattice = unpacked(packed.x.data, Uint16Array);
    this.offsets = unpacked(packed.apart.data, Int16Array);
    this.levels = {};
    for (const what of ["ratio", "force"])
      for (const run of ["float64", "circuit"])
        this.levels[`${what} ${run}`] = unpacked(packed[what][run].data, Uint8Array);
    this.faceEdges = this.edgesOfFaces();
    // factor for drawing differences: the largest becomes up to a tenth of the object
    this.magnified = this.largest_apart ? Math.max(1, roundBelow(this.size / 10 / this.largest_apart)) : 1;
  }

  edgesOfFaces() {
    const number = new Map();
    for (let e = 0; e < this.edgeCount; e++) number.set(this.edges[2 * e] * 65536 + this.edges[2 * e + 1], e);
    const result = new Uint16Array(this.faces.length);
    for (let f = 0; f < this.faces.length; f += 3)
      for (let side = 0; side < 3; side++) {
        const [p, q] = [this.faces[f + side], this.faces[f + (side + 1) % 3]];
        result[f + side] = number.get(Math.min(p, q) * 65536 + Math.max(p, q));
      }
    return result;
  }

  // Returns (nodes * dim) in m: float64's positions plus `times` the circuit's differences.
  positions(frame, times) {
    const length = this.nodes * this.dim, start = frame * length, result = new Float64Array(length);
    const { low, step } = this.x;
    for (let n = 0; n < length; n++) {
      const axis = n % this.dim;
      result[n] = low[axis] + step[axis] * this.lattice[start + n] + times * this.apart.step * this.offsets[start + n];
    }
    return result;
  }

  // Returns (nodes) in m: the distance of a node between circuit and float64.
  apartOf(frame) {
    const result = new Float64Array(this.nodes), start = frame * this.nodes * this.dim;
    for (let n = 0; n < this.nodes; n++) {
      let square = 0;
      for (let axis = 0; axis < this.dim; axis++) square += this.offsets[start + n * this.dim + axis] ** 2;
      result[n] = Math.sqrt(square) * this.apart.step;
    }
    return result;
  }

  // Returns (edges) from 0 to 1 on the colour scale.
  shades(frame, what, run) {
    const result = new Float64Array(this.edgeCount);
    if (what === "apart") {
      const apart = this.apartOf(frame), full = this.largest_apart || 1;
      for (let e = 0; e < this.edgeCount; e++)
        result[e] = Math.min(1, (apart[this.edges[2 * e]] + apart[this.edges[2 * e + 1]]) / 2 / full);
    } else {
      const levels = this.levels[`${what} ${run}`], start = frame * this.edgeCount;
      for (let e = 0; e < this.edgeCount; e++) result[e] = levels[start + e] / 255;
    }
    return result;
  }

  phase(frame) {
    const found = this.phases.findIndex((phase) => this.t[frame] <= phase.end * (1 + 1e-9));
    return found < 0 ? this.phases.length - 1 : found;
  }

  // Returns the drawn frame that is nearest to a time (s).
  nearest(time) {
    let best = 0;
    for (let n = 1; n < this.count; n++) if (Math.abs(this.t[n] - time) < Math.abs(this.t[best] - time)) best = n;
    return best;
  }

  box() {
    const low = this.x.low, high = low.map((x, axis) => x + this.x.step[axis] * (this.x.step[axis] === 1 ? 0 : 65535));
    return { low, high };
  }
}
