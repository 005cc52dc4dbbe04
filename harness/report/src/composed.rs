//! The report of a family before it is written: its pages, pictures and tables.

use std::io;
use std::path::PathBuf;

use calibench_exchange::OutputFolder;

use crate::canvas::{Pictures, write_pictures};
use crate::places::PAGE;
use crate::{Places, ReportError, Written, atlas, conventions, family};

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

/// The report of a family from its records and published tables; `None` where nothing of it could be measured here and an older one is there.
///
/// # Errors
/// Records, tables, speeds or cameras that cannot be read.
pub fn compose(places: &Places, family: &str, scenarios: &[String]) -> Result<Option<Composed>, ReportError> {
    match family {
        conventions::FAMILY => conventions::compose(places).map(Some),
        atlas::FAMILY => atlas::compose(places, scenarios).map(Some),
        _ => family::compose(places, family, scenarios),
    }
}

/// Writes the report of `family`, in place of the older one. One that could not be measured here at all does not replace one that was measured elsewhere.
///
/// # Errors
/// As [`compose`], and what the file system refuses; the older report is then as it was.
pub fn write(places: &Places, family: &str, scenarios: &[String]) -> Result<Written, ReportError> {
    let page = places.reports.join(family).join(PAGE);
    let Some(composed) = compose(places, family, scenarios)? else { return Ok(Written::Kept(page)) };
    OutputFolder::open(&places.reports.join(family))?.replace(|folder| {
        write_pictures(folder, &composed.pictures)?;
        for (name, text) in &composed.pages {
            folder.write(name, |file| file.write_all(text.as_bytes()))?;
        }
        composed.tables.iter().try_for_each(|(name, bytes)| folder.write(name, |file| file.write_all(bytes)))
    })?;
    Ok(Written::New(page))
}

/// The report that is there, as text alone.
pub(crate) fn kept(places: &Places, family: &str) -> io::Result<String> {
    let path: PathBuf = places.reports.join(family).join(PAGE);
    std::fs::read_to_string(&path).map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", path.display())))
}
