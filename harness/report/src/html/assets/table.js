// Tables: sorted, filtered, taken along as CSV.

const FEW_ROWS = 8;
const NOTHING = /^(|-|–|—|NaN)$/;

const collator = new Intl.Collator("en", { numeric: true });

/** What a cell is sorted and compared by: a number, a text, or null where there is nothing. */
const valueOf = (cell) => {
  if (!cell) return null;
  const text = cell.dataset.v === undefined ? textOf(cell) : cell.dataset.v.trim();
  if (NOTHING.test(text)) return null;
  const number = Number(text.replace(/^−/, "-"));
  return Number.isNaN(number) ? text : number;
};

/** Numbers before texts; nothing last, whichever way the rest runs. */
const compare = (a, b, direction) => {
  if (a === null || b === null) return (a === null) - (b === null);
  const [na, nb] = [typeof a === "number", typeof b === "number"];
  if (na !== nb) return na ? -1 : 1;
  return direction * (na ? Math.sign(a - b) || 0 : collator.compare(a, b));
};

const OPERATORS = {
  "<": (order) => order < 0,
  ">": (order) => order > 0,
  "<=": (order) => order <= 0,
  ">=": (order) => order >= 0,
  "=": (order) => order === 0,
  "!=": (order) => order !== 0,
};

/** A column by its whole name, by what stands before its unit, or by the only name that begins so. */
const columnNamed = (names, wanted) => {
  const [lower, text] = [names.map((name) => name.toLowerCase()), wanted.trim().toLowerCase()];
  if (!text) return -1;
  const whole = lower.indexOf(text);
  if (whole >= 0) return whole;
  const bare = lower.findIndex((name) => name.split(",")[0].trim() === text);
  if (bare >= 0) return bare;
  const beginning = lower.filter((name) => name.startsWith(text));
  return beginning.length === 1 ? lower.indexOf(beginning[0]) : -1;
};

const comparison = (index, operator, wanted) => {
  const number = Number(wanted.replace(/^−/, "-"));
  const numeric = wanted !== "" && Number.isFinite(number);
  return (cells) => {
    const value = valueOf(cells[index]);
    const shown = cells[index] ? textOf(cells[index]).toLowerCase() : "";
    // What is printed is rounded: a reader who copies it means that row.
    if (operator === "=" && shown === wanted.toLowerCase()) return true;
    if (operator === "!=" && shown === wanted.toLowerCase()) return false;
    if (value === null || (numeric && typeof value !== "number")) return operator === "!=";
    const order = numeric ? Math.sign(value - number) : collator.compare(shown, wanted.toLowerCase());
    return OPERATORS[operator](order);
  };
};

/** What a filter asks of the cells of a row; several conditions are parted by semicolons. */
const conditions = (text, names) => text.split(";").map((part) => part.trim()).filter(Boolean).map((part) => {
  const [, name, operator, wanted] = /^(.*?)\s*(<=|>=|!=|<|>|=)\s*(.*)$/.exec(part) || [];
  const index = operator ? columnNamed(names, name) : -1;
  if (index >= 0) return comparison(index, operator, wanted);
  const lower = part.toLowerCase();
  return (cells) => cells.some((cell) => textOf(cell).toLowerCase().includes(lower));
});

class Table {
  constructor(table, index) {
    this.table = table;
    this.id = table.id || `table-${index + 1}`;
    this.body = table.tBodies[0];
    this.heads = [...table.tHead.rows[table.tHead.rows.length - 1].cells];
    this.names = this.heads.map(textOf);
    this.rows = [...this.body.rows];
    this.shown = this.rows;
    this.sorted = { column: -1, direction: 1 };
    this.selects = [];
    this.addTools();
    this.heads.forEach((head, column) => this.makeSortable(head, column));
    this.makeRowsReachable();
    keep(`sort.${this.id}`, () => this.sortText(), (text) => this.setSort(text));
    keep(`filter.${this.id}`, () => this.filterText(), (text) => this.setFilter(text));
    if (this.names.some((name) => series.known.has(name)) || this.rows.some((row) => row.dataset.series !== undefined)) series.told.push(() => this.hide());
    this.filter();
  }

  addTools() {
    const title = this.table.caption;
    const box = this.table.closest(".table") || this.table;
    this.tools = make("div", { class: "tools" });
    this.input = make("input", { type: "search", placeholder: "filter, or column>0.1", "aria-label": "filter rows", input: () => this.filter() });
    if (this.rows.length > FEW_ROWS) {
      this.tools.append(this.input);
      box.classList.add("tall");
      for (const [name, value] of [["tabindex", "0"], ["role", "region"], ["aria-label", title ? textOf(title) : "table"]]) box.setAttribute(name, value);
    }
    this.heads.forEach((head, column) => head.dataset.filter !== undefined && this.addSelect(column));
    this.count = make("span", { class: "count", "aria-live": "polite" });
    this.tools.append(this.count, button("CSV", "the rows shown, as a CSV file", () => download(`${this.id}.csv`, "text/csv", this.csv())));
    box.before(this.tools);
    if (!title) return;
    // The title stays where it is when the table is scrolled.
    this.tools.before(make("p", { class: "caption", "aria-hidden": "true" }, ...title.cloneNode(true).childNodes));
    title.classList.add("heard");
  }

  addSelect(column) {
    const texts = this.rows.map((row) => (row.cells[column] ? textOf(row.cells[column]) : ""));
    const values = [...new Set(texts)].sort(collator.compare);
    const select = make("select", { "aria-label": `rows by ${this.names[column]}`, change: () => this.filter() });
    select.append(make("option", { value: "" }, `${this.names[column]}: all`));
    values.forEach((value, index) => select.append(make("option", { value: String(index + 1) }, value || "(nothing)")));
    this.selects.push({ column, select, values });
    this.tools.append(select);
  }

  makeSortable(head, column) {
    const inner = make("button", { type: "button", class: "sort" });
    inner.append(...head.childNodes);
    head.append(inner);
    if (!this.names[column]) inner.setAttribute("aria-label", `sort by column ${column + 1}`);
    head.setAttribute("aria-sort", "none");
    head.addEventListener("click", () => {
      const { column: now, direction } = this.sorted;
      if (now !== column) this.sort(column, 1);
      else if (direction > 0) this.sort(column, -1);
      else this.sort(-1, 1);
    });
  }

  /** Rows that can be chosen are one stop of the Tab key; arrows go on from there. */
  makeRowsReachable() {
    const rows = this.rows.filter((row) => row.dataset.g !== undefined || row.dataset.k !== undefined);
    rows.forEach((row, index) => row.setAttribute("tabindex", index ? "-1" : "0"));
    this.body.addEventListener("focusin", (event) => {
      const row = event.target.closest("tr");
      if (!rows.includes(row)) return;
      rows.forEach((other) => other.setAttribute("tabindex", other === row ? "0" : "-1"));
    });
    this.body.addEventListener("keydown", (event) => {
      const row = event.target;
      if (!rows.includes(row)) return;
      const visible = [...this.body.rows].filter((other) => rows.includes(other) && this.shown.includes(other));
      const at = visible.indexOf(row);
      const next = { ArrowDown: visible[at + 1], ArrowUp: visible[at - 1], Home: visible[0], End: visible[visible.length - 1] }[event.key];
      if (next) next.focus();
      else if (event.key === "Enter" || event.key === " ") pick(row);
      else return;
      event.preventDefault();
    });
    this.choosable = rows;
  }

  sort(column, direction) {
    this.sorted = { column, direction };
    this.heads.forEach((head, index) => head.setAttribute("aria-sort", index !== column ? "none" : direction > 0 ? "ascending" : "descending"));
    const keyed = this.rows.map((row) => ({ row, key: column < 0 ? 0 : valueOf(row.cells[column]) }));
    keyed.sort((a, b) => compare(a.key, b.key, direction));
    this.body.append(...keyed.map(({ row }) => row));
    this.shown = [...this.body.rows].filter((row) => !row.classList.contains("out") && !row.classList.contains("off"));
    changed();
  }

  /** Rows and columns of hidden series. */
  hide() {
    this.names.forEach((name, column) => {
      if (!series.known.has(name) || this.heads[column].classList.contains("off") === isOff(name)) return;
      for (const row of [...this.table.tHead.rows, ...this.rows]) if (row.cells[column]) row.cells[column].classList.toggle("off", isOff(name));
    });
    this.filter();
  }

  filter() {
    const asked = conditions(this.input.value, this.names);
    for (const { column, select, values } of this.selects) {
      const wanted = values[Number(select.value) - 1];
      if (select.value) asked.push((cells) => (cells[column] ? textOf(cells[column]) : "") === wanted);
    }
    this.shown = [...this.body.rows].filter((row) => {
      const cells = [...row.cells];
      const out = !asked.every((condition) => condition(cells));
      row.classList.toggle("out", out);
      return !out && !(row.dataset.series !== undefined && isOff(row.dataset.series));
    });
    const [some, every] = [this.shown.length, this.rows.length];
    this.count.textContent = some === every ? `${every} ${every === 1 ? "row" : "rows"}` : `${some} of ${every} rows`;
    // The one row that the Tab key stops at must be there.
    const reachable = this.choosable.filter((row) => this.shown.includes(row));
    if (reachable.length && !reachable.some((row) => row.tabIndex === 0)) reachable[0].setAttribute("tabindex", "0");
    changed();
  }

  csv() {
    const cellText = (cell) => (cell.dataset.v !== undefined && !NOTHING.test(cell.dataset.v) ? cell.dataset.v : textOf(cell));
    const shown = (cell) => !cell.classList.contains("off");
    return csv([this.heads, ...this.shown.map((row) => [...row.cells])].map((cells) => cells.filter(shown).map(cellText)));
  }

  sortText() {
    const { column, direction } = this.sorted;
    return column < 0 ? "" : `${column},${direction}`;
  }

  setSort(text) {
    const [column, direction] = numbers(text, 2) || [-1, 1];
    if (this.sortText() !== text) this.sort(this.heads[column] ? column : -1, direction < 0 ? -1 : 1);
  }

  filterText() {
    const picked = this.selects.map(({ select }) => select.value).join(",");
    return this.input.value || /\d/.test(picked) ? `${picked}:${this.input.value}` : "";
  }

  setFilter(text) {
    const at = text.indexOf(":");
    const picked = text.slice(0, Math.max(at, 0)).split(",");
    this.selects.forEach(({ select, values }, index) => {
      select.value = Number(picked[index]) <= values.length ? picked[index] : "";
    });
    this.input.value = text.slice(at + 1);
    this.filter();
  }
}

const LEADING = /^[<\s]*([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)/i;

/** Cells of numbers are sorted by the one that they begin with, whatever follows: an interval, a share. */
const nameValues = () => {
  for (const cell of all("table.data td.n:not([data-v])")) {
    const [, value] = LEADING.exec(cell.textContent.replace(/−/g, "-")) || [];
    if (value) cell.dataset.v = value;
  }
};

const setUpTables = () => {
  nameValues();
  all("table.data").forEach((table, index) => {
    if (table.tBodies.length && table.tHead && table.tHead.rows.length) new Table(table, index);
  });
};
