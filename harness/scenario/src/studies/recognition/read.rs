//! Reading `[recognition]`.

use calibench_diagnostics::Problem;
use calibench_model::Testfield;
use calibench_recognise::{Classifier, ContourTable, Recogniser};
use calibench_synth::stations::Station;

use super::Recognition;
use super::wire::{ImagesWire, RecognitionWire};
use crate::section::Section;
use crate::studies::{filled, matched};

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
