// What the page was made of, and what its parts have in common.

/** Calls `work` when it was not asked for during `pause` ms; `now` calls it at once if it is still to come. */
const whenQuiet = (pause, work) => {
  let timer = 0;
  const run = () => {
    timer = 0;
    work();
  };
  const ask = () => {
    clearTimeout(timer);
    timer = setTimeout(run, pause);
  };
  ask.now = () => {
    if (!timer) return;
    clearTimeout(timer);
    run();
  };
  return ask;
};

const content = JSON.parse(document.getElementById("content").textContent);
const { photos } = content;

/** A thousandth of a pixel is more than anybody points at. */
const rounded = (value) => Number(value.toFixed(3));
const shortened = (value) => value.toFixed(2);

const live = make("p", { class: "heard", role: "status", "aria-live": "polite" });
/** Tells those who listen to the page. */
const tell = (words) => {
  live.textContent = words;
};

/** Parts of the page that show something anew after a change. */
const shown = [];
const show = oncePerFrame(() => shown.forEach((part) => part()));
