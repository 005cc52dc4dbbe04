//! Each study has its own section, whatever figures stand in the records beside its own.

use std::path::PathBuf;

use calibench_records::description::{Adjustment, Blocks, Description, Printed, Study, Views};
use calibench_records::figures::Quantity;
use calibench_records::points::{RecordHead, RunInfo};
use calibench_records::results::Trial;
use calibench_records::score::Scores;

use super::{OnPage, Shown, of};
use crate::load::Loaded;
use crate::load::adjustments::{Summaries, Summary};

fn views() -> Box<Views> {
    Box::new(Views { size: [4, 3], unit: "m".into(), extent: None, normal: None, stations: Vec::new(), targets: Vec::new(), room: None })
}

/// The section of a scenario whose records have figures of check points, in one set; without any where there are none.
fn shown(study: Study, has_figures: bool) -> Shown {
    let scenario = Description {
        why: String::new(),
        source: String::new(),
        notes: Vec::new(),
        seed: 1,
        trials: 1,
        bound_window: 11,
        bound_window_discs: None,
        finders: Vec::new(),
        methods: Vec::new(),
        defaults: [].into(),
        study,
        sweep: None,
    };
    let key = ("m".to_owned(), "s".to_owned(), Quantity::RmseXyz.into());
    let figures = [(key, Summary::default())].into();
    let found = Summaries { methods: vec!["m".into()], sets: vec!["s".into()], trials: 1, figures, ..Summaries::default() };
    let loaded = Loaded {
        name: "f/s".into(),
        scenario,
        head: RecordHead { run: RunInfo::default(), methods: Vec::new() },
        scores: Scores { trials: 1, ..Scores::default() },
        first: Trial::default(),
        calibrations: has_figures.then_some(found),
        folder: PathBuf::new(),
    };
    of(&loaded.scenario).of(&loaded, OnPage { stem: "s", illustrated: false, printed: &[] })
}

const SCORES: &str = "[What the columns mean]";

#[test]
fn the_study_alone_says_which_section_it_is() {
    let told = Adjustment { pitch_um: 5.0, drawn: true, acceptance: None };
    let blocks = Blocks { pitch_um: 5.0, pairs: Vec::new(), compared: Vec::new() };
    let printed = Printed {
        sensor: "sensor".into(),
        size: [4, 3],
        pitch_um: 5.0,
        unit: "m".into(),
        cameras: Vec::new(),
        grids: Vec::new(),
        points: Vec::new(),
        network: None,
        variants: Vec::new(),
        again: Vec::new(),
    };
    let all = [
        (Study::Scene, SCORES),
        (Study::Views(views()), SCORES),
        (Study::Network(views(), told), "RF, reported"),
        (Study::Blocks(views(), blocks), "### Blocks"),
        (Study::Transfer(views()), "in space"),
        (Study::Printed(Box::new(printed)), "### Cameras"),
    ];
    for (study, own) in &all {
        let section = shown(study.clone(), true);
        for (_, mark) in &all {
            assert_eq!(section.text.contains(mark), mark == own, "{study:?}, {mark}: {}", section.text);
        }
        assert_eq!(section.scored, *own == SCORES, "{study:?}");
    }
}

/// Records of which nothing could be adjusted are still shown: what was measured, and why not.
#[test]
fn a_study_without_figures_shows_scores() {
    for study in [Study::Network(views(), Adjustment { pitch_um: 5.0, drawn: true, acceptance: None }), Study::Transfer(views())] {
        let section = shown(study, false);
        assert!(section.scored && section.text.contains(SCORES), "{}", section.text);
    }
}
