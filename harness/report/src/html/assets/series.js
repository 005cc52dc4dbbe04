// Series, say the methods that are compared: each can be taken off the page.

const series = { names: [], hidden: new Set(), elements: [], told: [] };

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

const setUpSeries = () => {
  series.elements = all("[data-series]");
  series.names = [...new Set(series.elements.map((element) => element.dataset.series))];
  for (const entry of all(".legend [data-series]")) entry.addEventListener("click", () => switchSeries(entry.dataset.series));
  // By number, as names may hold anything.
  const get = () => series.names.map((name, index) => (isOff(name) ? index : "")).filter((index) => index !== "").join(",");
  keep("off", get, (text) => {
    series.hidden = new Set(text.split(",").filter(Boolean).map((index) => series.names[index]).filter((name) => name !== undefined));
    applySeries();
  });
};
