// Figures between the cells of a sweep, never beyond them.

/** Where `value` lies among ascending values: the places beside it and the share of the second. Between positive values the logarithm is linear. */
const between = (values, value) => {
  const order = values.map((_, place) => place).sort((a, b) => values[a] - values[b]);
  const sorted = order.map((place) => values[place]);
  const last = sorted.length - 1;
  if (value <= sorted[0] || last === 0) return [[order[0], 1]];
  if (value >= sorted[last]) return [[order[last], 1]];
  const upper = sorted.findIndex((known) => known >= value);
  if (sorted[upper] === value) return [[order[upper], 1]];
  const scale = sorted[0] > 0 ? Math.log : (x) => x;
  const [low, high] = [sorted[upper - 1], sorted[upper]].map(scale);
  const share = (scale(value) - low) / (high - low);
  return [[order[upper - 1], 1 - share], [order[upper], share]];
};

/** The cells around a point of the axes, each with its weight; null where one of them was not measured. */
const cellsAround = (question, point) => {
  let corners = [[[], 1]];
  question.axes.forEach((axis, index) => {
    const sides = between(axis.values, point[index]);
    corners = corners.flatMap(([at, weight]) => sides.map(([place, share]) => [[...at, place], weight * share]));
  });
  const found = corners.map(([at, weight]) => [question.cellAt.get(at.join()), weight]);
  return found.every(([cell]) => cell !== undefined) ? found : null;
};

/** The mean of logarithms, or null where one is missing. A zero keeps its value only where it stands alone. */
const logMean = (column, cells, method) => {
  const parts = cells.map(([cell, weight]) => [column[cell][method], weight]);
  if (parts.some(([value]) => value === null)) return null;
  if (parts.length === 1) return parts[0][0];
  if (parts.some(([value]) => value <= 0)) return parts.reduce((sum, [value, weight]) => sum + weight * value, 0);
  return Math.exp(parts.reduce((sum, [value, weight]) => sum + weight * Math.log(value), 0));
};

/** All methods at a point: RMSE with its interval, the greatest share of failures among the cells around, speed. */
const methodsAt = (question, cells) =>
  question.cells.names
    .map((name, method) => ({
      name,
      rmse: logMean(question.cells.rmse, cells, method),
      low: logMean(question.cells.low, cells, method),
      high: logMean(question.cells.high, cells, method),
      failed: Math.max(...cells.map(([cell]) => (question.cells.failed[cell][method] === null ? 1 : question.cells.failed[cell][method]))),
      speed: question.cells.speed[method],
    }))
    .filter(({ rmse }) => rmse !== null);

/** The row of the page that the nearest cell belongs to. */
const rowAt = (question, cells) => question.cells.row[cells.reduce((best, one) => (one[1] > best[1] ? one : best))[0]];

/** What a row of the page advises with at least this speed: the least error among those that hardly ever fail. */
const advice = (row, most, speed) => {
  let best = -1;
  row.names.forEach((_, index) => {
    const sound = row.failed[index] <= most && row.rmse[index] !== null && (!speed || (row.speed[index] !== null && row.speed[index] >= speed));
    if (sound && (best < 0 || row.rmse[index] < row.rmse[best])) best = index;
  });
  return best;
};
