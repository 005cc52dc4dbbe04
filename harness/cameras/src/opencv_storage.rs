//! Matrices as OpenCV's FileStorage holds them, in YAML or XML alike.

use half::f16;

use super::CameraFileError;
use super::number::{finite, shortened};
use super::tree::{Entry, Value};

/// A matrix of numbers.
#[derive(Debug)]
pub(super) struct Matrix {
    pub rows: usize,
    pub columns: usize,
    /// `rows` x `columns` numbers, row by row.
    pub data: Vec<f64>,
}

impl Entry {
    /// The matrix: `rows`, `cols` or, of OpenCV 5, `sizes`, then `dt` and as many numbers in `data`; at most `most`. One of a single dimension is a column. Or rows
    /// of numbers.
    ///
    /// # Errors
    /// A part that is missing, sides that are no whole numbers from 1, more than two of them, more than `most` numbers, a type that is not of one number each,
    /// another count of numbers.
    pub fn matrix(&self, most: usize) -> Result<Matrix, CameraFileError> {
        if let Value::List(items) = &self.value {
            return self.listed(items, most);
        }
        let part = |name: &str| self.get(&[name])?.ok_or_else(|| self.wrong(&format!("has no `{name}`; expected rows, cols, dt, data")));
        let (rows, columns) = match self.key("sizes")? {
            Some(sizes) => sizes.sides().map_err(|error| error.of("sizes"))?,
            None => {
                let side = |name: &str| {
                    let (_, entry) = part(name)?;
                    entry.text().and_then(|text| entry.side(text)).map_err(|error| error.of(name))
                };
                (side("rows")?, side("cols")?)
            }
        };
        let count = rows.checked_mul(columns).filter(|&count| count <= most);
        let count = count.ok_or_else(|| self.wrong(&format!("is {rows} x {columns}; expected no more than {most} numbers")))?;
        let (_, kind) = part("dt")?;
        let held: fn(f64) -> f64 = match kind.text()? {
            "d" | "u" | "c" | "w" | "s" | "i" | "n" => |number| number,
            "f" => |number| f64::from(number as f32),
            "h" => |number| f16::from_f64(number).to_f64(),
            other => return Err(kind.wrong(&format!("expected d, f or one kind of whole numbers, found `{}`", shortened(other))).of("dt")),
        };
        let (_, data) = part("data")?;
        let data = data.numbers(count, &format!("{rows} x {columns}"), held).map_err(|error| error.of("data"))?;
        Ok(Matrix { rows, columns, data })
    }

    /// The matrix of rows of numbers, or of one row, as JSON and YAML have NumPy's lists.
    fn listed(&self, items: &[Self], most: usize) -> Result<Matrix, CameraFileError> {
        let rows = match items.first().map(|first| &first.value) {
            None => return Err(self.wrong("is empty; expected numbers")),
            Some(Value::List(_)) if items.len() <= most => self.rows()?,
            _ if items.len() <= most => vec![self.row()?],
            _ => return Err(self.wrong(&format!("has {} values; expected no more than {most} numbers", items.len()))),
        };
        let columns = rows[0].len();
        if columns == 0 || columns * rows.len() > most || rows.iter().any(|row| row.len() != columns) {
            return Err(self.wrong(&format!("expected rows of one length, of no more than {most} numbers")));
        }
        Ok(Matrix { rows: rows.len(), columns, data: rows.concat() })
    }

    fn side(&self, text: &str) -> Result<usize, CameraFileError> {
        text.parse::<usize>().ok().filter(|&n| n > 0).ok_or_else(|| self.wrong("expected a whole number from 1"))
    }

    /// Rows and columns of a list of sizes.
    fn sides(&self) -> Result<(usize, usize), CameraFileError> {
        let sides: Vec<usize> = match &self.value {
            Value::List(items) => items.iter().map(|item| item.side(item.text()?)).collect::<Result<_, _>>()?,
            _ => self.text()?.split_whitespace().map(|word| self.side(word)).collect::<Result<_, _>>()?,
        };
        match sides[..] {
            [rows] => Ok((rows, 1)),
            [rows, columns] => Ok((rows, columns)),
            _ => Err(self.wrong(&format!("expected one or two sizes, found {}", sides.len()))),
        }
    }

    fn numbers(&self, count: usize, shape: &str, held: fn(f64) -> f64) -> Result<Vec<f64>, CameraFileError> {
        let one = |line: usize, word: &str| {
            // What the file's own tool would hold.
            finite(word).map(held).map_err(|error| error.on_line(line))
        };
        let wrong = |found: usize| Err(self.wrong(&format!("expected {count} numbers for {shape}, found {found}")));
        match &self.value {
            Value::Scalar(text) => match text.split_whitespace().count() {
                found if found == count => text.split_whitespace().map(|word| one(self.line, word)).collect(),
                found => wrong(found),
            },
            Value::List(list) if list.len() == count => list.iter().map(|entry| one(entry.line, entry.text()?)).collect(),
            Value::List(list) => wrong(list.len()),
            Value::Map(_) => Err(self.wrong("expected numbers")),
        }
    }
}
