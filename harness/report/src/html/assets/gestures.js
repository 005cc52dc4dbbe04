// Pointer, wheel, touch and keys on a drawing, as a few verbs: zoom, pan, hover, leave, click, reset, key.

const CLICK_SLACK = 4;

const onWheel = (surface, verbs) => surface.addEventListener("wheel", (event) => {
  const meant = event.ctrlKey || event.metaKey;
  // The page scrolls past a drawing that nobody has turned to.
  if (!meant && !surface.contains(document.activeElement)) return;
  const step = within(event.deltaY * [1, 16, 400][event.deltaMode], -250, 250);
  const moved = verbs.zoom(Math.exp(-step * 0.002), event.clientX, event.clientY);
  if (moved || meant) event.preventDefault();
}, { passive: false });

const middle = ([a, b]) => ({ x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y) });

const onPointers = (surface, verbs) => {
  const down = new Map();
  let from = null;
  let dragged = false;
  const drag = (event) => {
    const before = [...down.values()];
    const last = down.get(event.pointerId);
    const here = { x: event.clientX, y: event.clientY };
    if (down.size === 1 && event.pointerType === "touch" && !verbs.holdsTouch()) return;
    if (!dragged && down.size === 1 && Math.hypot(here.x - from.x, here.y - from.y) < CLICK_SLACK) return;
    if (!dragged) surface.setPointerCapture(event.pointerId);
    dragged = true;
    down.set(event.pointerId, here);
    if (down.size === 1) {
      verbs.pan(here.x - last.x, here.y - last.y, event);
    } else if (down.size === 2) {
      const [was, is] = [middle(before), middle([...down.values()])];
      verbs.zoom(is.apart / (was.apart || 1), is.x, is.y);
      verbs.pan(is.x - was.x, is.y - was.y, { shiftKey: true });
    }
  };
  surface.addEventListener("pointerdown", (event) => {
    if (!down.size) [from, dragged] = [{ x: event.clientX, y: event.clientY }, false];
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  surface.addEventListener("pointermove", (event) => (down.has(event.pointerId) ? drag(event) : verbs.hover(event)));
  const up = (event) => down.delete(event.pointerId);
  surface.addEventListener("pointerup", up);
  surface.addEventListener("pointercancel", up);
  // A finger is first held by the mark that it touched; when the drawing takes over, the mark's loss is none.
  surface.addEventListener("lostpointercapture", (event) => event.target === surface && up(event));
  surface.addEventListener("pointerleave", (event) => {
    if (!dragged || !down.size) up(event);
    verbs.leave();
  });
  surface.addEventListener("click", (event) => dragged || verbs.click(event));
  surface.addEventListener("contextmenu", (event) => dragged && event.preventDefault());
  surface.addEventListener("dblclick", () => verbs.reset());
  const keepPage = (event) => {
    if (event.cancelable && (event.touches.length > 1 || verbs.holdsTouch())) event.preventDefault();
  };
  surface.addEventListener("touchmove", keepPage, { passive: false });
};

const STEPS = { "[": -1, ",": -1, "]": 1, ".": 1 };

const gestures = (surface, verbs) => {
  surface.setAttribute("tabindex", "0");
  surface.classList.add("surface");
  onWheel(surface, verbs);
  onPointers(surface, verbs);
  surface.addEventListener("keydown", (event) => {
    if (event.target === surface && verbs.key(event)) event.preventDefault();
  });
  surface.addEventListener("blur", () => verbs.leave());
};
