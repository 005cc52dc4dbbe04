//! Every family's report, by whom composes it.

use std::path::PathBuf;

use calibench_files::{FilledFolder, OutputFolder};

use crate::canvas::write_pictures;
use crate::composed::Composed;
use crate::places::PAGE;
use crate::{Places, ReportError, Written, atlas, conventions, family, league};

/// The report of a family from its records and published tables; `None` where nothing of it could be measured here and an older one is there.
///
/// # Errors
/// Records, tables, speeds or cameras that cannot be read.
pub fn compose(places: &Places, family: &str, scenarios: &[String]) -> Result<Option<Composed>, ReportError> {
    match family {
        conventions::FAMILY => conventions::compose(places).map(Some),
        atlas::FAMILY => atlas::compose(places, scenarios).map(Some),
        league::FAMILY => league::compose(places),
        _ => family::compose(places, family, scenarios),
    }
}

/// A report that is made and has not replaced the older one.
#[derive(Debug)]
pub struct Filled {
    page: PathBuf,
    /// None where the older one stays.
    folder: Option<FilledFolder>,
}

/// Makes the report of `family`. One that could not be measured here at all does not replace one that was measured elsewhere. Of several reports all are made before the
/// first is put: pages are of one state of the records, or of the one before.
///
/// # Errors
/// As [`compose`], and what the file system refuses.
pub fn fill(places: &Places, family: &str, scenarios: &[String]) -> Result<Filled, ReportError> {
    let folder = places.reports.join(family);
    let page = folder.join(PAGE);
    let Some(composed) = compose(places, family, scenarios)? else { return Ok(Filled { page, folder: None }) };
    let output = OutputFolder::open(&folder)?.owned_by("report", places.reports.parent())?;
    let filled = output.filled::<ReportError>(|folder| {
        write_pictures(folder, &composed.pictures)?;
        for (name, text) in &composed.pages {
            folder.write(name, |file| file.write_all(text.as_bytes()))?;
        }
        Ok(composed.tables.iter().try_for_each(|(name, bytes)| folder.write(name, |file| file.write_all(bytes)))?)
    })?;
    Ok(Filled { page, folder: Some(filled) })
}

impl Filled {
    /// Puts it in the place of the older one.
    ///
    /// # Errors
    /// What the file system refuses; the older report is then as it was.
    pub fn put(self) -> Result<Written, ReportError> {
        let Some(folder) = self.folder else { return Ok(Written::Kept(self.page)) };
        folder.put()?;
        Ok(Written::New(self.page))
    }
}
