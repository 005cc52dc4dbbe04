// What was measured: from files, and from the server.

/** Rows of all files: `photo`, `name`, `x` and `y` (null where there is no position), `covariance`, `reason`, `method`, `file`. */
const measured = { rows: [], files: [] };

const short = (name) => name.split(/[/\\]/).pop();

/** The photograph that points call so, or -1. */
const photoCalled = (name) => {
  const exact = photos.findIndex((photo) => photo.name === name);
  if (exact >= 0) return exact;
  const near = photos.flatMap((photo, index) => (short(photo.name) === short(name) ? [index] : []));
  return near.length === 1 ? near[0] : -1;
};

/** What the reasons of our operators mean. */
const meanings = new Map(Object.entries(content.reasons));

/** Why there is no position, in words; what a method of somebody else's calls its reason stands as it is. */
const whyLost = (status, code, meaning = meanings.get(code)) => [status, [code, meaning].filter(Boolean).join(", ")].filter(Boolean).join(": ") || "no position";

const number = (text) => (text === undefined || text === "" ? null : Number(text));

const readRow = (row, file) => {
  const [x, y] = [number(row.x), number(row.y)];
  const there = x !== null && y !== null && Number.isFinite(x) && Number.isFinite(y);
  const covariance = [row.sxx, row.sxy, row.syy].map(number);
  return {
    photo: photoCalled(row.image),
    name: row.target,
    x: there ? x : null,
    y: there ? y : null,
    covariance: covariance.every((value) => value !== null && Number.isFinite(value)) ? covariance : null,
    reason: there ? "" : whyLost(row.status, row.reason),
    method: row.method || "",
    file,
  };
};

/** Shows a file of measured points; one without results are points, which are pointed at. Returns what it did, in words. */
const load = (name, text, asMeasured) => {
  const { names, rows } = csvTable(text, ["image", "target", "x", "y"]);
  const read = rows.map((row) => readRow(row, name));
  const own = read.filter((row) => row.photo >= 0);
  const others = read.length - own.length;
  const words = others ? `; ${others} of other photographs` : "";
  if (asMeasured || names.includes("status") || names.includes("sxx")) {
    measured.rows = [...measured.rows.filter((row) => row.file !== name), ...own];
    if (!measured.files.includes(name)) measured.files.push(name);
    return `${name}: ${own.length} measured points${words}`;
  }
  const there = own.filter((row) => row.x !== null);
  change(there.map(({ photo, name: target, x, y }) => ({ photo, name: target, before: state.points[photo].get(target) || null, after: { x: rounded(x), y: rounded(y) } })));
  return `${name}: ${there.length} points${words}`;
};

/** Everything that was measured in a photograph. */
const measuredIn = (photo) => [...measured.rows.filter((row) => row.photo === photo), ...served.rows(photo)];

/** Half axes and direction of the ellipse of one standard deviation, px. */
const ellipseOf = ([sxx, sxy, syy]) => {
  const [half, apart] = [(sxx + syy) / 2, Math.hypot((sxx - syy) / 2, sxy)];
  return { a: Math.sqrt(half + apart), b: Math.sqrt(Math.max(half - apart, 0)), angle: Math.atan2(2 * sxy, sxx - syy) / 2 };
};

const loadWritten = () => content.measured.forEach(({ name, text }) => load(name, text, true));
