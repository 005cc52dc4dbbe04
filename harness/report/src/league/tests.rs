//! What the league says of tables.

use calibench_records::league::{Answered, Class};

use super::cells::{Honesty, League};
use super::{held_out, page, picture};

fn row(trial: u64, status: &str, frame: Option<f64>, z2: Option<f64>, silent: bool) -> Answered {
    Answered {
        class: "league/good".into(),
        digest: "d".into(),
        system: "s".into(),
        version: "1".into(),
        trial,
        status: status.into(),
        frame,
        covered: frame,
        length: frame,
        z2,
        silent,
        seconds: Some(0.1),
        ..Answered::default()
    }
}

fn league() -> League {
    let class = |name: &str| Class { class: name.into(), why: "Why.".into(), model: "opencv5".into(), photographs: false };
    let noise = |trial: u64| 1.0 + 0.1 * f64::from(trial as u32 % 5);
    let all = |factor: f64, z2: f64, silent: bool| -> Vec<Answered> {
        (0..20).map(|trial| row(trial, "calibrated", Some(factor * noise(trial)), Some(z2 * noise(trial)), silent && trial == 3)).collect()
    };
    let tables = [
        ("near", all(1.02, 1.0, false)),
        ("best", all(1.0, 0.8, false)),
        ("mute", all(1.0001, 9.0, true)),
        ("far", all(2.0, 0.2, false)),
        ("none", (0..20).map(|trial| row(trial, "failed", (trial < 9).then_some(1.0), None, false)).collect()),
        ("other", vec![Answered { message: "has no model opencv5".into(), ..row(0, "unavailable", None, None, false) }]),
    ];
    League::new(vec![class("league/good"), class("league/unasked")], &tables.map(|(name, rows)| (name.to_owned(), rows)))
}

#[test]
fn the_best_and_who_is_as_good_as_it() {
    let league = league();
    assert_eq!(league.classes.len(), 1, "a class that nobody was asked is none");
    let name = |place: usize| league.calibrators[place].name.as_str();
    let place = |wanted: &str| league.calibrators.iter().position(|one| one.name == wanted).unwrap();
    assert_eq!(league.best(0).map(name), Some("best"));
    assert_eq!(league.as_good(0).into_iter().map(name).collect::<Vec<_>>(), ["best", "near"], "one that is wrong in silence is not");
    let (ratio, [low, high]) = league.ratio(0, [place("far"), place("best")]).unwrap();
    assert!((ratio - 2.0).abs() < 1e-9 && low <= ratio && high >= ratio);
    let honesty = |wanted: &str| league.cell(0, place(wanted)).unwrap().honesty();
    assert_eq!(
        ["near", "best", "mute", "far", "none"].map(honesty),
        [Honesty::Honest, Honesty::Honest, Honesty::Overconfident, Honesty::Cautious, Honesty::Silent]
    );
    let none = league.cell(0, place("none")).unwrap();
    assert_eq!((none.frame().unwrap().0, none.ended), (f64::INFINITY, [0, 0, 0, 20]), "a camera in 9 of 20 trials is none in the median");
    assert!(league.cell(0, place("other")).unwrap().unavailable.is_some());
}

/// Who is asked more often is neither the best nor worse for what came after the trials of the others.
#[test]
fn those_that_all_were_asked_about_decide() {
    let class = Class { class: "league/good".into(), why: "Why.".into(), model: "opencv5".into(), photographs: false };
    let noise = |trial: u64| 1.0 + 0.1 * f64::from(trial as u32 % 5);
    let few = |factor: f64| -> Vec<Answered> {
        (0..20).map(|trial| row(trial, "calibrated", Some(factor * noise(trial)), None, false)).collect()
    };
    let more = |factor: f64, later: f64, silent: bool| -> Vec<Answered> {
        let further = (20..300).map(|trial| row(trial, "calibrated", Some(later * noise(trial)), None, silent));
        few(factor).into_iter().chain(further).collect()
    };
    let tables = [("few", few(1.0)), ("later_good", more(1.5, 0.1, false)), ("later_silent", more(1.0001, 9.0, true))];
    let league = League::new(vec![class], &tables.map(|(name, rows)| (name.to_owned(), rows)));
    let name = |place: usize| league.calibrators[place].name.as_str();
    assert_eq!(league.best(0).map(name), Some("few"));
    assert_eq!(league.as_good(0).into_iter().map(name).collect::<Vec<_>>(), ["few", "later_silent"]);
    let silent: Vec<usize> = league.asked(0).map(|(_, cell)| cell.silent()).collect();
    assert_eq!(silent, [0, 0, 280]);
    let figure = picture::figure(&league);
    assert!(page::first(&league, "", &figure).contains("| `later_silent` 93 %") && page::classes(&league).contains("| trials |"));
}

/// Of a version as its name has it.
fn all_of(name: &str) -> Vec<Answered> {
    let version = name.split('_').nth(1).unwrap();
    (0..20)
        .map(|trial| Answered { version: version.into(), ..row(trial, "calibrated", Some(1.0 + 0.1 * trial as f64), Some(1.0), false) })
        .collect()
}

#[test]
fn pages_name_the_best_the_silent_and_who_was_not_asked() {
    let league = league();
    let figure = picture::figure(&league);
    let first = page::first(&league, "", &figure);
    for words in [
        "never wrong without a word: `best` in 1 of 1 classes",
        "| `best`, `near` ",
        "1 of 6 calibrators are wrong and silent",
        "`mute` 5 %",
        "league.png",
        "Of no system two versions",
    ] {
        assert!(first.contains(words), "{words}: {first}");
    }
    let more: Vec<(String, Vec<Answered>)> = ["a_1", "a_2", "a_2_more"].map(|name| (name.to_owned(), all_of(name))).to_vec();
    let class = Class { class: "league/good".into(), why: "Why.".into(), model: "opencv5".into(), photographs: false };
    let first = page::first(&League::new(vec![class], &more), "", &figure);
    assert!(first.contains("| `a_2` and 2 more of s "), "{first}");
    let classes = page::classes(&league);
    for words in ["## good", "Not asked, for want of the model: `other`.", "overconfident", "2.00 (2.00 to 2.00)"] {
        assert!(classes.contains(words), "{words}: {classes}");
    }
}

#[test]
fn photographs_have_a_table_of_what_is_predicted() {
    let class = Class { class: "photographs/mine".into(), why: "Why.".into(), model: "opencv5".into(), photographs: true };
    let split = |trial: u64, held_out: Option<f64>| Answered {
        class: class.class.clone(),
        held_out,
        across: held_out.map(|px| 2.0 * px),
        frame: None,
        ..row(trial, if held_out.is_some() { "calibrated" } else { "failed" }, None, None, false)
    };
    let px = |trial: u64| 0.2 + 0.01 * trial as f64;
    let tables = [
        ("near".to_owned(), (0..5).map(|trial| split(trial, Some(px(trial)))).collect()),
        ("far".to_owned(), (0..5).map(|trial| split(trial, (trial > 0).then(|| 1.5 * px(trial)))).collect()),
    ];
    let text = held_out::section(&League::new(vec![class], &tables));
    let row = |name: &str| text.lines().find(|line| line.contains(name)).unwrap().split('|').map(str::trim).collect::<Vec<_>>();
    assert_eq!(row("`near`")[3..8], ["0.220", "0.200 to 0.240", "", "0.440", ""]);
    assert_eq!(row("`far`")[3..8], ["0.345", "0.315 to none", "1.500 (1.500 to 1.500)", "0.675", "20"]);
    assert!(text.find("`near`") < text.find("`far`") && held_out::section(&League::new(Vec::new(), &tables)).is_empty());
}

#[test]
fn calls_of_one_system_are_compared_among_themselves() {
    let class = Class { class: "league/good".into(), why: "Why.".into(), model: "opencv5".into(), photographs: false };
    let all = |system: &str, px: f64, silent: bool| -> Vec<Answered> {
        (0..20)
            .map(|trial| Answered {
                system: system.into(),
                rms: Some(0.1),
                ..row(trial, "calibrated", Some(px * (1.0 + 0.01 * trial as f64)), Some(1.0), silent)
            })
            .collect()
    };
    let tables = [
        ("a_default".to_owned(), all("a", 3.0, false)),
        ("a_more".to_owned(), all("a", 2.0, false)),
        ("b".to_owned(), all("b", 1.0, false)),
    ];
    let league = League::new(vec![class], &tables);
    let text = super::calls::calls(&league);
    let row = |name: &str| text.lines().find(|line| line.contains(name)).map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
    // `a_more` is the best of its system and not of all.
    assert_eq!(row("`a_more`").unwrap()[4..8], ["1", "1", "0.0", "0.0"]);
    assert_eq!(row("`a_default`").unwrap()[4], "0");
    assert_eq!(row("`b`"), None, "of one call there is nothing to choose");
    assert!(page::first(&league, "", &picture::figure(&league)).contains("0.100"));
    assert!(super::calls::calls(&league.of_system("b")).is_empty());
}
