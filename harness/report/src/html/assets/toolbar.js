// The bar at the top: series, what is chosen, theme, reset, keys.

const KEYS = [
  ["click", "choose an image or a mark everywhere; once more, or Escape: undo"],
  ["wheel", "zoom a drawing that was clicked, or with Ctrl"],
  ["drag", "move a zoomed plot, turn the scene (Shift or right button: move it)"],
  ["+ − 0", "zoom in, out, reset (also double click)"],
  ["arrows", "from mark to mark of a plot, move a zoomed one, turn the scene (Shift: move it); rows of a table"],
  ["[ ] or , .", "step through marks and points; Enter chooses"],
  ["{ } or < >", "step through stations"],
  ["filter", "a text, or column>0.1; a semicolon between several"],
];

/** The look of a series, by the first mark or line of it. */
const swatch = (name) => {
  const owner = series.elements.find((element) => element.matches(".series") && element.dataset.series === name);
  if (!owner) return "";
  const icon = document.createElementNS(SVG, "svg");
  icon.setAttribute("viewBox", "-9 -9 18 18");
  icon.setAttribute("class", `swatch ${[...owner.classList].filter((own) => /^s\d$/.test(own)).join(" ")}`);
  icon.setAttribute("aria-hidden", "true");
  const first = owner.querySelector("path.mark");
  const shape = document.createElementNS(SVG, "path");
  shape.setAttribute("class", first ? first.getAttribute("class").replace(/\b(now|picked|chosen)\b/g, "") : "line");
  shape.setAttribute("d", first ? first.getAttribute("d") : "M-8 0H8");
  icon.append(shape);
  return icon;
};

// More switches than these are behind a button.
const MOST_SWITCHES = 10;

/** Something that opens below its name, and closes by Escape or a click elsewhere. */
const popover = (name, ...content) => {
  const box = make("details", { class: "keys" }, make("summary", {}, name), ...content);
  document.addEventListener("click", (event) => box.contains(event.target) || box.removeAttribute("open"));
  box.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !box.open) return;
    box.removeAttribute("open");
    box.firstChild.focus();
    event.preventDefault();
  });
  return box;
};

/** Many switches, with those that a text finds, all and none. */
const manySwitches = (box) => {
  const find = make("input", { type: "search", placeholder: "find", "aria-label": "find a method", input: () => {
    for (const one of box.children) one.hidden = !one.textContent.toLowerCase().includes(find.value.trim().toLowerCase());
  } });
  const every = button("all", "show all methods", () => hideSeries([]));
  const none = button("none", "hide all methods", () => hideSeries(series.names));
  const opened = popover("", make("div", { class: "many" }, make("div", { class: "find" }, find, every, none), box));
  const tell = () => {
    const count = series.names.filter((name) => !isOff(name)).length;
    opened.firstChild.textContent = `methods: ${count === series.names.length ? "all" : count} of ${series.names.length}`;
  };
  series.told.push(tell);
  tell();
  return opened;
};

const seriesSwitches = () => {
  const box = make("span", { class: "switches", role: "group", "aria-label": "series" });
  const buttons = series.names.map((name) => {
    const one = button("", `show or hide ${name}`, () => switchSeries(name));
    one.append(swatch(name), make("span", {}, name));
    box.append(one);
    return [name, one];
  });
  const tell = () => buttons.forEach(([name, one]) => one.setAttribute("aria-pressed", String(!isOff(name))));
  series.told.push(tell);
  tell();
  return series.names.length > MOST_SWITCHES ? manySwitches(box) : box;
};

const choiceLabel = () => {
  const label = button("", "undo the choice (Escape)", () => choose("", ""));
  label.classList.add("choice");
  const tell = () => {
    label.hidden = chosen.g === "";
    label.textContent = chosen.g === "" ? "" : `× ${nameOfGroup(chosen.g)}`;
  };
  chosen.told.push(tell);
  tell();
  return label;
};

const themeSelect = () => {
  const select = make("select", { "aria-label": "colours", change: () => apply(select.value) });
  for (const name of ["auto", "light", "dark"]) select.append(make("option", { value: name === "auto" ? "" : name }, name));
  const apply = (theme) => {
    select.value = theme === "light" || theme === "dark" ? theme : "";
    if (select.value) document.documentElement.setAttribute("data-theme", select.value);
    else document.documentElement.removeAttribute("data-theme");
    document.dispatchEvent(new Event("theme"));
    changed();
  };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => document.dispatchEvent(new Event("theme")));
  keep("theme", () => select.value, apply);
  return make("label", {}, make("span", {}, "colours "), select);
};

const keysHelp = () => {
  const list = make("dl", {}, ...KEYS.flatMap(([key, meaning]) => [make("dt", {}, key), make("dd", {}, meaning)]));
  return popover("keys", list);
};

const setUpToolbar = () => {
  const bar = make("div", { class: "toolbar", role: "group", "aria-label": "view of this page" });
  if (series.names.length) bar.append(seriesSwitches());
  bar.append(choiceLabel(), differsSwitch(), make("span", { class: "gap" }), button("reset", "everything as at first", resetAll), themeSelect(), keysHelp());
  const main = document.querySelector("main");
  if (main) main.before(bar);
  else document.body.prepend(bar);
};
