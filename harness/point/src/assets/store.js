// What was pointed at, with its history.

const state = {
  photo: 0,
  /** The name that the next point gets. */
  target: "",
  /** Of each photograph: places by name, px. */
  points: photos.map(() => new Map()),
  /** The name of the point that is moved and deleted, or null. */
  chosen: null,
  /** How many times enlarged ellipses are. */
  factor: 100,
  done: [],
  undone: [],
};

const here = () => state.points[state.photo];

/** Called with the photograph and the name of each point that was set, moved or deleted. */
const told = [];

const put = ({ photo, name }, place) => {
  if (place) state.points[photo].set(name, place);
  else state.points[photo].delete(name);
  unkept[photo].set(name, place);
  told.forEach((listener) => listener(photo, name));
};

/** Carries out changes, each with `photo`, `name`, `before` and `after` (places or null), as one that is undone at once. */
const change = (changes) => {
  if (!changes.length) return;
  changes.forEach((one) => put(one, one.after));
  state.done.push(changes);
  state.undone = [];
  keep();
  show();
};

const step = (from, to, side, words) => {
  const changes = from.pop();
  if (!changes) return tell(`nothing to ${words}`);
  to.push(changes);
  const order = side === "before" ? [...changes].reverse() : changes;
  order.forEach((one) => put(one, one[side]));
  const [{ photo, name }] = changes;
  state.photo = photo;
  state.chosen = here().has(name) ? name : null;
  if (side === "before" && changes.length === 1 && !changes[0].before) state.target = name;
  keep();
  show();
  return tell(`${words}: ${name}`);
};

const undo = () => step(state.done, state.undone, "before", "undo");
const redo = () => step(state.undone, state.done, "after", "redo");

const place = (name, x, y) => {
  const before = here().get(name) || null;
  change([{ photo: state.photo, name, before, after: { x: rounded(x), y: rounded(y) } }]);
  state.chosen = name;
};

const remove = (name) => {
  const before = here().get(name);
  if (!before) return;
  change([{ photo: state.photo, name, before, after: null }]);
  if (state.chosen === name) state.chosen = null;
  state.target = name;
  tell(`${name} deleted`);
};

/** The name after `name` that is not pointed at in this photograph: in the order of the control, else a number higher. */
const nextName = (name) => {
  const { targets } = content;
  const from = targets.indexOf(name);
  if (targets.length && (from >= 0 || name === "")) {
    const order = [...targets.slice(from + 1), ...targets.slice(0, from + 1)];
    return order.find((one) => !here().has(one)) || "";
  }
  const [, stem, digits] = /^(.*?)(\d*)$/s.exec(name || "p0");
  for (let number = Number(digits || 0) + 1; ; number += 1) {
    const one = stem + String(number).padStart(digits.length, "0");
    if (!here().has(one)) return one;
  }
};

/** Points at an image coordinate under the name that is next; false where there is no name left. */
const pointAt = (x, y) => {
  const name = state.target.trim() || nextName("");
  if (!name) {
    tell("all targets are pointed at: choose one to move it, or type another name");
    return false;
  }
  place(name, x, y);
  state.target = nextName(name);
  keep();
  show();
  tell(`${name} at ${shortened(x)}, ${shortened(y)}; next ${state.target || "none"}`);
  return true;
};

const pointsFile = () => {
  const kind = content.kind ? [content.kind] : [];
  const rows = state.points.flatMap((named, index) => [...named].map(([name, { x, y }]) => [photos[index].name, name, x, y, ...kind]));
  return csv([["image", "target", "x", "y", ...(content.kind ? ["kind"] : [])], ...rows]);
};
