// Small helpers of every page.

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

/** What an element says, its spaces as a reader sees them. */
const textOf = (element) => element.textContent.trim().replace(/\s+/g, " ");

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

/** Hands a text or a blob to the reader as a file. */
const download = (name, type, text) => {
  const url = URL.createObjectURL(text instanceof Blob ? text : new Blob([text], { type }));
  const link = make("a", { href: url, download: name.replace(/[^\w.-]+/g, "_") });
  document.body.append(link);
  link.click();
  link.remove();
  // Some browsers read the file only after the click has ended.
  setTimeout(() => URL.revokeObjectURL(url), 10000);
};

/** One cell by RFC 4180; `'` stands before what a spreadsheet would run as a formula, and before what has it there already. */
const csvCell = (text) => {
  const safe = /^'*[=+\-@\t\r\n]/.test(text) && !Number.isFinite(Number(text)) ? `'${text}` : text;
  return /[",\r\n]/.test(safe) ? `"${safe.replace(/"/g, '""')}"` : safe;
};
