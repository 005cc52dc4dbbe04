// Series, say the methods that are compared: each can be taken off the page.

const series = { names: [], known: new Set(), hidden: new Set(), elements: [], told: [] };

const isOff = (name) => series.hidden.has(name);

const applySeries = () => {
  for (const element of series.elements) {
    const off = isOff(element.dataset.series);
    element.classList.toggle(element.closest(".legend") ? "faint" : "off", off);
  }
  series.told.forEach((tell) => tell());
  changed();
};

const switchSeries = (name) => {
  if (!series.hidden.delete(name)) series.hidden.add(name);
  hideTip();
  applySeries();
};

/** Hides all, or none. */
const hideSeries = (names) => {
  series.hidden = new Set(names);
  hideTip();
  applySeries();
};

const OF_METHODS = /^(method|operator)$/;

/** Drawings have their series as places in a list; rows of tables belong to those that their column of methods names. */
const nameSeries = () => {
  for (const marks of all(".marks[data-of]")) {
    const names = fields(marks.dataset.of);
    for (const group of all("[data-m]", marks)) group.dataset.series = names[group.dataset.m];
  }
  const drawn = new Set(all("[data-series]").map((element) => element.dataset.series));
  for (const table of all("table.data")) {
    const column = [...table.tHead.rows[0].cells].findIndex((head) => OF_METHODS.test(textOf(head)));
    if (column < 0) continue;
    for (const row of table.tBodies[0].rows) {
      const name = row.cells[column] ? textOf(row.cells[column]) : "";
      if (drawn.has(name)) row.dataset.series = name;
    }
  }
};

const setUpSeries = () => {
  nameSeries();
  series.elements = all("[data-series]");
  series.names = [...new Set(series.elements.map((element) => element.dataset.series))];
  series.known = new Set(series.names);
  for (const entry of all(".legend [data-series]")) entry.addEventListener("click", () => switchSeries(entry.dataset.series));
  // By number, as names may hold anything.
  const get = () => series.names.map((name, index) => (isOff(name) ? index : "")).filter((index) => index !== "").join(",");
  keep("off", get, (text) => {
    series.hidden = new Set(text.split(",").filter(Boolean).map((index) => series.names[index]).filter((name) => name !== undefined));
    applySeries();
  });
};
