// Tables in and out. 0, 0 is the centre of the first pixel, x to the right, y down.

/** The text of a cell as `csvCell` writes it. */
const fromCell = (cell) => (/^''*[=+\-@\t\r\n]/.test(cell) ? cell.slice(1) : cell);

const csv = (rows) => rows.map((row) => `${row.map((cell) => csvCell(String(cell))).join(",")}\n`).join("");

/** The rows of a CSV text, each a list of cells. */
const csvRows = (text) => {
  const rows = [];
  let [row, cell, quoted] = [[], "", false];
  const endRow = () => {
    row.push(cell);
    if (row.length > 1 || row[0] !== "") rows.push(row);
    [row, cell] = [[], ""];
  };
  for (let i = text.charCodeAt(0) === 0xfeff ? 1 : 0; i < text.length; i += 1) {
    const c = text[i];
    if (quoted) {
      if (c !== '"') cell += c;
      else if (text[i + 1] === '"') {
        cell += c;
        i += 1;
      } else quoted = false;
    } else if (c === '"' && cell === "") quoted = true;
    else if (c === ",") {
      row.push(cell);
      cell = "";
    } else if (c === "\n") endRow();
    else if (c !== "\r") cell += c;
  }
  if (row.length || cell !== "") endRow();
  return rows;
};

/** The rows below the header as objects; throws what is wrong in words. */
const csvTable = (text, needed) => {
  const [header, ...rows] = csvRows(text);
  const names = (header || []).map((name) => name.trim());
  const missing = needed.filter((name) => !names.includes(name));
  if (missing.length) throw new Error(`has no column ${missing.join(", ")}; expected ${needed.join(",")}`);
  return {
    names,
    rows: rows.map((row, index) => {
      if (row.length !== names.length) throw new Error(`row ${index + 2}: expected ${names.length} cells as in the header, found ${row.length}`);
      return Object.fromEntries(names.map((name, place) => [name, fromCell(row[place].trim())]));
    }),
  };
};
