// Begins everything, in the order in which the parts build on each other.

const start = () => {
  document.documentElement.classList.add("script");
  setUpSeries();
  setUpChoice();
  setUpToolbar();
  setUpTables();
  setUpPlots();
  // Left out of pages without an explorer or a scene.
  if (typeof setUpExplorer === "function") setUpExplorer();
  if (typeof setUpScenes === "function") setUpScenes();
  document.body.append(tip);
  followLinks();
  restore();
  const [entry] = performance.getEntriesByType("navigation");
  // A reload stays where the reader was.
  if (view.anchor && (!entry || entry.type === "navigate")) goTo(view.anchor);
};

if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", start);
else start();
