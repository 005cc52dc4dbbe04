//! Reading `[scale]`.

use calibench_diagnostics::Problem;
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::Scale;
use crate::section::Section;
use crate::studies::{Seen, StudyPlan, places};

/// The name under which its figure stands in the records.
pub const SET: &str = "scale";

/// The image scale along a line, of what each method measured in each trial.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScaleWire {
    /// The names of two targets.
    #[schemars(with = "Vec<String>")]
    pub between: Spanned<Vec<Spanned<String>>>,
}

impl StudyPlan for Scale {
    fn sets(&self) -> Vec<String> {
        vec![SET.to_owned()]
    }
}

/// Reads the table of a scenario of `views`.
pub fn read(section: Section<'_>, views: &Seen<'_>, problems: &mut Vec<Problem>) -> Option<Scale> {
    let before = problems.len();
    let ScaleWire { between } = section.read(&[], problems)?;
    let targets: Vec<&str> = views.field.targets.iter().map(|target| target.id.as_str()).collect();
    let found = places("target", between.get_ref(), &targets, problems);
    if problems.len() > before {
        return None;
    }
    let count = found.len();
    let two = found.try_into().map(|between| Scale { between });
    two.map_err(|_| problems.push(Problem::new(between.span(), format!("`between` is a list of {count}: expected two targets")))).ok()
}
