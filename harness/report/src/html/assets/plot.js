// Plots: zoomed, read off, taken along.

const MOST_ZOOM = 200;
const REACH = 10;
const ASIDE = { ArrowLeft: -1, ArrowRight: 1 };

/** Where an element of a plot is, in the plot's own units. */
const placeOf = (element) => {
  const moved = /translate\(\s*([-\d.e+]+)[\s,]+([-\d.e+]+)/.exec(element.getAttribute("transform") || "");
  if (moved) return [Number(moved[1]), Number(moved[2])];
  const number = (name) => Number(element.getAttribute(name));
  if (element.tagName === "rect") return [number("x") + number("width") / 2, number("y") + number("height") / 2];
  if (element.tagName === "circle") return [number("cx"), number("cy")];
  if (element.tagName === "line") return [number("x1"), number("y1")];
  const text = element.getAttribute("d") || element.getAttribute("points") || "";
  return (text.match(/-?\d*\.?\d+(e[-+]?\d+)?/gi) || [NaN, NaN]).slice(0, 2).map(Number);
};

/** As fields between bars again. */
const joined = (values) => values.map((value) => value.replace(/[\\|]/g, "\\$&")).join("|");

/** Elements at the places that a group tells of, a line each: an empty value is that of the line before. */
const pointsOf = (group) => {
  let last = [];
  return group.dataset.p.split("\n").map((line) => {
    const [place, ...values] = fields(line);
    last = values.map((value, index) => value || last[index] || "");
    const point = document.createElementNS(SVG, "path");
    point.setAttribute("class", "mark point");
    point.setAttribute("transform", `translate(${place})`);
    point.setAttribute("d", "M-9 0a9 9 0 1 0 18 0a9 9 0 1 0-18 0");
    point.dataset.t = joined(last);
    return point;
  });
};

class Plot {
  constructor(figure, svg, index) {
    this.figure = figure;
    this.svg = svg;
    this.id = figure.id || `plot-${index + 1}`;
    this.marks = svg.querySelector(".marks");
    this.home = this.marks.getAttribute("transform") || "";
    const box = numbers(svg.dataset.box, 4);
    this.zoomable = box !== null;
    const [x, y, width, height] = box || [0, 0, ...(numbers(svg.getAttribute("viewBox"), 4) || [0, 0, 1, 1]).slice(2)];
    this.box = { x, y, width, height, right: x + width, bottom: y + height };
    this.now = -1;
    this.at = { k: 1, x: 0, y: 0 };
    this.items = [];
    this.told = [];
    this.folded = all("[data-p]", this.marks);
    this.gather(all("[data-t], .mark", this.marks));
    this.axes = [this.axis("x"), this.axis("y")].filter(Boolean);
    this.update = oncePerFrame(() => this.draw());
    this.addTools();
    gestures(svg, this);
    svg.addEventListener("focus", () => this.unfold());
    if (!svg.querySelector("title")) svg.setAttribute("aria-roledescription", "plot; + and - zoom, brackets step through its marks");
    keep(`zoom.${this.id}`, () => this.zoomText(), (text) => this.setZoom(text));
  }

  /** Places that are told of become elements when somebody turns to the drawing: of most nobody asks. */
  unfold() {
    if (!this.folded.length) return;
    const points = this.folded.flatMap((group) => {
      const own = pointsOf(group);
      group.append(...own);
      return own;
    });
    this.folded = [];
    this.gather(points);
    this.draw();
  }

  gather(elements) {
    const items = elements.map((element) => {
      const [x, y] = placeOf(element);
      const owner = element.closest("[data-series]");
      const symbol = element.classList.contains("mark");
      return { element, x, y, symbol, k: 1, home: element.getAttribute("transform") || "", series: owner ? owner.dataset.series : undefined };
    });
    this.items.push(...items);
    this.told.push(...items.filter((item) => item.element.dataset.t !== undefined));
  }

  /** An axis whose ticks can be made anew: with a scale, and a tick to copy. */
  axis(name) {
    const group = this.svg.querySelector(`.axis.${name}`);
    const ticks = group ? all(".tick", group) : [];
    const values = numbers(this.svg.dataset[name], 2);
    if (!this.zoomable || !ticks.length || !values || values[0] === values[1]) return null;
    const log = this.svg.dataset[`${name}scale`] === "log";
    const ends = name === "x" ? [this.box.x, this.box.right] : [this.box.y, this.box.bottom];
    return { name, group, ticks, across: placeOf(ticks[0]), scale: new Scale(values, log, ...ends) };
  }

  addTools() {
    const wide = make("div", { class: "wide" });
    const width = (numbers(this.svg.getAttribute("viewBox"), 4) || [0, 0, 900, 0])[2];
    // Neither a small plot blown up nor a large one too small to read.
    this.svg.style.minWidth = `${Math.round(Math.min(width * 0.64, 640))}px`;
    this.svg.style.maxWidth = `${Math.round(width * 1.06)}px`;
    this.svg.before(wide);
    wide.append(this.svg);
    this.tools = make("div", { class: "tools" });
    if (this.zoomable) {
      this.tools.append(
        button("+", "zoom in (+)", () => this.zoomMiddle(1.5)),
        button("−", "zoom out (-)", () => this.zoomMiddle(1 / 1.5)),
        button("reset", "show all of the plot (0)", () => this.reset()),
      );
    }
    this.tools.append(button("SVG", "what is shown, as an SVG file", () => download(`${this.id}.svg`, "image/svg+xml", standalone(this.svg))));
    if (this.told.length || this.folded.length) this.tools.append(button("CSV", "the marks shown, as a CSV file", () => download(`${this.id}.csv`, "text/csv", this.csv())));
    wide.after(this.tools);
  }

  /** A place of the window in the plot's units. */
  toPlot(x, y) {
    const matrix = this.svg.getScreenCTM();
    return matrix ? [(x - matrix.e) / matrix.a, (y - matrix.f) / matrix.d, matrix.a] : [0, 0, 1];
  }

  setView(k, x, y) {
    const { box, at } = this;
    const next = within(k, 1, MOST_ZOOM);
    const view = {
      k: next,
      x: within(x, (1 - next) * box.right, (1 - next) * box.x),
      y: within(y, (1 - next) * box.bottom, (1 - next) * box.y),
    };
    if (!this.zoomable || (view.k === at.k && view.x === at.x && view.y === at.y)) return false;
    this.at = view;
    hideTip();
    this.update();
    changed();
    return true;
  }

  zoom(factor, x, y) {
    const [px, py] = this.toPlot(x, y);
    return this.zoomAbout(factor, px, py);
  }

  zoomAbout(factor, px, py) {
    const { k, x, y } = this.at;
    const next = within(k * factor, 1, MOST_ZOOM);
    const [cx, cy] = [within(px, this.box.x, this.box.right), within(py, this.box.y, this.box.bottom)];
    return this.setView(next, cx - ((cx - x) * next) / k, cy - ((cy - y) * next) / k);
  }

  zoomMiddle(factor) {
    return this.zoomAbout(factor, this.box.x + this.box.width / 2, this.box.y + this.box.height / 2);
  }

  pan(dx, dy) {
    const [, , unit] = this.toPlot(0, 0);
    return this.setView(this.at.k, this.at.x + dx / unit, this.at.y + dy / unit);
  }

  holdsTouch() {
    return this.at.k > 1;
  }

  reset() {
    this.setView(1, 0, 0);
  }

  draw() {
    const { k, x, y } = this.at;
    this.marks.setAttribute("transform", k === 1 ? this.home : `translate(${short(x)} ${short(y)}) scale(${short(k)})`);
    this.svg.classList.toggle("zoomed", k > 1);
    for (const item of this.items) {
      if (!item.symbol || item.k === k || !this.inView(item)) continue;
      item.k = k;
      item.element.setAttribute("transform", k === 1 ? item.home : `${item.home} scale(${short(1 / k)})`);
    }
    this.axes.forEach((axis) => this.drawAxis(axis));
  }

  drawAxis({ name, group, ticks, across, scale }) {
    const { k, x, y } = this.at;
    all(".tick", group).forEach((tick) => tick.remove());
    if (k === 1) {
      group.append(...ticks);
      return;
    }
    const alongX = name === "x";
    const [start, end, shift] = alongX ? [this.box.x, this.box.right, x] : [this.box.y, this.box.bottom, y];
    for (const { text, place } of scale.ticks((start - shift) / k, (end - shift) / k, alongX ? 7 : 5)) {
      const tick = ticks[0].cloneNode(true);
      const where = short(place * k + shift);
      tick.setAttribute("transform", alongX ? `translate(${where} ${across[1]})` : `translate(${across[0]} ${where})`);
      const label = tick.querySelector("text");
      if (label) label.textContent = text;
      group.append(tick);
    }
  }

  inView({ x, y }) {
    const [px, py] = [x * this.at.k + this.at.x, y * this.at.k + this.at.y];
    return px >= this.box.x - 1 && px <= this.box.right + 1 && py >= this.box.y - 1 && py <= this.box.bottom + 1;
  }

  seen(item) {
    return !isOff(item.series) && this.inView(item);
  }

  /** What the pointer means: the nearest mark, or what lies right under it. */
  under(event) {
    this.unfold();
    const [px, py, unit] = this.toPlot(event.clientX, event.clientY);
    const [x, y] = [(px - this.at.x) / this.at.k, (py - this.at.y) / this.at.k];
    let nearest = null;
    let least = REACH / unit / this.at.k;
    for (const item of this.told) {
      const distance = Math.hypot(item.x - x, item.y - y);
      if (distance < least && item.element.tagName !== "rect" && this.seen(item)) [nearest, least] = [item.element, distance];
    }
    const direct = event.target.closest("[data-t], [data-g], [data-k]");
    return nearest || (direct && this.svg.contains(direct) ? direct : null);
  }

  hover(event) {
    const element = this.under(event);
    this.setNow(element);
    if (element && element.dataset.t !== undefined) showTip(linesOf(element), event.clientX, event.clientY);
    else hideTip();
  }

  leave() {
    this.setNow(null);
    hideTip();
  }

  click(event) {
    const element = this.under(event);
    if (!element) return;
    pick(element);
    this.hover(event);
  }

  setNow(element) {
    if (this.marked) this.marked.classList.remove("now");
    this.marked = element;
    if (element) element.classList.add("now");
  }

  /** On to the next mark, for readers without a mouse. */
  step(by) {
    this.unfold();
    const { told } = this;
    const start = this.now < 0 && by < 0 ? 0 : this.now;
    for (let turn = 1; turn <= told.length; turn += 1) {
      const index = (start + by * turn + told.length * 2) % told.length;
      if (!this.seen(told[index])) continue;
      this.now = index;
      const { element } = told[index];
      this.setNow(element);
      element.scrollIntoView({ block: "nearest", inline: "nearest" });
      const { left, top, width, height } = element.getBoundingClientRect();
      showTip(linesOf(element), left + width / 2, top + height / 2);
      return true;
    }
    return false;
  }

  key(event) {
    const { key } = event;
    if (key in STEPS) return this.step(STEPS[key]);
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    if ((key === "Enter" || key === " ") && this.marked) {
      pick(this.marked);
      return true;
    }
    if (this.at.k === 1 && key in ASIDE) return this.step(ASIDE[key]);
    if (key === "+" || key === "=") return this.zoomMiddle(1.5) || true;
    if (key === "-" || key === "_") return this.zoomMiddle(1 / 1.5) || true;
    // Escape undoes one thing at a time: first a choice.
    if (key === "0" || (key === "Escape" && !chosen.g && !chosen.k && this.at.k > 1)) {
      this.reset();
      return true;
    }
    const [x, y] = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[key] || [0, 0];
    const moved = (x || y) && this.setView(this.at.k, this.at.x + x * this.box.width * 0.1, this.at.y + y * this.box.height * 0.1);
    return Boolean(moved);
  }

  csv() {
    this.unfold();
    const rows = this.told.filter((item) => this.seen(item)).map((item) => {
      const lines = linesOf(item.element).map(([name, value], index) => [name || `value ${index + 1}`, value]);
      return { owner: item.series || "", values: new Map(lines) };
    });
    const names = [...new Set(rows.flatMap(({ values }) => [...values.keys()]))];
    return csv([["series", ...names], ...rows.map(({ owner, values }) => [owner, ...names.map((name) => values.get(name) || "")])]);
  }

  zoomText() {
    const { k, x, y } = this.at;
    return k === 1 ? "" : [k, x, y].map(short).join(",");
  }

  setZoom(text) {
    const [k, x, y] = numbers(text, 3) || [1, 0, 0];
    this.setView(k, x, y);
  }
}

const setUpPlots = () => all("figure.plot").forEach((figure, index) => {
  const svg = figure.querySelector("svg");
  if (svg && svg.querySelector(".marks")) new Plot(figure, svg, index);
});
