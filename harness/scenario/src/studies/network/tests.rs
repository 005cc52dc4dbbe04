//! What the adjustment is told of control.

use calibench_measure::Registry;

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
unit = "m"
[[testfield.plate]]
id = "w"
middle = [0, 0, 0]
right = [1, 0, 0]
up = [0, 1, 0]
width = 1.6
height = 1.4
[testfield.fill]
kinds = ["corner"]
size = 0.06
rows = 4
columns = 3
[[station]]
name = "front"
at = [0, 0, 6]
towards = [0, 0, 0]
[[station]]
name = "left"
at = [-3.5, 0.3, 4.5]
towards = [0, 0.05, 0]
[pointing]
sigma = 0.4
whole_pixels = false
[calibration]
sets = ["c,x0,y0"]
start_c = 9.8
sigma_px = 0.4
[[method]]
name = "pixel"
"#;

/// Standard deviations of each trial's survey and of control, with more keys in [testfield] and in [calibration].
fn sigmas(field: &str, calibration: &str) -> Result<[f64; 2], String> {
    let text = WALL.replacen("unit = \"m\"", &format!("unit = \"m\"\n{field}"), 1);
    let text = text.replacen("sigma_px = 0.4\n", &format!("sigma_px = 0.4\n{calibration}\n"), 1);
    let scenario = parse("s", "s.toml", &text, &Registry::builtin()).map_err(|problems| problems.to_string())?;
    let Subject::Views(views) = scenario.subject else { panic!("it has stations") };
    let calibration = views.study.network().cloned().expect("it has a [calibration]");
    Ok([calibration.survey_sigma, calibration.control_sigma])
}

#[test]
fn control_is_as_well_known_as_it_was_surveyed() {
    for (field, calibration, expected) in [
        ("", "", [0.0, 0.0]),
        ("", "survey_sigma = 0.002", [0.002, 0.002]),
        ("survey_sigma = 0.003", "", [0.0, 0.003]),
        ("survey_sigma = 0", "survey_sigma = 0.002", [0.002, 0.002]),
        // What the adjustment is told may be wrong on purpose.
        ("survey_sigma = 0.003", "control_sigma = 0.001", [0.0, 0.001]),
        ("", "survey_sigma = 0.002\ncontrol_sigma = 0", [0.002, 0.0]),
    ] {
        assert_eq!(sigmas(field, calibration), Ok(expected), "{field} {calibration}");
    }
    let both = sigmas("survey_sigma = 0.003", "survey_sigma = 0.002").unwrap_err();
    assert!(both.contains("`survey_sigma` stands in [calibration] and, with 0.003, in [testfield]"), "{both}");
}
