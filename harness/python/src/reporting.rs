//! `report`: records to pages.

use std::path::PathBuf;

use calibench_report::{Filled, Written, fill, write_index};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::error::{doubt, input, project};
use crate::pool::released;
use crate::session::with_project;

/// Writes the reports of papers or other families of scenarios, all where none is named, from the project's records alone: as `calibench report` does. Their pages.
#[pyfunction]
#[pyo3(signature = (*papers, root = None))]
pub fn report(py: Python<'_>, papers: Vec<String>, root: Option<PathBuf>) -> PyResult<Vec<PathBuf>> {
    with_project(root, |here| {
        let (places, families) = (here.places().map_err(project)?, here.families(&papers).map_err(project)?);
        let families: Vec<(&String, &Vec<String>)> = families.iter().collect();
        let make = |(family, scenarios): &(&String, &Vec<String>)| fill(&places, family, scenarios);
        let write = || {
            let made = families.par_iter().map(make).collect::<Result<Vec<_>, _>>()?;
            made.into_iter().map(Filled::put).collect::<Result<Vec<_>, _>>()
        };
        let written = released(py, write)?.map_err(input)?;
        write_index(&places.reports, &written)?;
        let mut pages = Vec::new();
        for one in written {
            pages.push(match one {
                Written::New(page) => page,
                Written::Kept(page) => {
                    doubt(py, &format!("{}: kept as it is, nothing of it can be measured here", page.display()))?;
                    page
                }
            });
        }
        Ok(pages)
    })
}
