// One group of the page, say an image, is chosen in all tables and drawings at once.

const chosen = { g: "", k: "", groups: new Map(), keys: new Map(), names: new Map(), patches: new Map(), told: [] };

const panel = make("aside", { class: "panel", "aria-label": "enlarged", "aria-live": "polite" });

const gather = (map, key, element) => map.has(key) ? map.get(key).push(element) : map.set(key, [element]);

const mark = (map, key, name, on) => (map.get(key) || []).forEach((element) => {
  element.classList.toggle(name, on);
  if (element.tagName !== "TR") return;
  if (on) element.setAttribute("aria-current", "true");
  else element.removeAttribute("aria-current");
});

const showPatch = (patch) => {
  panel.replaceChildren();
  panel.classList.toggle("shown", Boolean(patch));
  if (!patch) return;
  panel.append(button("×", "close (Escape)", () => choose("", "")), patch.cloneNode(true));
  panel.firstChild.setAttribute("aria-label", "close");
};

const choose = (g, k) => {
  mark(chosen.groups, chosen.g, "chosen", false);
  mark(chosen.keys, chosen.k, "picked", false);
  chosen.g = g;
  chosen.k = k;
  mark(chosen.groups, g, "chosen", true);
  mark(chosen.keys, k, "picked", true);
  document.body.classList.toggle("choosing", g !== "");
  showPatch(chosen.patches.get(k));
  chosen.told.forEach((tell) => tell());
  changed();
};

/** A click on the chosen once more undoes it. */
const toggle = (g, k) => (g === chosen.g && (k === chosen.k || !k) ? choose("", "") : choose(g, k));

const pick = (element) => {
  const [group, key] = [element.closest("[data-g]"), element.closest("[data-k]")];
  if (group || key) toggle(group ? group.dataset.g : "", key ? key.dataset.k : "");
};

/** How a group is called: by the first cell of its row, or by what its first mark says. */
const nameOfGroup = (g) => {
  const elements = chosen.groups.get(g) || [];
  const row = elements.find((element) => element.tagName === "TR");
  if (row && row.cells.length) return row.cells[0].textContent.trim();
  const told = elements.find((element) => element.dataset.t);
  return told ? fields(told.dataset.t)[0] : chosen.names.get(g) || g;
};

const setUpChoice = () => {
  for (const element of all("[data-g]")) gather(chosen.groups, element.dataset.g, element);
  for (const element of all("[data-k]")) {
    if (element.matches(".patch")) chosen.patches.set(element.dataset.k, element);
    else gather(chosen.keys, element.dataset.k, element);
  }
  document.body.append(panel);
  document.addEventListener("click", (event) => {
    // Drawings find what is nearest themselves; a text that is being selected is no click.
    if (event.target.closest("a, button, input, select, summary, label, .surface, .panel") || String(getSelection())) return;
    const element = event.target.closest("[data-g], [data-k]");
    if (element) pick(element);
  });
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || event.defaultPrevented) return;
    hideTip();
    if (chosen.g || chosen.k) choose("", "");
  });
  keep("g", () => chosen.g, (g) => choose(chosen.groups.has(g) ? g : "", chosen.k));
  keep("k", () => chosen.k, (k) => choose(chosen.g, chosen.keys.has(k) ? k : ""));
};
