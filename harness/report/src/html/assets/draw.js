// What is drawn on the canvas of a 3D scene.

const MANY_ELLIPSOIDS = 2000;

const COLOURS = { ink: "--ink", soft: "--soft", line: "--line", paper: "--paper", point: "--s1", control: "--s2", station: "--s0", ray: "--s4" };

const coloursNow = () => {
  const style = getComputedStyle(document.documentElement);
  return Object.fromEntries(Object.entries(COLOURS).map(([name, variable]) => [name, style.getPropertyValue(variable).trim() || "#888"]));
};

class Painter {
  constructor(canvas, data, eye) {
    [this.canvas, this.data, this.eye] = [canvas, data, eye];
    this.context = canvas.getContext("2d");
    this.axes = data.points.place.map((_, index) => halfAxes(data.points.C && data.points.C[index], data.factor));
    this.corners = data.stations.place.map((_, index) => this.frustum(index));
    const rank = new Map();
    data.rays.forEach(([station, point], index) => {
      for (const key of [`s${station}`, `p${point}`]) gather(rank, key, index);
    });
    this.raysOf = (kind, index) => rank.get(kind + index) || [];
  }

  /** The corners of a station's picture, in space. */
  frustum(index) {
    const { place, R, half } = this.data.stations;
    const [m, [across, up]] = [R[index], half[index]];
    const size = this.data.frustum / Math.hypot(1, across, up);
    return [[-1, 1], [1, 1], [1, -1], [-1, -1], [0, 1.35]].map(([i, j]) => {
      const v = [i * across * size, j * up * size, -size];
      return [0, 1, 2].map((k) => place[index][k] + m[k] * v[0] + m[k + 3] * v[1] + m[k + 6] * v[2]);
    });
  }

  /** `shown`: {kind, index} of what is under the pointer and of what is chosen; `g`: the chosen group. */
  paint(shown, g) {
    const { context, canvas, eye } = this;
    const ratio = canvas.width / eye.width;
    this.colours = coloursNow();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = this.colours.paper;
    context.fillRect(0, 0, eye.width, eye.height);
    context.lineJoin = "round";
    this.floor();
    shown.forEach((item) => this.rays(item));
    this.ellipsoids(shown);
    this.points(shown);
    this.stations(shown, g);
    this.triad();
    this.note();
  }

  path(lines, colour, width, alpha = 1) {
    const { context } = this;
    context.globalAlpha = alpha;
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    for (const [a, b] of lines) {
      const seen = this.eye.line(a, b);
      if (!seen) continue;
      context.moveTo(seen[0][0], seen[0][1]);
      context.lineTo(seen[1][0], seen[1][1]);
    }
    context.stroke();
    context.globalAlpha = 1;
  }

  /** A grid below everything, which gives depth and a measure. */
  floor() {
    const { low, high, step } = this.data.grid;
    const lines = [];
    for (let x = low[0]; x <= high[0] + step / 2; x += step) lines.push([[x, low[1], low[2]], [x, high[1], low[2]]]);
    for (let y = low[1]; y <= high[1] + step / 2; y += step) lines.push([[low[0], y, low[2]], [high[0], y, low[2]]]);
    this.path(lines, this.colours.line, 1);
  }

  rays({ kind, index }) {
    const { rays, stations, points } = this.data;
    const own = this.raysOf(kind[0], index).map((ray) => [stations.place[rays[ray][0]], points.place[rays[ray][1]]]);
    this.path(own, this.colours.ray, 1, own.length > 200 ? 0.35 : 0.75);
  }

  ellipsoids(shown) {
    const { points } = this.data;
    const many = points.place.length >= MANY_ELLIPSOIDS;
    const indices = many ? shown.filter(({ kind }) => kind === "point").map(({ index }) => index) : points.place.map((_, index) => index);
    const { context } = this;
    context.strokeStyle = this.colours.point;
    context.lineWidth = 1;
    context.globalAlpha = 0.7;
    context.beginPath();
    indices.forEach((index) => this.axes[index] && this.ellipsoid(points.place[index], this.axes[index]));
    context.stroke();
    context.globalAlpha = 1;
  }

  /** Three great circles; only as fine as their size on the screen asks for. */
  ellipsoid(place, axes) {
    const seen = this.eye.see(...place);
    if (!seen) return;
    const radius = (Math.max(...axes.map((axis) => Math.hypot(...axis))) * this.eye.focal) / seen[2];
    if (radius < 1.2) return;
    const segments = radius < 6 ? 10 : radius < 30 ? 20 : 48;
    for (const [a, b] of [[axes[0], axes[1]], [axes[1], axes[2]], [axes[2], axes[0]]]) {
      let pen = false;
      for (let step = 0; step <= segments; step += 1) {
        const [c, s] = [Math.cos((step * 2 * Math.PI) / segments), Math.sin((step * 2 * Math.PI) / segments)];
        const there = this.eye.see(place[0] + c * a[0] + s * b[0], place[1] + c * a[1] + s * b[1], place[2] + c * a[2] + s * b[2]);
        if (there && pen) this.context.lineTo(there[0], there[1]);
        else if (there) this.context.moveTo(there[0], there[1]);
        pen = Boolean(there);
      }
    }
  }

  /** Where the points are on the canvas, for the pointer too. */
  points(shown) {
    const { context, eye } = this;
    const { place, control } = this.data.points;
    this.seenPoints = place.map((at) => eye.see(...at));
    const size = place.length > 5000 ? 1.5 : 2.5;
    for (const controls of [false, true]) {
      context.fillStyle = controls ? this.colours.control : this.colours.point;
      context.beginPath();
      this.seenPoints.forEach((seen, index) => {
        if (!seen || Boolean(control[index]) !== controls) return;
        if (controls) this.triangle(seen);
        else context.rect(seen[0] - size / 2, seen[1] - size / 2, size, size);
      });
      context.fill();
    }
    for (const { kind, index } of shown) {
      if (kind === "point" && this.seenPoints[index]) this.ring(this.seenPoints[index]);
    }
  }

  triangle([x, y]) {
    this.context.moveTo(x, y - 5);
    this.context.lineTo(x + 4.5, y + 3);
    this.context.lineTo(x - 4.5, y + 3);
    this.context.closePath();
  }

  ring([x, y]) {
    const { context } = this;
    context.strokeStyle = this.colours.ink;
    context.lineWidth = 1.5;
    context.beginPath();
    context.arc(x, y, 7, 0, 2 * Math.PI);
    context.stroke();
  }

  stations(shown, chosenGroup) {
    const { place, g } = this.data.stations;
    this.seenStations = place.map((at) => this.eye.see(...at));
    place.forEach((at, index) => {
      const [a, b, c, d, top] = this.corners[index];
      const strong = shown.some((item) => item.kind === "station" && item.index === index);
      const faint = !strong && chosenGroup !== "" && String(g[index]) !== chosenGroup;
      const lines = [[at, a], [at, b], [at, c], [at, d], [a, b], [b, c], [c, d], [d, a], [a, top], [top, b]];
      this.path(lines, strong ? this.colours.ink : this.colours.station, strong ? 2 : 1.2, faint ? 0.3 : 1);
    });
  }

  /** The directions of X, Y and Z, in the corner. */
  triad() {
    const { context, eye } = this;
    const [x, y, length] = [46, eye.height - 46, 28];
    context.font = "12px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.strokeStyle = context.fillStyle = this.colours.ink;
    context.lineWidth = 1.5;
    ["X", "Y", "Z"].forEach((name, index) => {
      const [dx, dy] = [eye.right[index], -eye.up[index]];
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(x + length * dx, y + length * dy);
      context.stroke();
      context.fillText(name, x + (length + 10) * dx, y + (length + 10) * dy);
    });
  }

  note() {
    const { context, eye, data } = this;
    const grid = `grid ${short(data.grid.step)} ${data.unit}`;
    const sigma = this.axes.some(Boolean) ? ` · ellipsoids ${short(data.factor)} × σ` : "";
    context.textAlign = "right";
    context.fillStyle = this.colours.soft;
    context.fillText(grid + sigma, eye.width - 12, eye.height - 14);
  }
}
