//! A scenario as its pages tell it: what a report needs of it, beside the records of its run.

mod printed;
mod study;
mod sweep;
mod views;

use std::collections::BTreeMap;
use std::io::{Read, Write};

use serde::{Deserialize, Serialize};

pub use printed::{CheckPoint, PlacedNetwork, Printed, PrintedCamera};
pub use study::{Adjustment, Blocks, Classes, Networks, Study, Systems, Tasks, TestLengths};
pub use sweep::{Axis, Cell, Sweep, Value};
pub use views::{Role, Room, Station, Target, Views};

/// A scenario: its words, what was to be run, and what its pages draw. That of a sweep is of its first cell but for the sweep itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// What the scenario is to show.
    pub why: String,
    /// Its source.
    pub source: String,
    /// Paragraphs of Markdown to be read beside its figures.
    pub notes: Vec<String>,
    /// The seed of its file.
    pub seed: u64,
    /// The number of trials of its file.
    pub trials: u64,
    /// Side of the window to which the Cramér-Rao bound belongs, px.
    pub bound_window: usize,
    /// The same of discs, where it is another.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound_window_discs: Option<usize>,
    /// The labels of the methods of its file, in their order.
    pub methods: Vec<String>,
    /// The names of those of its methods that find boards in whole images.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub finders: Vec<String>,
    /// The label of each operator with all parameters at their defaults, by the operator's name.
    pub defaults: BTreeMap<String, String>,
    /// What is measured, and what is made of it.
    #[serde(rename = "subject")]
    pub study: Study,
    /// What is swept, if anything.
    pub sweep: Option<Sweep>,
}

impl Description {
    /// Side of the window to which the bound of a disc belongs, px.
    pub fn window_of_discs(&self) -> usize {
        self.bound_window_discs.unwrap_or(self.bound_window)
    }

    /// The views of an adjusted scenario and what its adjustment is told.
    pub fn adjusted(&self) -> Option<(&Views, &Adjustment)> {
        if let Study::Network(views, told) = &self.study { Some((views, told)) } else { None }
    }

    /// The views of a scenario with free networks and what these are told.
    pub fn in_blocks(&self) -> Option<(&Views, &Blocks)> {
        if let Study::Blocks(views, told) = &self.study { Some((views, told)) } else { None }
    }

    /// Whether the method of `label` measures points from starts, as those do that are compared with each other: it neither returns its start nor finds the board by itself.
    pub fn compares(&self, label: &str) -> bool {
        looks(label) && !self.finders.iter().any(|name| name == operator(label))
    }

    /// Whether `label` is that of an operator with all parameters at their defaults.
    pub fn is_default(&self, label: &str) -> bool {
        self.defaults.get(operator(label)).is_some_and(|default| default == label)
    }
}

/// The operator of a method's label: `forstner` of `forstner:window=15`.
pub fn operator(label: &str) -> &str {
    label.split(':').next().unwrap_or(label)
}

/// Whether the method of `label` looks at the image: `pixel` returns its start.
pub fn looks(label: &str) -> bool {
    operator(label) != "pixel"
}

/// Whether the method of `label` is limited to kinds of targets, as `forstner:window=11,kinds=corner` is.
pub fn is_limited(label: &str) -> bool {
    label.split([':', ',']).any(|part| part.starts_with("kinds="))
}

/// Writes `description` as JSON.
///
/// # Errors
/// What the output refuses.
pub fn write(mut output: impl Write, description: &Description) -> std::io::Result<()> {
    serde_json::to_writer_pretty(&mut output, description)?;
    writeln!(output)
}

/// Reads what [`write()`] wrote, every number to its last bit.
///
/// # Errors
/// A text of another form, with its line and column.
pub fn read(input: impl Read) -> Result<Description, serde_json::Error> {
    serde_json::from_reader(input)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn described(study: Study) -> Description {
        Description {
            why: "To see \"this\".\n".into(),
            source: "a test".into(),
            notes: vec!["$x$".into()],
            seed: i64::MAX as u64,
            trials: 3,
            bound_window: 15,
            bound_window_discs: None,
            finders: Vec::new(),
            methods: vec!["forstner:window=15".into()],
            defaults: [("forstner".into(), "forstner:window=11".into())].into(),
            study,
            sweep: None,
        }
    }

    fn views(role: Option<Role>) -> Box<Views> {
        let station = Station { name: "1".into(), centre: [0.1 + 0.2, -1.0 / 3.0, 1e-17], sight: [0.0, 5e-324, -1.0], second_step: true };
        Box::new(Views {
            size: [4000, 3000],
            unit: "m".into(),
            extent: Some([[-1.0; 3], [1.0; 3]]),
            normal: None,
            stations: vec![station],
            targets: vec![Target { id: "a".into(), kind: "cross".into(), surveyed: [123.456_789_012_345_67, 2.0, 1e300], role }],
            room: Some(Room { least: 0.1 + 0.2, middle: 1.0 / 3.0 }),
        })
    }

    const TOLD: Adjustment =
        Adjustment { pitch_um: 3.9, drawn: true, acceptance: Some(Classes { horizontal: Some(0.05), vertical: None, spatial: Some(0.1) }) };

    fn blocks() -> Blocks {
        Blocks { pitch_um: 3.9, pairs: vec![["1".into(), "2".into()]], compared: vec!["all".into()] }
    }

    fn networks() -> Networks {
        let acceptance = Some(TestLengths { count: 35, lines: 7, limit: [0.1, 1e-5], most: Some(0.2), sigma: 0.005 });
        let (mounts, distances) = (vec!["left".into()], vec![["a".into(), "b".into()]]);
        Networks { model: "opencv5".into(), sigma_px: 0.1, mounts, distances, acceptance }
    }

    fn tasks() -> Tasks {
        Tasks { model: "opencv5".into(), noise_px: 0.1, count: 20, print: 0.03, scale: 2e-4, flatness: 0.08 }
    }

    #[test]
    fn what_is_written_is_read_again_to_the_last_bit() {
        let (control, check) = (Some(Role::Control), Some(Role::Check));
        let of_views = [
            Study::Views(views(None)),
            Study::Network(views(control), TOLD),
            Study::Blocks(views(None), blocks()),
            Study::Networks(views(None), networks()),
            Study::Tasks(views(None), tasks()),
            Study::Transfer(views(check)),
        ];
        for study in [Study::Scene, Study::Photographs { judged: true }].into_iter().chain(of_views) {
            let description = described(study);
            let mut text = Vec::new();
            write(&mut text, &description).unwrap();
            assert_eq!(read(&text[..]).unwrap(), description);
        }
        let description = described(Study::Scene);
        assert!(
            description.is_default("forstner:window=11") && !description.is_default("forstner:window=15") && !description.is_default("x")
        );
        assert!(read(&b"{}"[..]).is_err());
    }

    /// The keys of files are older than the list of studies.
    #[test]
    fn a_file_tells_a_study_by_its_key_and_has_one_at_most() {
        let file = |study| serde_json::to_value(described(study)).unwrap();
        assert_eq!(file(Study::Scene)["subject"], "scene");
        let of = |study| file(study)["subject"]["views"].clone();
        let (plain, network, blocks) = (Study::Views(views(None)), Study::Network(views(None), TOLD), Study::Blocks(views(None), blocks()));
        let (plain, [network, blocks]) = (of(plain), [network, blocks].map(of));
        assert!(plain["adjustment"].is_null() && plain["blocks"].is_null() && plain.get("study").is_none());
        assert!(network["adjustment"]["pitch_um"] == 3.9 && network["blocks"].is_null());
        let mut both = file(Study::Network(views(None), TOLD));
        both["subject"]["views"]["blocks"] = blocks["blocks"].clone();
        let error = serde_json::from_value::<Description>(both).unwrap_err().to_string();
        assert!(error.contains("expected one of them"), "{error}");
    }

    #[test]
    fn an_adjusted_scenario_has_views_and_an_adjustment() {
        assert_eq!(described(Study::Network(views(None), TOLD)).adjusted(), Some((&*views(None), &TOLD)));
        assert_eq!(described(Study::Blocks(views(None), blocks())).in_blocks(), Some((&*views(None), &blocks())));
        for study in [Study::Scene, Study::Photographs { judged: true }, Study::Views(views(None)), Study::Transfer(views(None))] {
            let description = described(study);
            assert!(description.adjusted().is_none() && description.in_blocks().is_none());
        }
    }

    #[test]
    fn the_operator_of_a_label_stands_before_its_settings() {
        assert_eq!(["forstner", "pixel:kinds=disc", "pixel"].map(looks), [true, false, false]);
        assert_eq!(["pixel:kinds=disc", "a:b=1,kinds=corner+disc", "kinds", "a:b=1"].map(is_limited), [true, true, false, false]);
        assert_eq!(["forstner:window=15,k=a:b", "pixel", ""].map(operator), ["forstner", "pixel", ""]);
    }

    #[test]
    fn what_finds_boards_is_not_compared_with_what_measures_points() {
        let json = r#"{"why": "", "source": "", "notes": [], "seed": 1, "trials": 1, "bound_window": 15, "methods": [], "finders": ["detect"],
            "defaults": {}, "subject": "scene", "sweep": null}"#;
        let found: Description = serde_json::from_str(json).unwrap();
        let compared = ["forstner:window=15", "pixel", "detect", "detect:corrected=1"].map(|label| found.compares(label));
        assert_eq!(compared, [true, false, false, false]);
    }
}
