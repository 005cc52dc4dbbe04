// The explorer of the atlas: what to take for one's own images.

const SPEEDS = [0, 1e3, 3e4, 1e5, 3e5, 1e6];
const START = { blur: 1, noise: 2 };

const readable = (value) => (value >= 1e6 ? `${short3(value / 1e6)}M` : value >= 1e3 ? `${short3(value / 1e3)}k` : short3(value));

const short3 = (value) => String(Number(value.toPrecision(3)));

const percent = (share) => (share === 0 ? "0" : (100 * share).toFixed(2));

class Explorer {
  constructor(box, data) {
    this.data = data;
    data.questions.forEach((question) => {
      question.cellAt = new Map((question.cells.at || []).map((at, cell) => [at.join(), cell]));
    });
    this.question = 0;
    this.speed = 0;
    this.row = 0;
    this.points = data.questions.map((question) => question.axes.map((axis) => this.startOf(axis)));
    this.form = make("div", { class: "asked" });
    this.out = make("div", { class: "told", "aria-live": "polite" });
    box.replaceChildren(this.form, this.out, box.querySelector("script"));
    this.home = this.state();
    keep("ask", () => (this.state() === this.home ? "" : this.state()), (text) => this.restore(text || this.home));
    series.told.push(() => this.tell());
    this.build();
  }

  startOf(axis) {
    const wanted = START[axis.title.split(",")[0]];
    const known = [...axis.values].sort((a, b) => a - b);
    return wanted === undefined ? known[Math.floor(known.length / 2)] : within(wanted, known[0], known[known.length - 1]);
  }

  state() {
    return [this.question, this.speed, this.row, ...this.points[this.question]].join(",");
  }

  restore(text) {
    const [question, speed, row, ...point] = text.split(",").map(Number);
    const asked = this.data.questions[question];
    if (!asked || point.length !== asked.axes.length || !point.every(Number.isFinite)) return;
    this.question = question;
    this.speed = SPEEDS.includes(speed) ? speed : 0;
    this.row = asked.rows[row] ? row : 0;
    this.points[question] = asked.axes.map(({ values }, axis) => within(point[axis], Math.min(...values), Math.max(...values)));
    this.build();
  }

  build() {
    const asked = this.data.questions[this.question];
    const choose = (title, items, value, set) => {
      const select = make("select", { change: () => set(Number(select.value)) });
      items.forEach(([key, label]) => select.append(make("option", { value: key }, label)));
      select.value = String(value);
      return make("label", {}, make("span", {}, title), select);
    };
    const again = (set) => (value) => {
      set(value);
      this.build();
      changed();
    };
    const questions = this.data.questions.map(({ title }, index) => [index, title]);
    this.form.replaceChildren(choose("what is measured", questions, this.question, again((value) => (this.question = value))));
    if (asked.axes.length) asked.axes.forEach((axis, index) => this.form.append(this.slider(axis, index)));
    else this.form.append(choose("where", asked.rows.map(({ title }, index) => [index, title]), this.row, again((value) => (this.row = value))));
    const speeds = SPEEDS.map((speed) => [speed, speed ? `at least ${readable(speed)} points/s` : "any"]);
    if (asked.rows.some(({ speed }) => speed.some((one) => one !== null))) {
      this.form.append(choose("speed needed, one thread", speeds, this.speed, again((value) => (this.speed = value))));
    } else this.speed = 0;
    this.tell();
  }

  /** A slider and a field for one axis; both go from the first cell to the last. */
  slider({ title, values }, index) {
    const known = [...values].sort((a, b) => a - b);
    const [low, high] = [known[0], known[known.length - 1]];
    const [scale, back] = low > 0 ? [Math.log, Math.exp] : [(x) => x, (x) => x];
    const field = make("input", { type: "number", min: low, max: high, step: "any", "aria-label": title });
    const range = make("input", { type: "range", min: 0, max: 1, step: 0.005, list: `ask-${index}`, "aria-label": title });
    const marks = make("datalist", { id: `ask-${index}` }, ...known.map((value) => make("option", { value: (scale(value) - scale(low)) / (scale(high) - scale(low) || 1) })));
    const set = (value, from) => {
      this.points[this.question][index] = value;
      if (from !== field) field.value = short3(value);
      if (from !== range) range.value = (scale(value) - scale(low)) / (scale(high) - scale(low) || 1);
      this.tell();
      changed();
    };
    range.addEventListener("input", () => {
      const value = Number(back(scale(low) + Number(range.value) * (scale(high) - scale(low))).toPrecision(3));
      // Close to a cell is the cell.
      set(within(known.find((one) => Math.abs(value - one) < 0.02 * one) ?? value, low, high), range);
    });
    field.addEventListener("change", () => {
      const value = Number(field.value);
      set(field.value === "" || !Number.isFinite(value) ? this.points[this.question][index] : within(value, low, high));
    });
    const value = this.points[this.question][index];
    field.value = short3(value);
    range.value = (scale(value) - scale(low)) / (scale(high) - scale(low) || 1);
    return make("div", { class: "slider" }, make("span", {}, title), range, field, marks, make("small", {}, `measured at ${known.map(short3).join(", ")}`));
  }

  tell() {
    const asked = this.data.questions[this.question];
    const cells = asked.axes.length ? cellsAround(asked, this.points[this.question]) : null;
    if (asked.axes.length && !cells) {
      this.out.replaceChildren(make("p", {}, "Not measured there."));
      return;
    }
    const row = asked.rows[cells ? rowAt(asked, cells) : this.row];
    const methods = (cells ? methodsAt(asked, cells) : row.names.map((name, index) => ({ name, rmse: row.rmse[index], low: null, high: null, failed: row.failed[index], speed: row.speed[index] })))
      .filter(({ rmse }) => rmse !== null)
      .filter(({ speed }) => !this.speed || (speed !== null && speed >= this.speed))
      .sort((a, b) => (a.failed > this.data.most) - (b.failed > this.data.most) || a.rmse - b.rmse);
    this.out.replaceChildren(...this.answer(asked, row, methods), ...(cells ? [this.where(asked, cells)] : []), ...this.ranking(methods.filter(({ name }) => !isOff(name))));
  }

  answer(asked, row, methods) {
    const best = advice(row, this.data.most, this.speed);
    const fast = this.speed ? ` with at least ${readable(this.speed)} points/s` : "";
    if (best < 0) return [make("p", { class: "verdict doubt take", "data-take": "" }, `Take none: every operator${fast} fails too often or was not measured.`)];
    const ties = this.speed ? [] : row.ties.filter((index) => index !== best).map((index) => row.names[index]);
    const said = [make("p", { class: "take", "data-take": row.names[best] }, "Take ", make("code", {}, row.names[best]), `${fast}: ${short3(row.rmse[best])} px over all images of this kind (${row.title}), ${percent(row.failed[best])} % fail.`)];
    if (ties.length) said.push(make("p", {}, "As good: ", ...ties.flatMap((name, index) => [index ? ", " : "", make("code", {}, name)]), "."));
    if (methods.length && methods[0].failed <= this.data.most && methods[0].name !== row.names[best] && !ties.includes(methods[0].name)) {
      said.push(make("p", {}, "At this very place ", make("code", {}, methods[0].name), " has the least error; over the images of this kind together it is not the best."));
    }
    said.push(make("p", { class: "caption" }, asked.about));
    return said;
  }

  /** Between which cells the figures lie. */
  where(asked, cells) {
    const parts = asked.axes.map(({ title, values }, index) => {
      const sides = between(values, this.points[this.question][index]).map(([place]) => short3(values[place]));
      return sides.length > 1 ? `${title} between ${sides[0]} and ${sides[1]}` : `${title} ${sides[0]}`;
    });
    return make("p", { class: "caption where" }, `${cells.length > 1 ? "Interpolated between cells, in logarithms: " : "Measured in one cell: "}${parts.join("; ")}. Lost (more than 1 px off) and rejected points count as 1 px; intervals of 95 %.`);
  }

  ranking(methods) {
    if (!methods.length) return [make("p", {}, "No operator that is fast enough was measured.")];
    const head = ["operator", "RMSE, px", "95 %", "failed, %", "points/s"].map((name, index) => make("th", index ? { class: "n" } : {}, name));
    const rows = methods.map(({ name, rmse, low, high, failed, speed }) => {
      const bad = failed > this.data.most;
      const cell = (text) => make("td", { class: "n" }, text);
      return make("tr", bad ? { class: "unsound", title: "fails too often to be advised" } : {}, make("td", {}, make("code", {}, name)), cell(short3(rmse)),
        cell(low === null || high === null ? "" : `${short3(low)} to ${short3(high)}`), cell(percent(failed)), cell(speed === null ? "not measured" : readable(speed)));
    });
    const table = make("div", { class: "table tall" }, make("table", { class: "ranking" }, make("thead", {}, make("tr", {}, ...head)), make("tbody", {}, ...rows)));
    return [...frontierPlot(methods.filter(({ speed, failed }) => speed !== null && failed <= this.data.most)), table];
  }
}

const setUpExplorer = () => {
  for (const box of all(".explorer")) {
    const data = box.querySelector("script");
    if (data) new Explorer(box, JSON.parse(data.textContent));
  }
};
