//! The report of a family before it is written: its pages, pictures and tables.

use std::io;
use std::path::PathBuf;

use crate::Places;
use crate::canvas::Pictures;
use crate::places::PAGE;

/// What a report is made of.
pub struct Composed {
    /// File names and Markdown; the first is the family's own page.
    pub(crate) pages: Vec<(String, String)>,
    /// Pictures of these pages.
    pub(crate) pictures: Pictures,
    /// Tables beside them: file names and bytes.
    pub(crate) tables: Vec<(String, Vec<u8>)>,
    /// What a page in one file asks for, as data.
    pub(crate) explorer: Option<serde_json::Value>,
}

impl Composed {
    /// One page with its pictures.
    pub(crate) fn page(text: String, pictures: Pictures) -> Self {
        Self { pages: vec![(PAGE.to_owned(), text)], pictures, tables: Vec::new(), explorer: None }
    }
}

/// The report that is there, as text alone.
pub(crate) fn kept(places: &Places, family: &str) -> io::Result<String> {
    let path: PathBuf = places.reports.join(family).join(PAGE);
    std::fs::read_to_string(&path).map_err(|error| calibench_files::at(&path, &error))
}
