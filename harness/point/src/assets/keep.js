// Where points are kept: by the server, on the disk, of which the browser has a copy; or, where the page is a file, by the browser. Others may change them, too: what was changed
// here is merged by target into what is there.

/** Of each photograph: what was changed here and is not kept yet, places or null by name. */
const unkept = photos.map(() => new Map());

const kept = {
  works: true,
  /** Why the server could not keep them, in its words. */
  why: "",
  /** What the server said of the state that is known. */
  revision: null,
  sending: false,
};

const KEY = `calibench-point-${content.key}`;

/** What the browser has: the view, and of each photograph `[name, x, y]`; null where it has nothing. */
const copy = () => {
  try {
    const found = JSON.parse(localStorage.getItem(KEY));
    return found && Array.isArray(found.points) ? found : null;
  } catch {
    kept.works = false;
    return null;
  }
};

/** Browsers may refuse to keep anything: the page works without. */
const writeCopy = () => {
  const { photo, target, factor } = state;
  const points = state.points.map((named) => [...named].map(([name, { x, y }]) => [name, x, y]));
  const waiting = unkept.map((named) => [...named].map(([name, place]) => [name, place && [place.x, place.y]]));
  try {
    localStorage.setItem(KEY, JSON.stringify({ photo, target, factor, points, waiting: content.method === null ? [] : waiting }));
    kept.works = true;
  } catch {
    kept.works = false;
  }
};

const isPlace = (x, y) => Number.isFinite(x) && Number.isFinite(y);

/** Takes over what is kept elsewhere, but for what was changed here since, or is being dragged. */
const adopt = (rows) => photos.forEach((_, photo) => {
  const before = state.points[photo];
  const now = new Map();
  for (const [name, x, y] of rows[photo] || []) {
    if (typeof name !== "string" || !isPlace(x, y)) continue;
    const place = before.get(name);
    // The same place stays the same: what was measured there is still of it.
    now.set(name, place && place.x === x && place.y === y ? place : { x, y });
  }
  unkept[photo].forEach((place, name) => (place ? now.set(name, place) : now.delete(name)));
  const { drag } = pointer;
  if (drag && drag.name && photo === state.photo && before.has(drag.name)) now.set(drag.name, before.get(drag.name));
  const changed = [...new Set([...before.keys(), ...now.keys()])].filter((name) => before.get(name) !== now.get(name));
  state.points[photo] = now;
  if (photo === state.photo && state.chosen !== null && !now.has(state.chosen)) state.chosen = null;
  changed.forEach((name) => told.forEach((listener) => listener(photo, name)));
});

/** In a page that is a file: into what the browser has by now. */
const keepInBrowser = () => {
  const found = copy();
  if (found) adopt(found.points);
  writeCopy();
  if (kept.works) unkept.forEach((named) => named.clear());
};

/** Sends what was changed, and takes over what others changed; one at a time. */
const exchange = async () => {
  if (kept.sending) return;
  kept.sending = true;
  const sent = unkept.flatMap((named, photo) => [...named].map(([name, place]) => [photo, name, place]));
  const changes = sent.map(([photo, name, place]) => [photo, name, place && [place.x, place.y]]);
  const answer = await ask("points", { since: kept.revision, changes });
  kept.sending = false;
  if (answer && answer.revision !== undefined) {
    kept.why = "";
    sent.forEach(([photo, name, place]) => unkept[photo].get(name) === place && unkept[photo].delete(name));
    if (answer.points) adopt(answer.points);
    kept.revision = answer.revision;
  } else if (answer) kept.why = answer.reason;
  writeCopy();
  show();
  if (answer && !kept.why && unkept.some((named) => named.size)) keep();
};

const keep = whenQuiet(150, () => {
  if (content.method === null) return keepInBrowser();
  writeCopy();
  return exchange();
});

/** How often others are asked for, ms. */
const OTHERS = 2000;

const restore = () => {
  const found = copy();
  if (found) {
    if (photos[found.photo]) state.photo = found.photo;
    if (typeof found.target === "string") state.target = found.target;
    if (found.factor > 0) state.factor = found.factor;
    // What the server has not got: it had ended.
    (found.waiting || []).slice(0, photos.length).forEach((rows, photo) => {
      for (const [name, place] of rows) if (place === null || isPlace(...place)) unkept[photo].set(name, place && { x: place[0], y: place[1] });
    });
    adopt(found.points);
  }
  if (content.method === null) {
    // Another tab with this page.
    window.addEventListener("storage", ({ key, newValue }) => {
      if (key !== KEY || newValue === null) return;
      const other = copy();
      if (other) adopt(other.points);
      show();
    });
    return;
  }
  exchange();
  setInterval(() => document.hidden || exchange(), OTHERS);
};
