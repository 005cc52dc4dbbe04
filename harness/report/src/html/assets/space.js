// Geometry of the 3D scene: ellipsoids of covariance matrices, and the eye.

/** Eigenvalues and eigenvectors (as rows) of the symmetric matrix [[a, b, c], [b, d, e], [c, e, f]], by Jacobi's rotations. */
const eigen = ([a, b, c, d, e, f]) => {
  const m = [[a, b, c], [b, d, e], [c, e, f]];
  const v = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let sweep = 0; sweep < 12; sweep += 1) {
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) rotate(m, v, p, q);
  }
  return { values: [m[0][0], m[1][1], m[2][2]], vectors: v };
};

/** Makes element (p, q) nothing. */
const rotate = (m, v, p, q) => {
  if (Math.abs(m[p][q]) <= 1e-300) return;
  const theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const t = (theta < 0 ? -1 : 1) / (Math.abs(theta) + Math.hypot(theta, 1));
  const c = 1 / Math.hypot(t, 1);
  const s = t * c;
  for (let k = 0; k < 3; k += 1) [m[k][p], m[k][q]] = [c * m[k][p] - s * m[k][q], s * m[k][p] + c * m[k][q]];
  for (let k = 0; k < 3; k += 1) {
    [m[p][k], m[q][k]] = [c * m[p][k] - s * m[q][k], s * m[p][k] + c * m[q][k]];
    [v[p][k], v[q][k]] = [c * v[p][k] - s * v[q][k], s * v[p][k] + c * v[q][k]];
  }
};

/** The three half axes of an ellipsoid of `factor` standard deviations, or null. */
const halfAxes = (covariance, factor) => {
  if (!covariance || covariance.length !== 6 || !covariance.every(Number.isFinite)) return null;
  const { values, vectors } = eigen(covariance);
  return vectors.map((vector, index) => vector.map((part) => part * factor * Math.sqrt(Math.max(values[index], 0))));
};

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** From where the scene is seen: it turns about `centre` with Z up. */
class Eye {
  constructor() {
    this.set(-0.9, 0.5, 1, [0, 0, 0]);
    this.resize(1, 1);
  }

  set(yaw, pitch, distance, centre) {
    this.yaw = yaw;
    this.pitch = within(pitch, -Math.PI / 2, Math.PI / 2);
    this.distance = distance;
    this.centre = centre;
    const [sy, cy, sp, cp] = [Math.sin(this.yaw), Math.cos(this.yaw), Math.sin(this.pitch), Math.cos(this.pitch)];
    this.right = [-sy, cy, 0];
    this.up = [-sp * cy, -sp * sy, cp];
    this.back = [cp * cy, cp * sy, sp];
    this.place = centre.map((part, index) => part + distance * this.back[index]);
  }

  resize(width, height) {
    [this.width, this.height] = [width, height];
    this.focal = 1.3 * Math.min(width, height);
  }

  /** Across, up and away from the eye. */
  turn(x, y, z) {
    const from = [x - this.place[0], y - this.place[1], z - this.place[2]];
    return [dot(from, this.right), dot(from, this.up), -dot(from, this.back)];
  }

  screen([across, up, away]) {
    return [this.width / 2 + (this.focal * across) / away, this.height / 2 - (this.focal * up) / away, away];
  }

  near() {
    return this.distance * 0.01;
  }

  /** Place on the canvas and distance; null behind the eye. */
  see(x, y, z) {
    const turned = this.turn(x, y, z);
    return turned[2] < this.near() ? null : this.screen(turned);
  }

  /** Both ends of a line on the canvas, cut where it passes the eye; or null. */
  line(a, b) {
    let [from, to] = [this.turn(...a), this.turn(...b)];
    const near = this.near();
    if (from[2] < near && to[2] < near) return null;
    if (from[2] > to[2]) [from, to] = [to, from];
    if (from[2] < near) {
      const t = (near - from[2]) / (to[2] - from[2]);
      from = from.map((part, index) => part + t * (to[index] - part));
    }
    return [this.screen(from), this.screen(to)];
  }

  pan(dx, dy) {
    const unit = this.distance / this.focal;
    this.set(this.yaw, this.pitch, this.distance, this.centre.map((part, index) => part - dx * unit * this.right[index] + dy * unit * this.up[index]));
  }
}
