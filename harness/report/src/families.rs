//! Every family's report, by whom composes it.

use calibench_exchange::OutputFolder;

use crate::canvas::write_pictures;
use crate::composed::Composed;
use crate::places::PAGE;
use crate::{Places, ReportError, Written, atlas, conventions, family};

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
