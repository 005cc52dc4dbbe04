//! Zhu, Wu & Wan 2007: the printed tables, starts from a detector, and the bias of the strength's maximum.

use calibench_measure::Registry;
use calibench_measure::harris_paraboloid::HarrisParaboloid;
use calibench_measure::{Operator, Settings};
use calibench_model::{PixelPoint, Rejection, Start};
use calibench_records::theory::{HALF, THEORY, read};
use calibench_run::Plan;
use calibench_scenario::parse;
use calibench_synth::optics::Optics;
use calibench_synth::raster::{Picture, Renderer};
use calibench_synth::testfield::{Figure4, Zhu};

use crate::project::{copy, run, stderr};

/// A printed table: its cells as (row, column, printed).
fn printed(table: &str) -> Vec<[String; 3]> {
    let path = crate::project::root().join(format!("reference/published/zhu-2007/{table}.toml"));
    let text: toml::Table = std::fs::read_to_string(path).unwrap().parse().unwrap();
    let cells = text["cell"].as_array().unwrap();
    cells.iter().map(|cell| ["row", "column", "printed"].map(|key| cell[key].as_str().unwrap().to_owned())).collect()
}

/// The transcription of a table, where this machine has it.
fn transcription(name: &str) -> Option<Vec<Vec<String>>> {
    let folder =
        std::env::var_os("CALIBENCH_TRANSCRIPTIONS").map_or_else(|| crate::project::root().join("../shared/published"), Into::into);
    let Ok(text) = std::fs::read_to_string(folder.join(name)) else {
        eprintln!("skipped: {name} is not on this machine");
        return None;
    };
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    Some(lines.map(|line| line.split(',').map(str::to_owned).collect()).collect())
}

#[test]
fn table_1_is_the_transcription() {
    let Some(rows) = transcription("zhu-2007-table1.csv") else { return };
    let cells = printed("table-1");
    for row in &rows {
        for (column, index) in [("x", 3), ("y", 4), ("v", 5)] {
            let cell = cells.iter().find(|[r, c, _]| *r == format!("({})", row[0]) && c == column).unwrap();
            assert_eq!(cell[2], row[index], "({}) {column}", row[0]);
        }
    }
    // Below them m, and the point of Fig. 3.
    assert_eq!((rows.len(), cells.len()), (8, 44));
}

#[test]
fn the_printed_residuals_are_those_of_the_coordinates() {
    let cells = printed("table-1");
    let value = |row: &str, column: &str| cells.iter().find(|[r, c, _]| r == row && c == column).unwrap()[2].parse::<f64>().unwrap();
    for row in ["(a)", "(b)", "(c)", "(d)", "(e)", "(f)", "(g)", "(h)"] {
        for (coordinate, residual) in [("x", "v_x"), ("y", "v_y")] {
            assert!((value(row, coordinate) - 248.5 - value(row, residual)).abs() < 1.001e-3, "{row} {residual}");
        }
        let misprint = (value(row, "v_x").hypot(value(row, "v_y")) - value(row, "v")).abs() > 5.5e-4;
        assert_eq!(misprint, ["(b)", "(f)", "(g)", "(h)"].contains(&row), "{row}");
    }
}

#[test]
fn table_2_is_the_transcription_in_both_readings() {
    let Some(rows) = transcription("zhu-2007-table2.csv") else { return };
    let cells = printed("table-2");
    assert_eq!((rows.len(), cells.len()), (5, 10));
    for row in &rows {
        assert_eq!(cells.iter().filter(|cell| cell[0] == row[0] && cell[2] == row[1]).count(), 2, "{row:?}");
    }
}

/// The search of `zhu_search` shares no code with the operator but the fit of the paraboloid: its |v| for the scenario's setting, and the printed m.
#[test]
fn the_operator_measures_what_the_search_found() {
    let path = crate::project::root().join("scenarios/zhu-2007/table-1.toml");
    // The others' methods have no part in it, and not every build has OpenCV's.
    let text = std::fs::read_to_string(path).unwrap().replace("[[method]]\nname = \"opencv_subpix\"\nwindow = 11\n", "");
    let scenario = parse("zhu-2007/table-1", "table-1.toml", &text, &Registry::builtin()).unwrap();
    let method = scenario.methods.iter().position(|method| method.label.starts_with("harris_paraboloid")).unwrap();
    let mut trials = Vec::new();
    let sink = &mut |trial| {
        trials.push(trial);
        Ok(())
    };
    Plan::new(&scenario, calibench_run::Tools::default(), std::path::PathBuf::new()).run(&|| (), sink).unwrap();
    let mine = trials[0].points.iter().filter(|point| point.method == method);
    let found: Vec<f64> = mine
        .map(|point| match point.outcome {
            calibench_records::results::Outcome::Measured { error: Some((dx, dy)), .. } => dx.hypot(dy),
            _ => panic!("{point:?}"),
        })
        .collect();
    let searched = [0.051, 0.035, 0.054, 0.117, 0.192, 0.316, 0.175, 0.024];
    assert!(found.len() == 8 && found.iter().zip(searched).all(|(v, s)| (v - s).abs() < 5.5e-4), "{found:?}");
    let m = (found.iter().map(|v| v * v).sum::<f64>() / 8.0).sqrt();
    assert!((m - 0.153).abs() < 5e-4, "printed: 0.153; {m}");
}

fn corner(angle: f64, phase: (f64, f64)) -> (calibench_model::Image<'static>, PixelPoint) {
    let at = PixelPoint::new(31.5 + phase.0, 31.5 + phase.1);
    let zhu = Zhu { side: 64, at, arm: 26.0, angle: Some(angle), stroke: 1.0, ..Zhu::default() };
    let scene = zhu.scene(Figure4::Solid30).unwrap();
    let optics = Optics { blur: 0.7, ..Optics::default() };
    (Renderer::new(&optics, 64, 64).unwrap().render(&Picture::from(&scene), &[]), at)
}

/// Mean error along and across the bisector over phases, px.
fn bias(angle: f64, sigma: f64, alpha: f64) -> (f64, f64) {
    let configured = Registry::builtin().parse(&format!("harris_paraboloid:window=17,sigma={sigma},alpha={alpha}")).unwrap();
    let operator = HarrisParaboloid::of(&configured.settings as &Settings);
    // Phases that no symmetry of the grid makes ties of.
    let phases = [-0.4, -0.2, 0.0, 0.2, 0.4].into_iter().flat_map(|x| [-0.31, -0.11, 0.09, 0.29].map(move |y| (x + 0.03, y)));
    let errors: Vec<(f64, f64)> = phases
        .map(|phase| {
            let (image, at) = corner(angle, phase);
            let found = operator.measure(&image, &Start::at(at)).unwrap().position;
            (found.x - at.x, found.y - at.y)
        })
        .collect();
    let mean = |of: fn(&(f64, f64)) -> f64| errors.iter().map(of).sum::<f64>() / errors.len() as f64;
    (mean(|e| e.0), mean(|e| e.1))
}

#[test]
fn the_bias_runs_along_the_bisector_and_grows_with_sharpness_and_integration() {
    let mut last = f64::INFINITY;
    for angle in [30.0, 60.0, 90.0, 120.0] {
        let (along, across) = bias(angle, 1.0, 0.04);
        assert!(along > 0.3 && across.abs() < 0.06 * along, "{angle}: {along} {across}");
        assert!(along < last, "{angle}: {along} after {last}");
        last = along;
    }
    let widths = [0.7, 1.0, 1.5, 2.0].map(|sigma| bias(90.0, sigma, 0.04).0);
    assert!(widths.windows(2).all(|pair| pair[0] < pair[1]), "{widths:?}");
}

#[test]
fn the_determinant_alone_is_biased_the_more_the_sharper_the_corner_and_the_wider_the_integration() {
    let angles = [30.0, 60.0, 90.0, 120.0, 150.0];
    let all = angles.map(|angle| [0.5, 1.0, 1.5, 2.0].map(|sigma| bias(angle, sigma, 0.0).0));
    assert!(all.iter().all(|by_width| by_width.windows(2).all(|pair| pair[0] < pair[1])), "{all:?}");
    assert!(all.windows(2).all(|pair| pair[0].iter().zip(&pair[1]).all(|(sharp, blunt)| sharp > blunt)), "{all:?}");
}

#[test]
fn the_trace_hides_a_blunt_corner_that_is_narrowly_integrated() {
    // Of two edges at 150 degrees the determinant is at most sin^2(150) / 4 = 0.0625 of the squared trace, less at a rounded tip.
    let (image, at) = corner(150.0, (0.1, 0.2));
    let found = |spec: &str| {
        let configured = Registry::builtin().parse(&format!("harris_paraboloid:window=15,{spec}")).unwrap();
        HarrisParaboloid::of(&configured.settings).measure(&image, &Start::at(at))
    };
    assert_eq!(found("sigma=1,alpha=0.04").unwrap_err(), Rejection::NoCorner);
    assert_eq!(found("sigma=1,alpha=0.0626").unwrap_err(), Rejection::NoCorner);
    assert!(found("sigma=1,alpha=0").is_ok() && found("sigma=4,alpha=0.04").is_ok());
}

const DETECTED: &str = r#"why = "A corner that is found and a place where nothing is."
source = "a test"
seed = 1

[scene]
width = 80
height = 80
background = 0.8

[scene.pointing]
detector = "harris"
within = 4

[[scene.polygon]]
id = "a"
grey = 0.2
vertices = [[20, 20], [60, 20], [60, 60], [20, 60]]

[[scene.target]]
id = "there"
kind = "corner"
at = [20, 20]

[[scene.target]]
id = "nowhere"
kind = "junction"
at = [40, 40]

[[method]]
name = "pixel"

[[method]]
name = "harris_paraboloid"
"#;

#[test]
fn a_target_without_detection_is_a_missed_row_of_every_method() {
    let scenario = parse("family/test", "test.toml", DETECTED, &Registry::builtin()).unwrap();
    assert!(scenario.is_deterministic());
    let mut trials = Vec::new();
    let plan = Plan::new(&scenario, calibench_run::Tools::default(), std::path::PathBuf::new());
    plan.run(&|| (), &mut |trial| {
        trials.push(trial);
        Ok(())
    })
    .unwrap();
    let outcomes: Vec<_> = trials[0].points.iter().map(|point| (point.method, &*point.target, point.outcome)).collect();
    assert_eq!(outcomes.len(), 4);
    for (method, target, outcome) in outcomes {
        if target == "nowhere" {
            assert_eq!(outcome, calibench_records::results::Outcome::Rejected(Rejection::NotDetected), "{method}");
        } else {
            assert!(outcome.position().unwrap().distance(PixelPoint::new(20.0, 20.0)) < 2.0, "{method}");
        }
    }
}

#[test]
fn theory_stands_beside_the_records_of_a_scene_without_noise() {
    let theory = |text: &str| {
        let project = copy();
        std::fs::create_dir_all(project.path().join("scenarios/t")).unwrap();
        std::fs::write(project.path().join("scenarios/t/s.toml"), text).unwrap();
        let ran = run(project.path(), &["run", "t/s", "--quiet"]);
        assert!(ran.status.success(), "{}", stderr(&ran));
        let file = std::fs::File::open(project.path().join("records/t/s").join(THEORY)).ok();
        file.map(|file| read(file).unwrap())
    };
    assert!(
        theory(&DETECTED.replace("background = 0.8", "background = 0.8\ngrey_noise = 0.01")).is_none(),
        "theory is of an image without noise"
    );
    let all = theory(DETECTED).unwrap();
    let [there] = &all[..] else { panic!("a flat patch has no strength: {all:?}") };
    let strengths = there.strengths.as_ref().unwrap();
    let most = strengths.values.iter().flatten().copied().fold(0.0, f64::max);
    assert_eq!((there.method.as_str(), there.target.as_str()), ("harris_paraboloid:window=11", "there"));
    assert_eq!(strengths.values[HALF][HALF], most, "the strongest pixel is in the middle");
    assert!(strengths.maximum.unwrap().distance(PixelPoint::new(20.0, 20.0)) < 2.0);
    let sigmas = there.sigmas.unwrap();
    assert!([sigmas.printed, sigmas.corrected, sigmas.nine, sigmas.uncorrelated].iter().all(|sigma| *sigma > 0.0), "{sigmas:?}");
}

#[test]
fn mistakes_in_a_detector_have_their_place() {
    let cases = [
        ("within = 4", "withn = 4", "12:1", "did you mean `within`"),
        ("within = 4", "within = -1", "12:10", "found -1"),
        ("detector = \"harris\"", "detector = \"haris\"", "11:12", "harris"),
        ("within = 4", "whole_pixels = true", "12:1", "unknown key `whole_pixels`"),
    ];
    for (old, new, place, part) in cases {
        let found =
            parse("family/test", "test.toml", &DETECTED.replace(old, new), &Registry::builtin()).err().expect("a mistake").to_string();
        assert!(found.contains(&format!("test.toml:{place}")) && found.contains(part), "{new}: {found}");
    }
}
