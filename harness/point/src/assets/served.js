// What the server is asked for: measurements and predictions. In a page that is a file nothing is asked for.

const served = {
  on: content.method !== null,
  lost: false,
  /** Of each photograph, by name: `from` (the place that was pointed at) and the row of what was measured there. */
  found: photos.map(() => new Map()),
  /** Of each photograph: places by name, and in words how they were predicted. */
  predicted: photos.map(() => ({ targets: new Map(), how: "" })),
  active: false,
  rows: (photo) => [...served.found[photo].values()].flatMap(({ row }) => (row ? [row] : [])),
};

const ask = async (what, body) => {
  try {
    const text = JSON.stringify(body);
    // Sent even where the page is left; browsers take no more than 64 kB of that.
    const answer = await fetch(what, { method: "POST", headers: { "Content-Type": "application/json" }, body: text, keepalive: text.length < 60000 });
    served.lost = false;
    return answer.ok ? await answer.json() : { status: "unavailable", reason: (await answer.text()).trim() };
  } catch {
    served.lost = true;
    show();
    return null;
  }
};

const measure = async (photo, name) => {
  const from = state.points[photo].get(name);
  if (!from) return;
  served.found[photo].set(name, { from, row: null });
  const answer = await ask("measure", { photo, x: from.x, y: from.y });
  const waiting = served.found[photo].get(name);
  // Moved or deleted in the meantime.
  if (!waiting || waiting.from !== from) return;
  if (!answer) {
    served.found[photo].delete(name);
    return;
  }
  const there = answer.status === "measured";
  waiting.row = {
    photo,
    name,
    x: there ? answer.x : null,
    y: there ? answer.y : null,
    covariance: answer.covariance || null,
    status: answer.status,
    code: answer.reason || "",
    reason: there ? "" : whyLost(answer.status, answer.reason, answer.meaning),
    method: answer.method || content.method,
    file: "",
  };
  if (photo === state.photo) tell(there ? `${name} measured at ${shortened(answer.x)}, ${shortened(answer.y)}` : `${name} ${waiting.row.reason}`);
  show();
  predictSoon();
};

/** The best that is known of where a target is. */
const placeOf = (photo, name) => {
  const found = served.found[photo].get(name);
  const row = found && found.row;
  return row && row.x !== null ? row : state.points[photo].get(name);
};

const predictNow = async () => {
  const { photo } = state;
  const points = [...state.points[photo].keys()].filter((name) => content.targets.includes(name)).map((name) => {
    const { x, y } = placeOf(photo, name);
    return [name, x, y];
  });
  const answer = content.targets.length ? await ask("predict", { photo, points }) : null;
  if (!answer || !answer.targets) return;
  const targets = new Map(answer.targets.map(([name, x, y]) => [name, { x, y }]));
  served.predicted[photo] = { targets, how: answer.how };
  show();
};
const predictSoon = whenQuiet(120, predictNow);

/** Points at everything that is predicted, as one change. */
const takePredicted = () => {
  const { photo } = state;
  const free = [...served.predicted[photo].targets].filter(([name]) => !here().has(name));
  change(free.map(([name, { x, y }]) => ({ photo, name, before: null, after: { x: rounded(x), y: rounded(y) } })));
  state.target = nextName(state.target);
  tell(`${free.length} points taken over`);
};

/** Measures what is pointed at in the photograph and was not yet. */
const catchUp = () => {
  if (!served.on) return;
  const { photo } = state;
  for (const [name, place] of here()) {
    const found = served.found[photo].get(name);
    if (!found || found.from !== place) measure(photo, name);
  }
  predictSoon();
};
const catchUpSoon = whenQuiet(80, catchUp);

const setUpServed = () => {
  if (!served.on) return;
  told.push((photo, name) => {
    if (!state.points[photo].has(name)) served.found[photo].delete(name);
    catchUpSoon();
  });
  // Whoever uses the page keeps the server.
  for (const kind of ["pointermove", "keydown", "pointerdown"]) document.addEventListener(kind, () => (served.active = true), { passive: true });
  setInterval(() => {
    if (served.active) ask("ping", {});
    served.active = false;
  }, 20000);
};

/** As `calibench measure` writes it. */
const measuredFile = () => {
  const rows = photos.flatMap((photo, index) => served.rows(index).map((row) => [
    photo.name, row.name, ...(row.x === null ? ["", ""] : [row.x, row.y]), ...(row.covariance || ["", "", ""]),
    ...(content.kind ? [content.kind] : []), row.method, row.status, row.code]));
  return csv([["image", "target", "x", "y", "sxx", "sxy", "syy", ...(content.kind ? ["kind"] : []), "method", "status", "reason"], ...rows]);
};
