// Small helpers, and what the page was made of.

const all = (selector, root = document) => [...root.querySelectorAll(selector)];

/** A new element; children that are strings become text, never markup. */
const make = (tag, attributes = {}, ...children) => {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") node.addEventListener(name, value);
    else if (value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children);
  return node;
};

const button = (text, title, click) => make("button", { type: "button", title, click }, text);

const within = (value, low, high) => Math.min(Math.max(value, low), high);

/** Calls `work` once in the next frame, however often it is asked for. */
const oncePerFrame = (work) => {
  let asked = false;
  return () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      work();
    });
  };
};

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
