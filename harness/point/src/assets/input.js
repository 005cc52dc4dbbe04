// Mouse, fingers and keys on the photograph.

const pointer = {
  /** Where the mouse is on the stage, CSS px, or null. */
  at: null,
  /** Whether keys were used last: the middle of the view is pointed at then. */
  byKeys: false,
  down: new Map(),
  /** What a drag moves: the photograph, or a point by its name. */
  drag: null,
};

/** A press that moves less is a click, CSS px. */
const STILL = 4;
/** Points that are nearer are taken hold of, CSS px. */
const NEAR = 7;

const onStage = (event) => {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
};

/** The point next to a place of the stage. */
const pointNear = ([sx, sy]) => {
  let [best, least] = [null, NEAR];
  for (const [name, place] of here()) {
    const [x, y] = toStage(place.x, place.y);
    const apart = Math.hypot(x - sx, y - sy);
    if (apart <= least) [best, least] = [name, apart];
  }
  return best;
};

const choose = (name) => {
  state.chosen = name;
  if (name !== null) {
    const { x, y } = here().get(name);
    tell(`${name} chosen, ${shortened(x)}, ${shortened(y)}`);
  }
  show();
};

const pressed = (event) => {
  if (event.button > 1) return;
  canvas.focus({ preventScroll: true });
  canvas.setPointerCapture(event.pointerId);
  pointer.byKeys = false;
  pointer.down.set(event.pointerId, onStage(event));
  pointer.at = onStage(event);
  const name = event.button === 0 && pointer.down.size === 1 ? pointNear(pointer.at) : null;
  pointer.drag = pointer.down.size > 1 ? { moved: true } : { from: pointer.at, moved: false, name, button: event.button, before: name === null ? null : here().get(name) };
};

const pinched = (event) => {
  const middle = () => {
    const [[ax, ay], [bx, by]] = [...pointer.down.values()];
    return { x: (ax + bx) / 2, y: (ay + by) / 2, apart: Math.hypot(ax - bx, ay - by) };
  };
  const was = middle();
  pointer.down.set(event.pointerId, onStage(event));
  const is = middle();
  pan(is.x - was.x, is.y - was.y);
  zoom(is.apart / (was.apart || 1), is.x, is.y);
};

const moved = (event) => {
  const at = onStage(event);
  pointer.byKeys = false;
  if (!pointer.down.has(event.pointerId)) {
    pointer.at = at;
    return drawAll();
  }
  if (pointer.down.size > 1) return pinched(event);
  const [wasX, wasY] = pointer.down.get(event.pointerId);
  const { drag } = pointer;
  if (!drag.moved && Math.hypot(at[0] - drag.from[0], at[1] - drag.from[1]) < STILL) return undefined;
  const [dx, dy] = drag.moved ? [at[0] - wasX, at[1] - wasY] : [at[0] - drag.from[0], at[1] - drag.from[1]];
  drag.moved = true;
  pointer.down.set(event.pointerId, at);
  pointer.at = at;
  if (drag.name === null || drag.name === undefined || !here().has(drag.name)) return pan(dx, dy);
  const { x, y } = here().get(drag.name);
  // Shown as it goes, one change when it is let go.
  here().set(drag.name, { x: x + dx / viewNow().scale, y: y + dy / viewNow().scale });
  state.chosen = drag.name;
  return show();
};

const released = (event) => {
  if (!pointer.down.delete(event.pointerId) || pointer.down.size) return;
  const { drag } = pointer;
  pointer.drag = null;
  if (!drag) return;
  if (drag.moved) {
    if (drag.name && here().has(drag.name)) {
      const { x, y } = here().get(drag.name);
      here().set(drag.name, drag.before);
      place(drag.name, x, y);
    }
  } else if (drag.button === 0 && event.type === "pointerup") {
    if (drag.name !== null) choose(drag.name);
    else clicked(onStage(event));
  }
};

const clicked = (at) => {
  const [x, y] = toImage(...at);
  const { width, height } = photos[state.photo];
  if (x < -0.5 || y < -0.5 || x > width - 0.5 || y > height - 0.5) choose(null);
  else pointAt(x, y);
};

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const LETTERS = { a: [-1, 0], d: [1, 0], w: [0, -1], s: [0, 1] };

const nudge = ([dx, dy], by) => {
  const { x, y } = here().get(state.chosen);
  place(state.chosen, x + dx * by, y + dy * by);
  const now = here().get(state.chosen);
  tell(`${state.chosen} at ${shortened(now.x)}, ${shortened(now.y)}`);
};

/** The point after or before the chosen one, in the order in which they were pointed at. */
const stepPoint = (by) => {
  const names = [...here().keys()];
  if (!names.length) return;
  const from = names.indexOf(state.chosen);
  const to = from < 0 ? (by > 0 ? 0 : names.length - 1) : (from + by + names.length) % names.length;
  choose(names[to]);
  lookAt(here().get(names[to]));
};

const switchPhoto = (to) => {
  const photo = within(to, 0, photos.length - 1);
  if (photo === state.photo) return;
  [state.photo, state.chosen] = [photo, null];
  if (content.targets.length) state.target = nextName("");
  keep();
  catchUp();
  show();
  tell(`photograph ${photo + 1} of ${photos.length}: ${photos[photo].name}`);
};

const KEYS = {
  "+": () => zoom(1.5),
  "=": () => zoom(1.5),
  "-": () => zoom(1 / 1.5),
  0: () => fit(),
  1: () => zoom(1 / viewNow().scale),
  ".": () => stepPoint(1),
  ",": () => stepPoint(-1),
  "]": () => switchPhoto(state.photo + 1),
  "[": () => switchPhoto(state.photo - 1),
  PageDown: () => switchPhoto(state.photo + 1),
  PageUp: () => switchPhoto(state.photo - 1),
  Escape: () => choose(null),
  Delete: () => state.chosen !== null && remove(state.chosen),
  Backspace: () => state.chosen !== null && remove(state.chosen),
  n: () => nameInput.select(),
  Enter: () => pointAt(viewNow().x, viewNow().y),
  " ": () => pointAt(viewNow().x, viewNow().y),
};

const keyed = (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const arrow = ARROWS[event.key];
  const letter = LETTERS[event.key.toLowerCase()];
  if (arrow && state.chosen !== null) nudge(arrow, event.shiftKey ? 0.1 : 1);
  else if (arrow || letter) {
    const [dx, dy] = arrow || letter;
    const by = event.shiftKey ? 8 : 60;
    pan(-dx * by, -dy * by);
  } else if (KEYS[event.key]) KEYS[event.key]();
  else return;
  event.preventDefault();
  pointer.byKeys = true;
  drawAll();
};

/** Everywhere but where a text is written, whose own history counts there. */
const historyKeys = (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.altKey || event.target.matches("input[type=text]")) return;
  const key = event.key.toLowerCase();
  if (key !== "z" && key !== "y") return;
  event.preventDefault();
  if (key === "y" || event.shiftKey) redo();
  else undo();
};

const setUpInput = () => {
  canvas.addEventListener("pointerdown", pressed);
  canvas.addEventListener("pointermove", moved);
  canvas.addEventListener("pointerup", released);
  canvas.addEventListener("pointercancel", released);
  canvas.addEventListener("pointerleave", () => {
    pointer.at = null;
    drawAll();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 30 : 1;
    zoom(2 ** within((-event.deltaY * lines) / 250, -1, 1), ...onStage(event));
  }, { passive: false });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("keydown", keyed);
  document.addEventListener("keydown", historyKeys);
  new ResizeObserver(() => drawAll()).observe(canvas);
};
