// Beside the photograph: names, what was pointed at, files.

const KEY_HELP = [
  ["click", "point at a target; on a point: choose it"],
  ["drag", "move the photograph, or a point"],
  ["wheel, + −", "zoom; 0: all, 1: pixel by pixel"],
  ["arrows", "move the chosen point by 1 px, with Shift by 0.1 px; without one the photograph"],
  ["W A S D", "move the photograph"],
  ["Enter, space", "point at the cross in the middle"],
  [", .", "the point before, after"],
  ["Delete", "delete the chosen point"],
  ["Escape", "choose none"],
  ["[ ]", "the photograph before, after"],
  ["N", "the name of the next target"],
  ["Ctrl+Z, Ctrl+Y", "undo, redo"],
];

const nameInput = make("input", { type: "text", id: "name", list: "names", autocomplete: "off", spellcheck: "false" });
const nameList = make("datalist", { id: "names" });
const problem = make("p", { class: "problem", role: "alert" });
const words = make("p", { class: "words" });
const about = make("p", { class: "about" });
const rows = make("tbody");

const photoSelect = () => {
  const select = make("select", { "aria-label": "photograph", change: () => switchPhoto(Number(select.value)) });
  photos.forEach((photo, index) => select.append(make("option", { value: index }, photo.name)));
  const [before, after] = [button("‹", "the photograph before", () => switchPhoto(state.photo - 1)), button("›", "the photograph after", () => switchPhoto(state.photo + 1))];
  shown.push(() => {
    select.value = String(state.photo);
    [before.disabled, after.disabled] = [state.photo === 0, state.photo === photos.length - 1];
    about.textContent = `${photos[state.photo].width} x ${photos[state.photo].height} px, ${photos[state.photo].shown}`;
  });
  return make("div", { class: "tools photos" }, before, select, after);
};

const viewTools = () => {
  const [back, again] = [button("undo", "undo (Ctrl+Z)", undo), button("redo", "redo (Ctrl+Y)", redo)];
  const gone = button("delete", "delete the chosen point (Delete)", () => state.chosen !== null && remove(state.chosen));
  shown.push(() => {
    [back.disabled, again.disabled] = [!state.done.length, !state.undone.length];
    gone.disabled = state.chosen === null;
  });
  const list = make("dl", {}, ...KEY_HELP.flatMap(([key, meaning]) => [make("dt", {}, key), make("dd", {}, meaning)]));
  const help = make("details", { class: "keys" }, make("summary", {}, "keys"), list);
  document.addEventListener("click", (event) => help.contains(event.target) || help.removeAttribute("open"));
  help.addEventListener("keydown", (event) => event.key === "Escape" && help.removeAttribute("open"));
  return make("div", { class: "tools" }, button("−", "zoom out", () => zoom(1 / 1.5)), button("+", "zoom in", () => zoom(1.5)),
    button("all", "the whole photograph", fit), button("1:1", "pixel by pixel", () => zoom(1 / viewNow().scale)), back, again, gone, help);
};

const nameTools = () => {
  nameInput.addEventListener("input", () => {
    state.target = nameInput.value;
    keep();
  });
  nameInput.addEventListener("keydown", (event) => {
    if (event.key === "Enter") canvas.focus();
  });
  const skip = button("skip", "propose the target after this one", () => {
    state.target = nextName(state.target.trim());
    keep();
    show();
  });
  const left = make("span", { class: "count" });
  shown.push(() => {
    if (nameInput.value !== state.target) nameInput.value = state.target;
    const free = content.targets.filter((name) => !here().has(name));
    nameList.replaceChildren(...free.map((name) => make("option", { value: name })));
    left.textContent = content.targets.length ? `${content.targets.length - free.length} of ${content.targets.length}` : `${here().size} points`;
  });
  return make("div", { class: "tools" }, make("label", { for: "name" }, "next target"), nameInput, nameList, skip, left);
};

/** Rows of a table by name: pointed, measured, or neither. */
const byName = () => {
  const found = new Map([...here()].map(([name, pointed]) => [name, { pointed, measured: [] }]));
  for (const row of measuredIn(state.photo)) {
    if (!found.has(row.name)) found.set(row.name, { pointed: null, measured: [] });
    found.get(row.name).measured.push(row);
  }
  return found;
};

const outcome = (row, pointed) => {
  if (row.x === null) return `✕ ${row.reason}`;
  const sigma = row.covariance ? `, ±${Math.sqrt(row.covariance[0]).toFixed(3)} ${Math.sqrt(row.covariance[2]).toFixed(3)}` : "";
  const place = pointed ? `${(row.x - pointed.x).toFixed(2)} ${(row.y - pointed.y).toFixed(2)} from the point` : `${shortened(row.x)} ${shortened(row.y)}`;
  return `+ ${place}${sigma}`;
};

const MOST_ROWS = 500;

const tableRow = ([name, { pointed, measured: results }]) => {
  const at = pointed || results.find((row) => row.x !== null);
  const go = button(name, "choose it and look at it", () => {
    if (pointed) choose(name);
    if (at) lookAt(at);
  });
  const cells = [make("td", { class: "n" }, pointed ? shortened(pointed.x) : ""), make("td", { class: "n" }, pointed ? shortened(pointed.y) : "")];
  const said = make("td", { class: results.some((row) => row.x === null) ? "found lost" : "found" });
  results.forEach((row) => said.append(make("div", { title: [row.method, row.file].filter(Boolean).join(", ") }, outcome(row, pointed))));
  const gone = pointed ? button("×", "delete", () => remove(name)) : "";
  if (gone) gone.setAttribute("aria-label", `delete ${name}`);
  return make("tr", { class: name === state.chosen ? "chosen" : undefined }, make("th", { scope: "row" }, go), ...cells, said, make("td", {}, gone));
};

const pointTable = () => {
  shown.push(() => rows.replaceChildren(...[...byName()].slice(0, MOST_ROWS).map(tableRow)));
  const head = ["target", "x, px", "y, px", "measured, px", ""].map((name) => make("th", { scope: "col" }, name));
  return make("div", { class: "table points" }, make("table", {}, make("caption", { class: "heard" }, "points of this photograph"), make("thead", {}, make("tr", {}, ...head)), rows));
};

const fileTools = () => {
  const read = async (files) => {
    const [said, wrong] = [[], []];
    for (const file of files) {
      try {
        said.push(load(file.name, await file.text(), false));
      } catch (error) {
        wrong.push(`${file.name}: ${error.message}`);
      }
    }
    [words.textContent, problem.textContent] = [said.join("; "), wrong.join("; ")];
    show();
  };
  const chooser = make("input", { type: "file", id: "files", class: "heard", accept: ".csv,text/csv", multiple: "", change: () => {
    read([...chooser.files]);
    chooser.value = "";
  } });
  const save = button("save points", "image,target,x,y as CSV, for calibench measure --points", () => download("points.csv", "text/csv", pointsFile()));
  save.classList.add("main");
  const factor = make("select", { "aria-label": "ellipses", change: () => {
    state.factor = Number(factor.value);
    keep();
    show();
  } });
  [1, 10, 30, 100, 300, 1000].forEach((times) => factor.append(make("option", { value: times }, `ellipses × ${times}`)));
  shown.push(() => (factor.value = String(state.factor)));
  const bar = make("div", { class: "tools" }, save, button("open file", "points or measured points, CSV", () => chooser.click()), chooser, factor);
  if (served.on) {
    const take = button("take predicted", "point at all predicted targets of this photograph", takePredicted);
    shown.push(() => (take.disabled = ![...served.predicted[state.photo].targets.keys()].some((name) => !here().has(name))));
    bar.append(button("save measured", "as calibench measure writes them", () => download("measured.csv", "text/csv", measuredFile())), take);
  }
  return bar;
};

const LEGEND = [["pointed", "pointed"], ["measured", "measured, with the ellipse of one standard deviation, enlarged"], ["rejected", "not measured"], ["predicted", "predicted"]];

const legend = () => {
  const item = ([shape, text]) => {
    const icon = make("canvas", { class: "swatch", width: "26", height: "26", "aria-hidden": "true" });
    mark(icon.getContext("2d"), shape, [13, 13]);
    return make("li", {}, icon, make("span", {}, text));
  };
  return make("ul", { class: "legend" }, ...LEGEND.filter(([shape]) => served.on || shape !== "predicted").map(item));
};

const notes = () => {
  const how = make("p", { class: "how" });
  shown.push(() => {
    const lines = [];
    if (served.on) lines.push(`Each point is measured by ${content.method}.`, served.predicted[state.photo].how && `${served.predicted[state.photo].how}.`);
    if (measured.files.length) lines.push(`Shown: ${measured.files.join(", ")}.`);
    if (served.lost) lines.push("The server has ended: points stay here, save them.");
    if (kept.why) lines.push(`Points are not kept on the disk: ${kept.why}. Save them.`);
    const nowhere = !kept.works && !served.on;
    if (nowhere) lines.push("This browser keeps nothing: save the points before the page is closed.");
    how.textContent = lines.filter(Boolean).join(" ");
    how.classList.toggle("problem", Boolean(served.lost || kept.why || nowhere));
  });
  return how;
};

const setUpPanel = () => {
  const side = make("aside", { "aria-label": "points" }, nameTools(), make("div", { class: "near" }, loupe.canvas, loupe.words), notes(), pointTable(), fileTools(), words, problem, legend());
  const left = make("div", { class: "left" }, photoSelect(), viewTools(), stage, about);
  document.querySelector("main").append(left, side, live);
};
