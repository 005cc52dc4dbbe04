// Photographs in tiles: those in view are decoded, beside the script, and the last ones are kept.

const MOST_TILES = 160;
const MOST_AT_A_TIME = 8;

const tiles = { held: new Map(), underWay: new Set(), failed: new Set() };

/** The bytes of a tile: from the page, or from the server that sent it. */
const bytesOf = async (path) => {
  if (content.method !== null) {
    const answer = await fetch(`tile/${path}`);
    if (!answer.ok) throw new Error(await answer.text());
    return answer.blob();
  }
  const text = atob(document.getElementById(`t-${path.replaceAll("/", "-")}`).textContent);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i += 1) bytes[i] = text.charCodeAt(i);
  return new Blob([bytes], { type: "image/jpeg" });
};

const trim = () => {
  for (const [path, bitmap] of tiles.held) {
    if (tiles.held.size <= MOST_TILES) return;
    tiles.held.delete(path);
    bitmap.close();
  }
};

/** A tile if it is there; else it will be, and the page is drawn again. */
const tile = (path) => {
  const found = tiles.held.get(path);
  if (found) {
    tiles.held.delete(path);
    tiles.held.set(path, found);
    return found;
  }
  if (tiles.underWay.has(path) || tiles.failed.has(path) || tiles.underWay.size >= MOST_AT_A_TIME) return null;
  tiles.underWay.add(path);
  bytesOf(path)
    .then((blob) => createImageBitmap(blob))
    .then((bitmap) => {
      tiles.held.set(path, bitmap);
      trim();
    })
    .catch(() => {
      // Asked for again when the reader has waited.
      tiles.failed.add(path);
      setTimeout(() => tiles.failed.delete(path), 5000);
    })
    .finally(() => {
      tiles.underWay.delete(path);
      drawAll();
    });
  return null;
};

const levelSize = (photo, level) => [photo.width, photo.height].map((side) => Math.ceil(side / 2 ** level));

/** Draws one level of a photograph; `left`, `top` are where image coordinate 0, 0 stands, px of the canvas, and `scale` px of it for one of the image. */
const drawLevel = (context, index, level, { left, top, scale, width, height }) => {
  const side = content.tile;
  const pixel = scale * 2 ** level;
  // The first pixel reaches from -0.5 to 0.5.
  const [x0, y0] = [left - scale / 2, top - scale / 2];
  const [columns, rows] = levelSize(photos[index], level);
  const range = (from, to, count) => [Math.max(0, Math.floor(from / side)), Math.min(Math.ceil(count / side) - 1, Math.floor(to / side))];
  const [firstColumn, lastColumn] = range(-x0 / pixel, (width - x0) / pixel, columns);
  const [firstRow, lastRow] = range(-y0 / pixel, (height - y0) / pixel, rows);
  let whole = true;
  for (let row = firstRow; row <= lastRow; row += 1) {
    for (let column = firstColumn; column <= lastColumn; column += 1) {
      const bitmap = tile(`${index}/${level}/${column}/${row}`);
      if (bitmap) {
        const [fromX, fromY] = [x0 + column * side * pixel, y0 + row * side * pixel];
        const [toX, toY] = [fromX + bitmap.width * pixel, fromY + bitmap.height * pixel];
        // Whole pixels: else seams would show between tiles.
        const [a, b, c, d] = scale < 2 ? [fromX, fromY, toX, toY].map(Math.round) : [fromX, fromY, toX, toY];
        context.drawImage(bitmap, a, b, c - a, d - b);
      } else whole = false;
    }
  }
  return whole;
};

/** Draws a photograph: the level that suits the scale, or above it a coarser one until that is there. */
const drawPhoto = (context, index, place) => {
  const last = photos[index].levels - 1;
  const level = within(Math.floor(Math.log2(1 / place.scale)), 0, last);
  context.imageSmoothingEnabled = place.scale < 2;
  context.imageSmoothingQuality = "medium";
  if (level < last) drawLevel(context, index, last, place);
  drawLevel(context, index, level, place);
};
