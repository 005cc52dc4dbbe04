// Tables of printed numbers beside ours: on request only the rows that do not reproduce.

const DIFFERS = /^(differs|inconsistent)/;

/** Body rows of all tables with a column of verdicts, each with its verdict. */
const judgedRows = () =>
  all("table.data").flatMap((table) => {
    const names = [...table.tHead.rows[0].cells].map((cell) => textOf(cell).replace(/[↕↑↓]$/, "").trim());
    const column = names.indexOf("verdict");
    return column < 0 ? [] : [...table.tBodies[0].rows].map((row) => [row, row.cells[column] ? textOf(row.cells[column]) : ""]);
  });

const differsSwitch = () => {
  const rows = judgedRows();
  if (!rows.length) return "";
  const other = rows.filter(([, verdict]) => !DIFFERS.test(verdict)).map(([row]) => row);
  const count = rows.length - other.length;
  const one = button("", "show only the rows of printed tables that differ or are inconsistent", () => show(!only));
  one.classList.add("differs");
  let only = false;
  const show = (wanted) => {
    only = wanted;
    one.setAttribute("aria-pressed", String(only));
    one.textContent = only ? `only what differs: ${count} of ${rows.length} rows` : `printed rows that differ: ${count} of ${rows.length}`;
    other.forEach((row) => row.classList.toggle("agrees", only));
    changed();
  };
  keep("differs", () => (only ? "1" : ""), (text) => show(text === "1"));
  show(false);
  return one;
};
