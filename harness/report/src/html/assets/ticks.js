// Round numbers for an axis, and how they are written.

const MOST_DIGITS = 12;

/** Steps of 1, 2 or 5 times a power of ten, about `count` of them from `low` to `high`. */
const linearTicks = (low, high, count) => {
  const wanted = (high - low) / count;
  const decade = 10 ** Math.floor(Math.log10(wanted));
  const step = [1, 2, 5, 10].map((factor) => factor * decade).find((size) => size >= wanted * 0.999);
  const digits = within(-Math.floor(Math.log10(step) + 1e-9), 0, MOST_DIGITS);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: within(last - first + 1, 0, 50) }, (_, index) => {
    const value = (first + index) * step;
    return { value, text: written(value, digits) };
  });
};

const written = (value, digits) => {
  const size = Math.abs(value);
  if (size < 0.5 * 10 ** -digits) return "0";
  const text = size >= 1e7 || size < 1e-4 ? Number(value.toPrecision(6)).toExponential() : value.toFixed(digits);
  return text.replace(/-/g, "−").replace("e+", "e");
};

/** Powers of ten; with 2 and 5 times them, or linear steps, where few of them are seen. */
const logTicks = (low, high, count) => {
  const decades = Math.log10(high / low);
  if (decades < 0.8) return linearTicks(low, high, count);
  const factors = decades < count / 2 ? [1, 2, 5] : [1];
  const every = Math.max(1, Math.ceil(decades / count));
  const found = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); power += 1) {
    if (power % every) continue;
    for (const factor of factors) {
      const value = Number(`${factor}e${power}`);
      if (value >= low * 0.999999 && value <= high * 1.000001) found.push({ value, text: written(value, within(-power, 0, MOST_DIGITS)) });
    }
  }
  return found;
};

class Scale {
  /** From the value at the `near` edge of the box to that at the `far` edge. */
  constructor(values, log, near, far) {
    this.log = log && values[0] > 0 && values[1] > 0;
    [this.from, this.to] = this.log ? values.map(Math.log) : values;
    [this.near, this.far] = [near, far];
  }

  value(place) {
    const plain = this.from + ((place - this.near) / (this.far - this.near)) * (this.to - this.from);
    return this.log ? Math.exp(plain) : plain;
  }

  place(value) {
    const plain = this.log ? Math.log(value) : value;
    return this.near + ((plain - this.from) / (this.to - this.from)) * (this.far - this.near);
  }

  /** Ticks between two places, with theirs. */
  ticks(start, end, count) {
    const ends = [this.value(start), this.value(end)];
    const [low, high] = [Math.min(...ends), Math.max(...ends)];
    if (!(high > low)) return [];
    const found = this.log ? logTicks(low, high, count) : linearTicks(low, high, count);
    return found.map((tick) => ({ ...tick, place: this.place(tick.value) }));
  }
}
