// Projects metres to the canvas: flat objects as they are, solids without perspective from any side.

class Camera {
  constructor(recording) {
    this.dim3 = recording.dim3;
    const { low, high } = recording.box();
    for (let n = 0; n < recording.outline.length; n++) {
      const axis = n % recording.dim;
      low[axis] = Math.min(low[axis], recording.outline[n]);
      high[axis] = Math.max(high[axis], recording.outline[n]);
    }
    this.middle = low.map((x, axis) => (x + high[axis]) / 2);
    this.sides = low.map((x, axis) => high[axis] - x);
    this.reset();
  }

  reset() {
    this.azimuth = -60 * Math.PI / 180;
    this.elevation = 17 * Math.PI / 180;
    this.zoom = 1;
    this.turn(0, 0);
  }

  turn(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.elevation + elevation));
    const [sa, ca] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    const [se, ce] = [Math.sin(this.elevation), Math.cos(this.elevation)];
    this.right = [-sa, ca, 0];
    this.view = [ce * ca, ce * sa, se];
    this.up = [-se * ca, -se * sa, ce];
  }

  fit({ width, height, plain }) {
    const diagonal = Math.hypot(...this.sides), [border, below] = plain ? [5, 0] : [18, 28];
    const [wide, tall] = this.dim3 ? [diagonal, 0.9 * diagonal] : this.sides;
    this.scale = this.zoom * Math.min((width - 2 * border) / wide, (height - 2 * border - below) / tall);
    this.centre = [width / 2, (height - below) / 2];
  }

  // Returns (points * 3): x and y on the canvas and the height towards the reader, in pixels.
  project(points) {
    const dim = this.dim3 ? 3 : 2, count = points.length / dim, result = new Float64Array(3 * count);
    const { scale, middle, right, up, view, centre } = this;
    for (let n = 0; n < count; n++) {
      const x = points[dim * n] - middle[0], y = points[dim * n + 1] - middle[1];
      const z = this.dim3 ? points[dim * n + 2] - middle[2] : 0;
      const across = this.dim3 ? right[0] * x + right[1] * y : x;
      const along = this.dim3 ? up[0] * x + up[1] * y + up[2] * z : y;
      result[3 * n] = centre[0] + scale * across;
      result[3 * n + 1] = centre[1] - scale * along;
      result[3 * n + 2] = this.dim3 ? scale * (view[0] * x + view[1] * y + view[2] * z) : 0;
    }
    return result;
  }
}
