// The 3D scene: stations, points, ellipsoids and rays that can be turned.

/** A step of 1, 2 or 5 times a power of ten. */
const roundStep = (wanted) => {
  const decade = 10 ** Math.floor(Math.log10(wanted));
  return [1, 2, 5, 10].map((factor) => factor * decade).find((size) => size >= wanted * 0.999);
};

const places = ({ X = [], Y = [], Z = [] }) => X.map((x, index) => [x, Y[index], Z[index]]);

/** What the page holds, with what is needed to draw it. */
const readScene = (text) => {
  const raw = JSON.parse(text);
  const stations = { name: [], g: [], R: [], half: [], ...raw.stations, place: places(raw.stations || {}) };
  const points = { name: [], C: null, ...raw.points, control: (raw.points && raw.points.control) || [], place: places(raw.points || {}) };
  const rays = ((raw.rays && raw.rays.station) || []).map((station, index) => [station, raw.rays.point[index]])
    .filter(([station, point]) => stations.place[station] && points.place[point]);
  const data = { unit: raw.unit || "", factor: raw.factor || 1, stations, points, rays };
  const every = [...stations.place, ...points.place];
  const whole = stations.place.every((_, index) => (stations.R[index] || []).length === 9 && (stations.half[index] || []).length === 2);
  if (!every.length || !whole || !every.flat().every(Number.isFinite)) throw new Error("no scene");
  const extreme = (pick) => [0, 1, 2].map((axis) => every.reduce((best, place) => pick(best, place[axis]), every[0][axis]));
  const [low, high] = [extreme(Math.min), extreme(Math.max)];
  data.centre = low.map((value, axis) => (value + high[axis]) / 2);
  data.radius = Math.max(Math.hypot(...low.map((value, axis) => high[axis] - value)) / 2, 1e-9);
  data.frustum = data.radius * Math.min(0.12, 0.7 / Math.sqrt(Math.max(stations.place.length, 1)));
  const step = roundStep(data.radius / 4);
  const ground = (values, round, most) => values.map((value, axis) => (axis < most ? round(value / step) * step : value));
  data.grid = { step, low: ground(low, Math.floor, 2), high: ground(high, Math.ceil, 2) };
  data.digits = within(4 - Math.floor(Math.log10(data.radius)), 0, 8);
  return data;
};

class Scene {
  constructor(figure, index, data) {
    this.figure = figure;
    this.id = figure.id || `scene-${index + 1}`;
    this.data = data;
    this.eye = new Eye();
    this.under = null;
    this.own = null;
    this.canvas = make("canvas", { role: "img", "aria-label": "stations and points in space; arrows turn, + and - zoom, brackets step through points" });
    const box = make("div", { class: "space" }, this.canvas);
    const still = figure.querySelector("svg");
    if (still) still.after(box);
    else figure.prepend(box);
    figure.classList.add("live");
    data.stations.g.forEach((g, station) => {
      if (!chosen.groups.has(String(g))) chosen.groups.set(String(g), []);
      chosen.names.set(String(g), String(data.stations.name[station]));
    });
    this.painter = new Painter(this.canvas, this.data, this.eye);
    this.update = oncePerFrame(() => this.painter.paint(this.shown(), chosen.g));
    this.addTools(box);
    this.home();
    this.resize();
    gestures(this.canvas, this);
    new ResizeObserver(() => this.resize()).observe(box);
    chosen.told.push(() => this.groupChosen());
    document.addEventListener("theme", () => this.update());
    keep(`view.${this.id}`, () => this.viewText(), (text) => this.setView(text));
  }

  addTools(box) {
    const turn = (yaw, pitch) => () => this.look(yaw, pitch, this.eye.distance, this.eye.centre);
    const tools = make("div", { class: "tools" },
      button("+", "zoom in (+)", () => this.zoom(1.3)),
      button("−", "zoom out (-)", () => this.zoom(1 / 1.3)),
      button("top", "from above", turn(-Math.PI / 2, Math.PI / 2)),
      button("front", "along Y", turn(-Math.PI / 2, 0)),
      button("side", "along X", turn(0, 0)),
      button("reset", "as at first (0)", () => this.reset()),
      button("PNG", "what is shown, as a PNG file", () => this.canvas.toBlob((blob) => blob && download(`${this.id}.png`, "image/png", blob))));
    box.after(tools);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    const ratio = window.devicePixelRatio || 1;
    [this.canvas.width, this.canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    this.eye.resize(width, height);
    if (this.atHome !== false) this.home();
    this.update();
  }

  /** As near as leaves everything in sight. */
  home() {
    const { eye, data } = this;
    eye.set(-1.1, 0.45, data.radius * 3, data.centre);
    const every = [...data.stations.place, ...data.points.place];
    for (let turn = 0; turn < 4; turn += 1) {
      const most = every.reduce((worst, place) => {
        const seen = eye.see(...place);
        return seen ? Math.max(worst, Math.abs(seen[0] / eye.width - 0.5), Math.abs(seen[1] / eye.height - 0.5)) : 1;
      }, 0.01);
      eye.set(eye.yaw, eye.pitch, within(eye.distance * (most / 0.42), data.radius * 0.5, data.radius * 8), data.centre);
    }
    this.atHome = true;
    this.update();
  }

  look(yaw, pitch, distance, centre) {
    const { radius, centre: middle } = this.data;
    const before = this.eye.distance;
    // What the address would lose is lost at once, so that a link shows the same picture.
    const rounded = (value) => Number(short(value));
    const near = rounded(within(distance / radius, 0.005, 20)) * radius;
    this.eye.set(rounded(yaw), rounded(pitch), near, centre.map((part, axis) => middle[axis] + rounded((part - middle[axis]) / radius) * radius));
    this.atHome = false;
    this.update();
    changed();
    return before !== this.eye.distance;
  }

  zoom(factor) {
    const { yaw, pitch, distance, centre } = this.eye;
    return this.look(yaw, pitch, distance / factor, centre);
  }

  pan(dx, dy, event) {
    const { eye } = this;
    if (event.shiftKey || event.buttons & 2) {
      eye.pan(dx, dy);
      this.look(eye.yaw, eye.pitch, eye.distance, eye.centre);
    } else {
      this.look(eye.yaw - dx * 0.008, eye.pitch + dy * 0.008, eye.distance, eye.centre);
    }
    hideTip();
  }

  holdsTouch() {
    return document.activeElement === this.canvas;
  }

  reset() {
    this.own = this.under = null;
    this.home();
    changed();
  }

  /** What the pointer or the keys are at, and what is chosen. */
  shown() {
    const { g } = this.data.stations;
    const stations = chosen.g === "" ? [] : g.map((own, index) => (String(own) === chosen.g ? { kind: "station", index } : null)).filter(Boolean);
    return [...stations, this.own, this.under].filter(Boolean);
  }

  groupChosen() {
    if (chosen.g) this.own = null;
    this.update();
  }

  nearest(x, y) {
    let [found, least] = [null, 12];
    const look = (kind, list) => (list || []).forEach((seen, index) => {
      const distance = seen ? Math.hypot(seen[0] - x, seen[1] - y) : Infinity;
      if (distance < least) [found, least] = [{ kind, index }, distance];
    });
    look("station", this.painter.seenStations);
    look("point", this.painter.seenPoints);
    return found;
  }

  hover(event) {
    const { left, top } = this.canvas.getBoundingClientRect();
    this.point(this.nearest(event.clientX - left, event.clientY - top), event.clientX, event.clientY);
  }

  point(item, x, y) {
    const before = this.under;
    this.under = item;
    if (!before !== !item || (item && (before.kind !== item.kind || before.index !== item.index))) this.update();
    if (item) showTip(this.lines(item), x, y);
    else hideTip();
  }

  lines({ kind, index }) {
    const { data } = this;
    const own = kind === "station" ? data.stations : data.points;
    const unit = data.unit ? ` ${data.unit}` : "";
    const covariance = kind === "point" && data.points.C && data.points.C[index];
    const lines = [[kind === "station" ? "station" : data.points.control[index] ? "control point" : "point", String(own.name[index] || index + 1)]];
    ["X", "Y", "Z"].forEach((name, axis) => {
      const sigma = covariance ? Math.sqrt(Math.max(covariance[[0, 3, 5][axis]], 0)) : 0;
      // Two digits of the standard deviation, and the coordinate to the same place.
      const digits = sigma > 0 ? within(1 - Math.floor(Math.log10(sigma)), 0, 9) : data.digits;
      const value = own.place[index][axis].toFixed(digits).replace("-", "−");
      lines.push([name, `${value}${covariance ? ` ± ${sigma.toFixed(sigma > 0 ? digits : 0)}` : ""}${unit}`]);
    });
    return [...lines, ["rays", String(this.painter.raysOf(kind[0], index).length)]];
  }

  leave() {
    this.point(null);
  }

  click(event) {
    this.hover(event);
    this.chooseNow();
  }

  chooseNow() {
    const item = this.under;
    if (!item) return;
    const g = item.kind === "station" ? this.data.stations.g[item.index] : undefined;
    if (g !== undefined && g !== null) {
      toggle(String(g), "");
      return;
    }
    const same = this.own && this.own.kind === item.kind && this.own.index === item.index;
    this.own = same ? null : item;
    this.update();
    changed();
  }

  step(kind, by) {
    const { length } = (kind === "station" ? this.data.stations : this.data.points).place;
    if (!length) return true;
    const last = this.under && this.under.kind === kind ? this.under.index : by > 0 ? -1 : length;
    const index = (last + by + length) % length;
    const { left, top } = this.canvas.getBoundingClientRect();
    const place = (kind === "station" ? this.data.stations : this.data.points).place[index];
    const seen = this.eye.see(...place) || [0, 0];
    this.point({ kind, index }, left + seen[0], top + seen[1]);
    return true;
  }

  key(event) {
    const { key, shiftKey } = event;
    if (key in STEPS) return this.step("point", STEPS[key]);
    const station = { "{": -1, "<": -1, "}": 1, ">": 1 }[key];
    if (station) return this.step("station", station);
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    if (key === "Escape" && this.own && !chosen.g) {
      this.own = null;
      this.update();
      return true;
    }
    const [x, y] = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] }[key] || [0, 0];
    if (x || y) this.pan(x, y, { shiftKey });
    else if (key === "+" || key === "=") this.zoom(1.2);
    else if (key === "-" || key === "_") this.zoom(1 / 1.2);
    else if (key === "0") this.reset();
    else if (key === "Enter" || key === " ") this.chooseNow();
    else return false;
    return true;
  }

  viewText() {
    const { yaw, pitch, distance, centre } = this.eye;
    const own = this.own ? `${this.own.kind[0]}${this.own.index}` : "";
    // Against the scene's own size: coordinates of a country's grid have more digits than an address should.
    const { centre: middle, radius } = this.data;
    const values = [yaw, pitch, distance / radius, ...centre.map((part, axis) => (part - middle[axis]) / radius)];
    const place = this.atHome ? "" : values.map(short).join(",");
    return place || own ? `${place}:${own}` : "";
  }

  setView(text) {
    const [place, own = ""] = text.split(":");
    const values = numbers(place, 6);
    const { centre, radius } = this.data;
    if (values) this.look(values[0], values[1], values[2] * radius, values.slice(3).map((part, axis) => centre[axis] + part * radius));
    else this.home();
    const index = Number(own.slice(1));
    const list = own[0] === "s" ? this.data.stations : this.data.points;
    this.own = own && list.place[index] ? { kind: own[0] === "s" ? "station" : "point", index } : null;
    this.update();
  }
}

const setUpScenes = () => all("figure.scene").forEach((figure, index) => {
  const source = figure.querySelector('script[type="application/json"]');
  let data = null;
  try {
    data = readScene(source.textContent);
  } catch {
    // The drawing that does without a script stays.
    return;
  }
  new Scene(figure, index, data);
});
