use calibench_random::Key;
use calibench_synth::testfield::{Chessboard, Coded, Levels};

use super::*;

const KEY: Key<'_> = Key { seed: 12, of: "design", trial: 0, view: "", target: "" };

/// What is read off the plate alone is what the list says, where there is one.
#[test]
fn printed_targets_are_as_the_listed_ones() {
    let all = Coded { measured: 8, ..Coded::paper() }.generate(KEY).unwrap();
    let bare = Design::of(&Testfield { targets: Vec::new(), ..all.clone() }).unwrap();
    let listed = Design::of(&all).unwrap();
    assert_eq!((bare.squares, listed.squares), (8, 8));
    assert!((bare.line - 2.0 / 125.0).abs() < 1e-12, "{}", bare.line);
    for (row, column) in (0..8).flat_map(|row| (0..8).map(move |column| (row, column))) {
        for (a, b) in bare.cell(row, column).iter().zip(listed.cell(row, column)) {
            let target = &all.targets[b.target.unwrap()];
            assert!(target.id.starts_with(&format!("r{}c{}-{}-", row + 1, column + 1, if a.large { "large" } else { "small" })));
            assert_eq!((a.kind, a.large, a.target), (b.kind, b.large, None));
            let same = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9;
            // A disc has no turn.
            let turned = a.kind == TargetKind::Disc || (same(a.axes[0], b.axes[0]) && same(a.axes[1], b.axes[1]));
            assert!(same(a.at, b.at) && turned, "{a:?} {b:?}");
        }
    }
}

#[test]
fn fields_of_one_square_and_of_other_sizes_are_read() {
    for squares in 1..=3 {
        let coded = Coded {
            squares,
            measured: squares,
            spacing: 80.0,
            line: 3.0,
            small: [6.0, 8.0, 9.0, 8.0],
            large: [11.0, 16.0, 16.0, 15.0],
            ..Coded::paper()
        };
        let design = Design::of(&coded.generate(KEY).unwrap()).unwrap();
        assert_eq!(design.squares, squares);
        assert!((design.line - 3.0 / 80.0).abs() < 1e-12);
    }
}

#[test]
fn what_is_not_a_coded_field_is_refused_by_name() {
    let coded = Coded { squares: 2, measured: 2, ..Coded::paper() }.generate(KEY).unwrap();
    let mut two = coded.clone();
    two.plates.push(two.plates[0].clone());
    assert_eq!(Design::of(&two).unwrap_err(), NotCoded::Sheets(2));
    let mut one_less = coded.clone();
    one_less.plates[0].areas.pop();
    one_less.targets.pop();
    assert_eq!(Design::of(&one_less).unwrap_err(), NotCoded::Square { row: 2, column: 2, found: 15 });
    let mut moved = coded;
    moved.targets[3].at[0] += 1.0;
    let id = moved.targets[3].id.clone();
    assert_eq!(Design::of(&moved).unwrap_err(), NotCoded::NotPrinted(id));
    let levels = Levels::default();
    let board = Chessboard { rows: 6, columns: 9, square: 25.0, margin: 20.0, bend: None, print_noise: 0.0, levels, background: 0.2 };
    assert_eq!(Design::of(&board.generate(KEY).unwrap()).unwrap_err(), NotCoded::NoGrid);
}
