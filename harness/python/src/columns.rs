//! Tables of records as columns.

use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

use calibench_records::names::{SCENARIO, cell_folder};
use calibench_records::stored::Table;
use csv::{ReaderBuilder, StringRecord};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString};

use crate::error::input;
use crate::pool::released;

/// Columns of numbers; empty cells are NaN.
const NUMBERS: [&str; 9] = ["x", "y", "x_true", "y_true", "bound", "predicted", "value", "sigma", "error"];
/// Columns of whole numbers.
const WHOLE: [&str; 2] = ["trial", "seed"];

/// A column.
enum Column {
    Numbers(Vec<f64>),
    Whole(Vec<i64>),
    /// Places in the list of texts.
    Texts(Vec<u32>),
}

/// A table that is read.
#[derive(Default)]
pub struct Columns {
    names: Vec<String>,
    values: Vec<Column>,
    texts: Texts,
}

/// Texts, each once.
#[derive(Default)]
struct Texts {
    all: Vec<String>,
    places: HashMap<String, u32>,
}

impl Texts {
    fn place(&mut self, text: &str) -> u32 {
        if let Some(&place) = self.places.get(text) {
            return place;
        }
        let place = self.all.len() as u32;
        self.all.push(text.to_owned());
        self.places.insert(text.to_owned(), place);
        place
    }
}

impl Columns {
    /// The table of the records in `folder`: of a sweep that of all cells, one after the other.
    ///
    /// # Errors
    /// A folder without it, a file that cannot be read.
    pub fn of(folder: &Path, table: Table) -> Result<Self, String> {
        let mut all = Self::default();
        if table.is_in(folder).map_err(|error| error.to_string())? {
            all.add(table.open(folder).map_err(|error| error.to_string())?)?;
            return Ok(all);
        }
        if !folder.join(SCENARIO).is_file() {
            return Err(format!("{}: holds no records; expected the folder of a run", folder.display()));
        }
        let cells = (0..).map(|cell| cell_folder(folder, cell)).take_while(|cell| cell.is_dir());
        for cell in cells.filter(|cell| table.is_in(cell).unwrap_or(true)) {
            all.add(table.open(&cell).map_err(|error| error.to_string())?)?;
        }
        Ok(all)
    }

    fn add(&mut self, file: impl Read) -> Result<(), String> {
        let wrong = |error: csv::Error| error.to_string();
        let mut reader = ReaderBuilder::new().from_reader(file);
        if self.names.is_empty() {
            self.names = reader.headers().map_err(wrong)?.iter().map(str::to_owned).collect();
            self.values = self.names.iter().map(|name| Column::of(name)).collect();
        }
        let mut row = StringRecord::new();
        while reader.read_record(&mut row).map_err(wrong)? {
            row.iter().zip(&mut self.values).try_for_each(|(cell, column)| column.push(cell, &mut self.texts))?;
        }
        Ok(())
    }

    /// As a dict of arrays, and of lists of texts.
    ///
    /// # Errors
    /// What Python refuses.
    pub fn into_dict(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let texts: Vec<Bound<'_, PyString>> = self.texts.all.iter().map(|text| PyString::new(py, text)).collect();
        let dict = PyDict::new(py);
        for (name, column) in self.names.into_iter().zip(self.values) {
            match column {
                Column::Numbers(values) => dict.set_item(name, PyArray1::from_vec(py, values))?,
                Column::Whole(values) => dict.set_item(name, PyArray1::from_vec(py, values))?,
                Column::Texts(values) => dict.set_item(name, PyList::new(py, values.iter().map(|place| &texts[*place as usize]))?)?,
            }
        }
        Ok(dict)
    }
}

impl Column {
    fn push(&mut self, cell: &str, texts: &mut Texts) -> Result<(), String> {
        match self {
            Self::Numbers(values) if cell.is_empty() => values.push(f64::NAN),
            Self::Numbers(values) => values.push(cell.parse().map_err(|_| format!("`{cell}` is no number"))?),
            Self::Whole(values) => values.push(cell.parse().map_err(|_| format!("`{cell}` is no whole number"))?),
            Self::Texts(values) => values.push(texts.place(cell)),
        }
        Ok(())
    }

    fn of(name: &str) -> Self {
        if NUMBERS.contains(&name) {
            Self::Numbers(Vec::new())
        } else if WHOLE.contains(&name) {
            Self::Whole(Vec::new())
        } else {
            Self::Texts(Vec::new())
        }
    }
}

/// The columns of a table in `folder`.
///
/// # Errors
/// As [`Columns::of`].
pub fn columns<'py>(py: Python<'py>, folder: &Path, table: Table) -> PyResult<Bound<'py, PyDict>> {
    released(py, || Columns::of(folder, table))?.map_err(input)?.into_dict(py)
}
