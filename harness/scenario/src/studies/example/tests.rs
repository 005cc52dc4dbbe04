//! What the example reads.

use calibench_measure::Registry;
use toml::de::DeTable;

use super::{Scale, read};
use crate::section::Section;
use crate::studies::{Seen, StudyPlan};
use crate::{Subject, parse};

const WALL: &str = r#"why = "A wall."
source = "ours"
seed = 3
[camera]
size = [1000, 801]
pitch = 5.0
c = 10.0
[testfield]
kind = "wall"
[[testfield.plate]]
id = "w"
middle = [0, 0, 0]
right = [1, 0, 0]
up = [0, 1, 0]
width = 1600
height = 1400
[testfield.fill]
kinds = ["corner"]
size = 60
rows = 4
columns = 3
[[station]]
name = "front"
at = [0, 0, 6000]
towards = [0, 0, 0]
[pointing]
sigma = 0.4
whole_pixels = false
[[method]]
name = "pixel"
"#;

fn read_scale(text: &str) -> Result<Scale, String> {
    let scenario = parse("s", "s.toml", WALL, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"));
    let Subject::Views(views) = &scenario.subject else { panic!("it has stations") };
    let seen = Seen { camera: &views.camera, field: &views.field, stations: &views.stations, redrawn: false, survey_sigma: None };
    let section = Section { name: "[scale]", span: 0..0, table: DeTable::parse(text).unwrap().into_inner() };
    let mut problems = Vec::new();
    let found = read::read(section, &seen, &mut problems);
    found.ok_or_else(|| problems.into_iter().map(|problem| problem.message).collect::<Vec<_>>().join("; "))
}

#[test]
fn the_example_reads_two_targets_and_says_what_is_wrong() {
    let scale = read_scale("between = [\"w/1\", \"w/3\"]").unwrap();
    assert_eq!((scale, scale.sets(), scale.own_methods()), (Scale { between: [0, 2] }, vec![read::SET.to_owned()], None));
    for (text, message) in [
        ("between = [\"w/1\"]", "`between` is a list of 1: expected two targets"),
        ("between = [\"w/1\", \"x\"]", "no target is called `x`"),
        ("", "[scale] has no `between`"),
        ("between = [\"w/1\", \"w/3\"]\nmore = 1", "unknown key `more` in [scale]: expected `between`"),
    ] {
        assert_eq!(read_scale(text), Err(message.to_owned()), "{text}");
    }
}
