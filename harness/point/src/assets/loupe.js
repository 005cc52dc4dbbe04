// The enlarged part round the pointer, or round the chosen point.

const loupe = {
  canvas: make("canvas", { class: "loupe", "aria-hidden": "true" }),
  words: make("p", { class: "place" }),
  zoom: 8,
};

/** What the loupe shows: where the mouse points, else the chosen point, else the middle of the view. */
const loupePlace = () => {
  if (pointer.at && !pointer.byKeys) return toImage(...pointer.at);
  const chosen = here().get(state.chosen);
  if (chosen) return [chosen.x, chosen.y];
  const { x, y } = viewNow();
  return [x, y];
};

const drawLoupe = () => {
  const [x, y] = loupePlace();
  const { context, ratio, width, height } = prepared(loupe.canvas);
  const scale = Math.max(loupe.zoom, viewNow().scale);
  const project = (px, py) => [(px - x) * scale + width / 2, (py - y) * scale + height / 2];
  const [left, top] = project(0, 0);
  drawPhoto(context, state.photo, { left: left * ratio, top: top * ratio, scale: scale * ratio, width: width * ratio, height: height * ratio });
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  drawPoints(context, project, scale, null);
  const [a, b] = [width / 2, height / 2];
  stroke(context, new Path2D(`M0 ${b}H${a - 8}M${a + 8} ${b}H${width}M${a} 0V${b - 8}M${a} ${b + 8}V${height}`), "#ffffff", 1);
  loupe.words.textContent = `x ${shortened(x)}, y ${shortened(y)} px; ${scale < 100 ? Number(scale.toPrecision(2)) : Math.round(scale)} times`;
};
