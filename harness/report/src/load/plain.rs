//! The records of a scenario without a sweep.

use std::path::{Path, PathBuf};

use calibench_images::photo::{Levels, read_levels, read_photo};
use calibench_model::Image;
use calibench_records::description::Description;
use calibench_records::names::{SCENARIO, kept_image};
use calibench_records::points::RecordHead;
use calibench_records::results::Trial;
use calibench_records::score::Scores;
use calibench_records::stored::{Table, read_points};

use super::LoadError;
use super::adjustments::{self, Summaries};
use super::description::description;
use super::groups::{groups, limited};

/// All that a report needs of one scenario. Its size does not grow with the number of trials.
pub struct Loaded {
    /// The scenario's name.
    pub name: String,
    /// The scenario as it was run.
    pub scenario: Description,
    /// Run and methods.
    pub head: RecordHead,
    /// The figures of all trials.
    pub scores: Scores,
    /// The first trial, point by point.
    pub first: Trial,
    /// Its adjustments, if it makes any.
    pub calibrations: Option<Summaries>,
    /// Where the images of the first trial are.
    pub folder: PathBuf,
}

/// Reads the records of scenario `name` below the records folder.
///
/// # Errors
/// Records that are absent or not of this version.
pub fn load(records: &Path, name: &str) -> Result<Loaded, LoadError> {
    let folder = records.join(name);
    if !Table::Points.is_in(&folder)? {
        return Err(LoadError::None(name.to_owned()));
    }
    let scenario = description(&folder, name)?.ok_or_else(|| LoadError::None(name.to_owned()))?;
    let mut scores = Scores { groups: groups(&scenario), ..Scores::default() };
    let mut first = None;
    // The methods of a file are named as they come.
    let head = read_points(&folder, name, |trial, methods| {
        scores.limited = limited(methods);
        scores.add(&trial, |method| methods.get(method).is_some_and(|info| scenario.compares(&info.label)));
        first.get_or_insert(trial);
    })?;
    scores.methods.resize_with(head.methods.len(), Default::default);
    let calibrations = adjustments::load(&folder, name)?;
    Ok(Loaded { name: name.to_owned(), calibrations, scenario, head, scores, first: first.unwrap_or_default(), folder })
}

/// The names of all scenarios that have records, those of files elsewhere (`local/...`) among them.
pub fn recorded(records: &Path) -> Vec<String> {
    let mut names = Vec::new();
    let mut folders = vec![(records.to_owned(), String::new())];
    while let Some((folder, name)) = folders.pop() {
        if folder.join(SCENARIO).is_file() {
            // The cells of a sweep lie below it.
            names.push(name.clone());
            continue;
        }
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten().filter(|entry| entry.path().is_dir()) {
            let part = entry.file_name().to_string_lossy().into_owned();
            if !part.starts_with('.') {
                let below = if name.is_empty() { part } else { format!("{name}/{part}") };
                folders.push((entry.path(), below));
            }
        }
    }
    names
}

impl Loaded {
    /// The image of view `view` in the first trial, if it was kept, in the memory that it takes as a file of whole numbers.
    pub fn levels(&self, view: &str) -> Option<Levels> {
        read_levels(&kept_image(&self.folder, view)).ok()
    }

    /// As [`Self::levels`], as grey values.
    pub fn image(&self, view: &str) -> Option<Image<'static>> {
        Some(read_photo(&kept_image(&self.folder, view)).ok()?.image)
    }

    /// The place of the method with this label.
    pub fn method(&self, label: &str) -> Option<usize> {
        self.head.methods.iter().position(|method| &*method.label == label)
    }

    /// Why nothing was measured, if so: the reason that all methods share.
    pub fn unavailable(&self) -> Option<&str> {
        let first = self.head.methods.first()?.unavailable.as_deref()?;
        self.head.methods.iter().all(|method| method.unavailable.is_some()).then_some(first)
    }
}
