// What is chosen on the page, kept in the part of the address after "#".

/** Numbers of a text that somebody may have written by hand, or null. */
const numbers = (text, count) => {
  const found = String(text || "").split(/[\s,]+/).filter(Boolean).map(Number);
  return found.length === count && found.every(Number.isFinite) ? found : null;
};

const short = (value) => String(Number(value.toPrecision(6)));

const view = {
  parts: new Map(),
  anchor: "",
  written: "",
  timer: 0,
  restoring: false,
};

/** Has the address hold what `get` says; an empty text is what a fresh page shows, and `set` takes either. */
const keep = (key, get, set) => view.parts.set(key, { get, set });

// Commas and colons stay readable: an address is something that people look at.
const encode = (text) => encodeURIComponent(text).replace(/%2C/g, ",").replace(/%3A/g, ":");

const decode = (text) => {
  try {
    return decodeURIComponent(text);
  } catch {
    return "";
  }
};

const hash = () => {
  const pieces = view.anchor ? [encode(view.anchor)] : [];
  for (const [key, { get }] of view.parts) {
    const value = get();
    if (value) pieces.push(`${encode(key)}=${encode(value)}`);
  }
  return pieces.length ? `#${pieces.join("&")}` : "";
};

const write = () => {
  clearTimeout(view.timer);
  view.timer = 0;
  view.written = hash();
  if (view.written !== location.hash) history.replaceState(null, "", view.written || location.pathname + location.search);
};

/** Browsers refuse an address that changes with every turn of the wheel: it is written when things are quiet. */
const changed = () => {
  if (view.restoring) return;
  clearTimeout(view.timer);
  view.timer = setTimeout(write, 350);
};

const restore = () => {
  const values = new Map();
  view.anchor = "";
  for (const piece of location.hash.slice(1).split("&")) {
    const at = piece.indexOf("=");
    if (at < 0) view.anchor = view.anchor || decode(piece);
    else values.set(decode(piece.slice(0, at)), decode(piece.slice(at + 1)));
  }
  view.restoring = true;
  for (const [key, { set }] of view.parts) set(values.get(key) || "");
  view.restoring = false;
  view.written = location.hash;
};

/** As a fresh page, but for the theme. */
const resetAll = () => {
  for (const [key, { set }] of view.parts) if (key !== "theme") set("");
  changed();
};

const goTo = (id) => {
  const target = id && document.getElementById(id);
  if (!target) return false;
  target.scrollIntoView();
  if (!target.hasAttribute("tabindex")) target.setAttribute("tabindex", "-1");
  target.focus({ preventScroll: true });
  return true;
};

/** Links within the page would wipe what the address holds: they are followed here. */
const followLinks = () => {
  document.addEventListener("click", (event) => {
    const link = event.target.closest('a[href^="#"]');
    if (!link || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const id = decode(link.getAttribute("href").slice(1));
    if (!goTo(id)) return;
    event.preventDefault();
    write();
    view.anchor = id;
    view.written = hash();
    history.pushState(null, "", view.written);
  });
  window.addEventListener("hashchange", () => {
    if (location.hash === view.written) return;
    restore();
    goTo(view.anchor);
  });
  window.addEventListener("pagehide", () => view.timer && write());
};
