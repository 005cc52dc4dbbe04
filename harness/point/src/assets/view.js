// The photograph with what is known of its points.

const canvas = make("canvas", { class: "photo", tabindex: "0", role: "application", "aria-label": "photograph: arrows move it, plus and minus zoom, Enter points at the cross in the middle" });
const stage = make("div", { class: "stage" }, canvas);

/** Of each photograph what is in the middle, px of the image, and CSS px for one of them; null until it was looked at. */
const views = photos.map(() => null);

const stageSize = () => [canvas.clientWidth || 1, canvas.clientHeight || 1];

const fitScale = () => {
  const [width, height] = stageSize();
  const photo = photos[state.photo];
  return Math.min(width / photo.width, height / photo.height);
};

const fit = () => {
  const photo = photos[state.photo];
  views[state.photo] = { x: (photo.width - 1) / 2, y: (photo.height - 1) / 2, scale: fitScale() };
  drawAll();
};

const viewNow = () => {
  if (!views[state.photo]) fit();
  return views[state.photo];
};

const MOST_ZOOM = 64;

const toImage = (sx, sy) => {
  const [width, height] = stageSize();
  const { x, y, scale } = viewNow();
  return [x + (sx - width / 2) / scale, y + (sy - height / 2) / scale];
};

const toStage = (x, y) => {
  const [width, height] = stageSize();
  const view = viewNow();
  return [(x - view.x) * view.scale + width / 2, (y - view.y) * view.scale + height / 2];
};

const moveTo = (x, y) => {
  const photo = photos[state.photo];
  const view = viewNow();
  [view.x, view.y] = [within(x, -0.5, photo.width - 0.5), within(y, -0.5, photo.height - 0.5)];
  drawAll();
};

const pan = (dx, dy) => {
  const view = viewNow();
  moveTo(view.x - dx / view.scale, view.y - dy / view.scale);
};

/** Zooms so that what is at a place of the stage stays there. */
const zoom = (factor, sx = stageSize()[0] / 2, sy = stageSize()[1] / 2) => {
  const [x, y] = toImage(sx, sy);
  const [width, height] = stageSize();
  const view = viewNow();
  view.scale = within(view.scale * factor, Math.min(fitScale(), 1) / 2, MOST_ZOOM);
  moveTo(x - (sx - width / 2) / view.scale, y - (sy - height / 2) / view.scale);
};

/** Has a place in view, near enough to see it. */
const lookAt = ({ x, y }) => {
  viewNow().scale = Math.max(viewNow().scale, 2);
  moveTo(x, y);
};

// On photographs, whatever the theme; shapes differ, too. Each line has a dark one below it.
const COLOURS = { pointed: "#ffb000", measured: "#5cc8ff", rejected: "#ff5db1", predicted: "#ffffff" };

const stroke = (context, path, colour, width = 1.6) => {
  context.strokeStyle = "#000b";
  context.lineWidth = width + 2;
  context.stroke(path);
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke(path);
};

const FONT = 12;

/** Names beside their marks, none on another: each goes to the first of four sides that is free, and is left out where none is. */
class Labels {
  constructor(context) {
    this.context = context;
    this.wanted = [];
  }

  /** `rank`: the lower the sooner. */
  add(rank, name, at, aside, colour) {
    this.wanted.push({ rank, text: name.length > 24 ? `${name.slice(0, 23)}…` : name, at, aside, colour });
  }

  draw(width, height) {
    const { context } = this;
    context.font = `600 ${FONT}px system-ui, sans-serif`;
    context.lineJoin = "round";
    context.lineWidth = 3.5;
    context.strokeStyle = "#000c";
    const taken = [];
    for (const { text, at: [x, y], aside, colour } of this.wanted.sort((a, b) => a.rank - b.rank)) {
      if (x < -aside || y < -aside || x > width + aside || y > height + aside) continue;
      const wide = context.measureText(text).width;
      const sides = [[x + aside, y - aside], [x + aside, y + aside + FONT / 2], [x - aside - wide, y - aside], [x - aside - wide, y + aside + FONT / 2]];
      const box = ([left, base]) => ({ left, right: left + wide, top: base - FONT, bottom: base + 2 });
      const free = (one) => taken.every((other) => one.left >= other.right || one.right <= other.left || one.top >= other.bottom || one.bottom <= other.top);
      const inside = (one) => one.left >= 0 && one.right <= width && one.top >= 0 && one.bottom <= height;
      const place = sides.find((side) => inside(box(side)) && free(box(side))) || sides.find((side) => free(box(side)));
      if (!place) continue;
      taken.push(box(place));
      context.strokeText(text, ...place);
      context.fillStyle = colour;
      context.fillText(text, ...place);
    }
  }
}

const SHAPES = {
  /** A ring and four strokes that leave the place itself free. */
  pointed: (x, y, chosen) => {
    const [inner, outer] = chosen ? [5, 15] : [5, 10];
    return `M${x - 7} ${y}a7 7 0 1 0 14 0a7 7 0 1 0 -14 0M${x - outer} ${y}H${x - inner}M${x + inner} ${y}H${x + outer}M${x} ${y - outer}V${y - inner}M${x} ${y + inner}V${y + outer}`;
  },
  measured: (x, y) => `M${x - 4} ${y}H${x + 4}M${x} ${y - 4}V${y + 4}`,
  rejected: (x, y) => `M${x - 9} ${y - 9}H${x + 9}V${y + 9}H${x - 9}ZM${x - 9} ${y - 9}L${x + 9} ${y + 9}M${x - 9} ${y + 9}L${x + 9} ${y - 9}`,
  predicted: (x, y) => `M${x} ${y - 9}L${x + 9} ${y}L${x} ${y + 9}L${x - 9} ${y}Z`,
};

const mark = (context, shape, [x, y], chosen) => stroke(context, new Path2D(SHAPES[shape](x, y, chosen)), COLOURS[shape], chosen ? 2.4 : 1.6);

const drawEllipse = (context, row, [sx, sy], scale) => {
  const { a, b, angle } = ellipseOf(row.covariance);
  const path = new Path2D();
  path.ellipse(sx, sy, a * state.factor * scale, b * state.factor * scale, angle, 0, 2 * Math.PI);
  stroke(context, path, COLOURS.measured, 1.2);
};

/** Everything that is known of points, with `labels` for their names, or without. */
const drawPoints = (context, project, scale, labels) => {
  const rows = measuredIn(state.photo);
  const { targets } = served.predicted[state.photo];
  for (const [name, place] of targets) {
    if (here().has(name)) continue;
    const at = project(place.x, place.y);
    mark(context, "predicted", at);
    if (labels) labels.add(3, name, at, 12, COLOURS.predicted);
  }
  for (const row of rows) {
    const pointed = here().get(row.name);
    if (row.x === null) {
      if (pointed) mark(context, "rejected", project(pointed.x, pointed.y));
      continue;
    }
    const at = project(row.x, row.y);
    if (row.covariance) drawEllipse(context, row, at, scale);
    mark(context, "measured", at);
    if (labels && !pointed) labels.add(2, row.name, at, 8, COLOURS.measured);
  }
  for (const [name, place] of here()) {
    const at = project(place.x, place.y);
    mark(context, "pointed", at, name === state.chosen);
    if (labels) labels.add(name === state.chosen ? 0 : 1, name, at, 10, COLOURS.pointed);
  }
};

/** A canvas with as many pixels as the screen has there, and what draws on it in CSS px. */
const prepared = (surface) => {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [surface.clientWidth, surface.clientHeight];
  const [columns, rows] = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
  if (surface.width !== columns) surface.width = columns;
  if (surface.height !== rows) surface.height = rows;
  const context = surface.getContext("2d");
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, columns, rows);
  return { context, ratio, width, height };
};

const draw = () => {
  const { context, ratio, width, height } = prepared(canvas);
  const { scale } = viewNow();
  const [left, top] = toStage(0, 0);
  drawPhoto(context, state.photo, { left: left * ratio, top: top * ratio, scale: scale * ratio, width: width * ratio, height: height * ratio });
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  const labels = here().size + served.predicted[state.photo].targets.size < 400 ? new Labels(context) : null;
  drawPoints(context, toStage, scale, labels);
  if (labels) labels.draw(width, height);
  if (pointer.byKeys) stroke(context, new Path2D(`M${width / 2 - 22} ${height / 2}h16m12 0h16M${width / 2} ${height / 2 - 22}v16m0 12v16`), "#ffffff", 1.4);
};

const drawAll = oncePerFrame(() => {
  draw();
  drawLoupe();
});
shown.push(drawAll);
