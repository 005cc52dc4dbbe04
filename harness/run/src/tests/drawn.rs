//! For what random numbers are drawn.

use calibench_measure::Registry;
use calibench_records::results::Trial;
use calibench_scenario::{parse, parse_cell};

use super::{NAME, SCENARIO, error, scenario, trials};
use crate::description::description;

fn trials_of(name: &str, text: &str) -> Vec<Trial> {
    trials(&parse(name, "f.toml", text, &Registry::builtin()).unwrap(), 3)
}

/// Errors of the hand in the first trial, x and y in turn, px.
fn hand(trials: &[Trial]) -> Vec<f64> {
    let points = trials[0].points.iter().filter(|point| point.method == 0);
    points.map(|point| error(&point.outcome)).flat_map(|(x, y)| [x, y]).collect()
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    product(a, b) / (product(a, a) * product(b, b)).sqrt()
}

#[test]
fn another_name_draws_the_same_and_another_picture_nothing_that_has_to_do_with_it() {
    let own = trials_of(NAME, SCENARIO);
    let words = SCENARIO.replace("A wall.", "Other words.").replace("whole_pixels", "# no mouse\nwhole_pixels");
    assert_eq!(own, trials_of("another/name", &words));
    let wider = hand(&trials_of(NAME, &SCENARIO.replace("[1000, 801]", "[1002, 801]")));
    let steadier = hand(&trials_of(NAME, &SCENARIO.replace("sigma = 0.4\nwhole", "sigma = 0.2\nwhole")));
    // 96 coordinates that are independent: four standard deviations. A steadier hand is drawn alike.
    assert!(correlation(&hand(&own), &wider).abs() < 4.0 / 96.0_f64.sqrt());
    assert!((correlation(&hand(&own), &steadier) - 1.0).abs() < 1e-6);
}

#[test]
fn cells_of_a_sweep_draw_the_same() {
    let text = format!("{SCENARIO}\n[sweep]\n\"camera.c\" = [10.0, 10.001]\n");
    let swept = parse(NAME, "f.toml", &text, &Registry::builtin()).unwrap();
    let sweep = swept.sweep.as_ref().unwrap();
    let [one, other] = [0, 1].map(|cell| hand(&trials(&parse_cell(&swept, sweep, cell, &Registry::builtin()).unwrap(), 3)));
    assert!((correlation(&one, &other) - 1.0).abs() < 1e-6);
}

#[test]
fn what_is_drawn_once_is_told_where_there_are_several_trials() {
    const RANDOM: &str = "\n[stations]\nkind = \"random\"\ncount = 1\ndistance = [5, 6]\ntilt = 10\nroll = 180\n";
    let told = |more: &str, changes: &[(&str, &str)]| {
        let text =
            SCENARIO.replacen("columns = 3\n", "columns = 3\nturn = 0\n", 1).replacen("\n[pointing]", &format!("{more}\n[pointing]"), 1);
        description(&super::changed(&text, changes), &[]).notes.join(" ")
    };
    // Targets of a sheet are turned by chance unless the scenario says how.
    let turned = &description(&scenario(&[]), &[]).notes[0];
    assert!(turned.starts_with("Drawn once") && turned.ends_with(": the layout of its targets."), "{turned}");
    let all = told(RANDOM, &[("[testfield]\n", "[testfield]\nsurvey_sigma = 0.001\n"), ("control_sigma = 0.0005\n", "")]);
    assert!(all.starts_with("Drawn once") && all.ends_with(": the stations, errors of the survey."), "{all}");
    assert_eq!(told(RANDOM, &[("trials = 2", "trials = 1")]), "");
    let calibration = &SCENARIO[SCENARIO.find("[calibration]").unwrap()..SCENARIO.find("[[method]]").unwrap()];
    assert_eq!(told(&format!("{RANDOM}each_trial = true\n"), &[(calibration, "")]), "");
    let pattern = told("\n[sensor]\ngrey_noise = 0.01\nprnu = 1\n", &[]);
    assert!(pattern.ends_with(": the pattern of the sensor."), "{pattern}");
}
