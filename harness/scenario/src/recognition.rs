//! The `[recognition]` table: a coded field is recognised in every image, and measuring starts from what was found.

use calibench_diagnostics::Problem;
use calibench_model::Testfield;
use calibench_recognise::{Classifier, ContourTable, Recogniser};
use calibench_synth::stations::Station;
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::blocks::{filled, matched};
use super::section::Section;

/// The name under which counts of recognition stand in the records.
pub const RECOGNITION: &str = "recognition";

/// Recognition of a coded field in every image, from its design alone: measuring starts there, and what was recognised is counted against the truth.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecognitionWire {
    /// Who tells the shapes apart: `modern`, `contours`, or `contours_few`, whose table was learned on three sharp frontal images alone. Measuring starts
    /// from the first; all are counted.
    #[schemars(with = "Vec<String>")]
    pub classifiers: Spanned<Vec<Spanned<String>>>,
}

/// Images that are counted together.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImagesWire {
    /// What they are called in tables, as in "phi 30".
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// Patterns of stations' names, as in "12*".
    #[schemars(with = "Vec<String>")]
    pub images: Spanned<Vec<Spanned<String>>>,
}

/// A checked `[recognition]` table.
#[derive(Clone, Debug)]
pub struct Recognition {
    /// The classifiers' names.
    pub classifiers: Vec<String>,
    /// The recogniser of each classifier; measuring starts from the first.
    pub recognisers: Vec<Recogniser>,
    /// Images that are counted together: a name, and the places of stations.
    pub images: Vec<(String, Vec<usize>)>,
}

/// The classifiers by name.
const CLASSIFIERS: [(&str, Classifier); 3] =
    [("modern", Classifier::Modern), ("contours", Classifier::Contours), (FEW, Classifier::Contours)];
/// The classifier by contours whose table is of few images.
const FEW: &str = "contours_few";

/// Reads the table.
pub fn read(mut section: Section<'_>, field: &Testfield, stations: &[Station], problems: &mut Vec<Problem>) -> Option<Recognition> {
    let (before, span) = (problems.len(), section.span.clone());
    let listed = section.take_tables("images", "[[recognition.images]]", problems).unwrap_or_default();
    let wire: RecognitionWire = section.read(&["images"], problems)?;
    let (mut classifiers, mut recognisers) = (Vec::<String>::new(), Vec::new());
    for name in wire.classifiers.get_ref() {
        let known = CLASSIFIERS.iter().find(|(known, _)| known == name.get_ref());
        let Some((_, classifier)) = known else {
            let problem = Problem::new(name.span(), format!("no classifier is called `{}`", name.get_ref()));
            problems.push(problem.nearest(name.get_ref(), CLASSIFIERS.iter().map(|(known, _)| *known)));
            continue;
        };
        if classifiers.contains(name.get_ref()) {
            problems.push(Problem::new(name.span(), format!("`{}` stands twice: expected each classifier once", name.get_ref())));
        }
        match Recogniser::new(field, *classifier) {
            Ok(recogniser) => {
                let of_few = name.get_ref() == FEW;
                let recogniser = if of_few { recogniser.with_table(ContourTable::learned_on_few()) } else { recogniser };
                classifiers.push(name.get_ref().clone());
                recognisers.push(recogniser);
            }
            Err(error) => problems.push(Problem::new(span.clone(), format!("[recognition] needs a coded field: {error}"))),
        }
    }
    if wire.classifiers.get_ref().is_empty() {
        problems.push(Problem::new(wire.classifiers.span(), "`classifiers` is empty: expected `modern`, `contours` or others"));
    }
    let names: Vec<&str> = stations.iter().map(|station| station.name.as_str()).collect();
    let mut images: Vec<(String, Vec<usize>)> = Vec::new();
    for section in listed {
        let Some(wire) = section.read::<ImagesWire>(&[], problems) else { continue };
        let name = wire.name.get_ref();
        if images.iter().any(|(other, _)| other == name) {
            problems.push(Problem::new(wire.name.span(), format!("`{name}` stands twice: expected each name once")));
        }
        filled("images", Some(&wire.images), problems);
        images.push((name.clone(), matched("station", wire.images.get_ref(), &names, problems)));
    }
    if images.is_empty() {
        images.push(("all".to_owned(), (0..names.len()).collect()));
    }
    (problems.len() == before).then_some(Recognition { classifiers, recognisers, images })
}
