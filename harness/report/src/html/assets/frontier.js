// Accuracy against speed, and the operators that no other beats in both.

const drawn = (name, attributes, ...children) => {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
};

/** Those that no other beats in both, from the slowest on. */
const frontier = (methods) => {
  const kept = [];
  for (const one of [...methods].sort((a, b) => b.speed - a.speed || a.rmse - b.rmse)) {
    if (!kept.length || one.rmse < kept[kept.length - 1].rmse) kept.push(one);
  }
  return kept.reverse();
};

/** A logarithmic scale with its ticks: 1, 2 and 5 of each decade, or powers of ten alone where these are many. */
const logScale = (values, from, to) => {
  const [low, high] = [Math.log10(Math.min(...values)) - 0.08, Math.log10(Math.max(...values)) + 0.08];
  const steps = high - low > 2.5 ? [1] : [1, 2, 5];
  const ticks = [];
  for (let decade = Math.floor(low); decade <= high; decade += 1) {
    for (const step of steps) {
      const at = decade + Math.log10(step);
      if (at >= low && at <= high) ticks.push(10 ** at);
    }
  }
  return { place: (value) => from + ((Math.log10(value) - low) / (high - low)) * (to - from), ticks };
};

const frontierPlot = (methods) => {
  if (methods.length < 2) return [];
  const [width, height, left, right, top, bottom] = [720, 330, 66, 12, 26, 44];
  const x = logScale(methods.map(({ speed }) => speed), left, width - right);
  const y = logScale(methods.flatMap(({ rmse, low, high }) => [rmse, low || rmse, high || rmse]), height - bottom, top);
  const svg = drawn("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "accuracy against speed" });
  const text = (at, attributes, content) => drawn("text", { x: at[0], y: at[1], ...attributes }, content);
  for (const tick of x.ticks) {
    svg.append(drawn("path", { class: "gridline", d: `M${x.place(tick)} ${top}V${height - bottom}` }), text([x.place(tick), height - bottom + 17], { "text-anchor": "middle" }, readable(tick)));
  }
  for (const tick of y.ticks) {
    svg.append(drawn("path", { class: "gridline", d: `M${left} ${y.place(tick)}H${width - right}` }), text([left - 8, y.place(tick) + 4], { "text-anchor": "end" }, short3(tick)));
  }
  svg.append(text([left, top - 10], {}, "RMSE, px"), text([width - right, height - 6], { "text-anchor": "end" }, "points a second, one thread"));
  const best = frontier(methods);
  svg.append(drawn("path", { class: "line s0", d: `M${best.map(({ speed, rmse }) => `${x.place(speed)} ${y.place(rmse)}`).join("L")}` }));
  for (const one of methods) {
    const [px, py, on] = [x.place(one.speed), y.place(one.rmse), best.includes(one)];
    const group = drawn("g", { class: `spot ${on ? "s0" : "s7"}`, tabindex: "0" });
    const said = [["", one.name], ["RMSE, px", short3(one.rmse)], ["points/s", readable(one.speed)], ["failed, %", percent(one.failed)]];
    group.append(drawn("title", {}, said.map(([name, value]) => (name ? `${name} ${value}` : value)).join("\n")));
    if (one.low) group.append(drawn("path", { class: "bar", d: `M${px} ${y.place(one.low)}V${y.place(one.high)}` }));
    group.append(on ? drawn("circle", { class: "mark full", cx: px, cy: py, r: 5 }) : drawn("path", { class: "mark", d: `M${px - 5} ${py - 5}l10 10m0-10l-10 10` }));
    const tell = () => {
      const { left: l, top: t } = group.getBoundingClientRect();
      showTip(said, l, t);
    };
    ["pointerenter", "focus"].forEach((name) => group.addEventListener(name, tell));
    ["pointerleave", "blur"].forEach((name) => group.addEventListener(name, hideTip));
    svg.append(group);
  }
  const caption = "Accuracy against speed at this place. The line joins the operators (dots) that no other beats in both; crosses are the others; bars are 95 %.";
  return [make("figure", { class: "frontier" }, svg, make("figcaption", {}, caption))];
};
