//! Methods that are limited to kinds of targets.

use calibench_measure::{KindsGap, Registry};
use calibench_model::TargetKind;
use calibench_records::results::PointResult;

use super::{scenario, trials};
use crate::{Plan, RunError};

/// A wall with corners and discs; nothing is drawn or adjusted.
fn mixed(methods: &str) -> calibench_scenario::Scenario {
    let kinds = ("kinds = [\"corner\"]", "kinds = [\"corner\", \"disc\"]");
    let text = super::SCENARIO;
    let (calibration, listed) = (text.find("[calibration]").unwrap(), text.find("[[method]]").unwrap());
    scenario(&[kinds, (&text[calibration..listed], ""), (&text[listed..], methods)])
}

fn points(scenario: &calibench_scenario::Scenario, method: usize) -> Vec<PointResult> {
    let all = trials(scenario, 3).into_iter().flat_map(|trial| trial.points);
    all.filter(|point| point.method == method).map(|point| PointResult { method: 0, ..point }).collect()
}

#[test]
fn a_limited_method_gives_for_its_kinds_what_it_gives_for_all() {
    let by_kind =
        mixed("[[method]]\nname = \"ellipse_edges\"\nkinds = [\"disc\"]\n[[method]]\nname = \"forstner\"\nkinds = [\"corner\"]\n");
    let kinds = by_kind.subject.kinds();
    let (discs, corners) = (points(&by_kind, 0), points(&by_kind, 1));
    assert!(!discs.is_empty() && !corners.is_empty());
    for (name, limited, kind) in [("ellipse_edges", &discs, TargetKind::Disc), ("forstner", &corners, TargetKind::Corner)] {
        let all = points(&mixed(&format!("[[method]]\nname = \"{name}\"\n")), 0);
        // Targets of the wall are called `w/1`, `w/2` and so on.
        let of_kind = |point: &PointResult| kinds[point.target.trim_start_matches("w/").parse::<usize>().unwrap() - 1] == kind;
        assert!(all.len() > limited.len());
        assert_eq!(&all.into_iter().filter(of_kind).collect::<Vec<_>>(), limited, "{name}");
    }
}

#[test]
fn drawn_coordinates_are_drawn_for_the_kinds_alone() {
    let kinds = ("kinds = [\"corner\"]", "kinds = [\"corner\", \"disc\"]");
    let limited = ("name = \"forstner\"\n", "name = \"forstner\"\nkinds = [\"corner\"]\n");
    let drawn = ("\"forstner:window=9\"", "\"forstner:window=9,kinds=corner\"");
    let found = scenario(&[kinds, limited, drawn]);
    let of = |method: usize| points(&found, method).len();
    assert!(of(1) > 0 && of(0) > of(1), "{} {}", of(0), of(1));
}

#[test]
fn a_run_that_leaves_targets_to_nobody_is_refused() {
    let found = mixed("[[method]]\nname = \"pixel\"\n");
    let methods = |texts: &[&str]| texts.iter().map(|text| Registry::builtin().parse(text).unwrap()).collect::<Vec<_>>();
    let refused = |texts: &[&str]| {
        let methods = methods(texts);
        let plan = Plan { methods: &methods, ..Plan::new(&found, crate::Tools::default(), std::path::PathBuf::new()) };
        match plan.run(&|| (), &mut |_| Ok(())) {
            Err(RunError::Kinds(gap)) => Some(gap),
            Err(other) => panic!("{other}"),
            Ok(()) => None,
        }
    };
    assert_eq!(refused(&["disc=ellipse_edges"]), Some(KindsGap::Unmeasured(vec![TargetKind::Corner])));
    assert!(matches!(refused(&["pixel", "cross=forstner"]), Some(KindsGap::Idle { index: 1, .. })));
    assert_eq!(refused(&["disc=ellipse_edges", "corner=forstner"]), None);
}

/// Chessboards in one cell, discs in the other: a method may be idle in one of them, its own or one in its place, and in none of all.
#[test]
fn in_a_cell_of_a_sweep_a_method_may_be_idle() {
    let (registry, text) = (Registry::builtin(), super::boards::BOARD);
    let text = text.replace("[camera]", "[sweep]\n\"testfield.board\" = [\"chessboard:7x6:30\", \"circles:6x5:30\"]\n\n[camera]");
    let own = "name = \"parametric_corner\"\nkinds = [\"chess_corner\"]\n\n[[method]]\nname = \"ellipse_edges\"\nkinds = [\"disc\"]";
    let swept = calibench_scenario::parse(
        "small/boards",
        "b.toml",
        &text.replace("WORD", "chessboard:7x6:30").replace("name = \"METHOD\"", own),
        &registry,
    );
    let swept = swept.unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(swept.kinds, [TargetKind::ChessCorner, TargetKind::Disc].to_vec());
    let sweep = swept.sweep.as_ref().unwrap();
    for (index, busy) in [(0, 0), (1, 1)] {
        let cell = calibench_scenario::parse_cell(&swept, sweep, index, &registry).unwrap();
        let run = |methods: &[calibench_measure::Configured]| {
            let plan = Plan { methods, ..Plan::new(&cell, crate::Tools::default(), std::path::PathBuf::new()) };
            let mut all = Vec::new();
            plan.run(&|| (), &mut |trial| {
                all.extend(trial.points.iter().map(|point| point.method));
                Ok(())
            })
            .map(|()| all)
        };
        let of = |texts: &[&str]| texts.iter().map(|text| registry.parse(text).unwrap()).collect::<Vec<_>>();
        let own = run(&cell.methods).unwrap();
        assert!(own.len() > 100 && own.iter().all(|method| *method == busy), "{index}");
        let others = run(&of(&["chess_corner=forstner", "disc=centroid"])).unwrap();
        assert!(others.len() == own.len() && others.iter().all(|method| *method == busy), "{index}");
        assert!(matches!(run(&of(&["pixel", "cross=forstner"])), Err(RunError::Kinds(KindsGap::Idle { index: 1, .. }))));
        let (here, wrong) = [(TargetKind::ChessCorner, "disc=centroid"), (TargetKind::Disc, "chess_corner=forstner")][index];
        assert!(matches!(run(&of(&[wrong])), Err(RunError::Kinds(KindsGap::Unmeasured(left))) if left == [here]));
    }
}
