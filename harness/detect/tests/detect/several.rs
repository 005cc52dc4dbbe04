//! Several boards of one kind in one image.

use calibench_detect::{Doubt, Found, detect, detect_all, seen_several};
use calibench_model::Image;
use calibench_model::boards::{Layout, examples};

use crate::picture::{View, board, noisy, scale};

/// How far a position may be off, px.
const WITHIN: f64 = 1.0;

/// Pictures side by side, and how far to the right each begins.
fn beside(pictures: &[Image]) -> (Image<'static>, Vec<usize>) {
    let mut starts = vec![0];
    pictures.iter().for_each(|picture| starts.push(starts[starts.len() - 1] + picture.width()));
    let (width, height) = (starts[pictures.len()], pictures.iter().map(Image::height).max().unwrap());
    let at = |x: usize, y: usize| {
        let place = starts.iter().rposition(|start| *start <= x).unwrap();
        let picture = &pictures[place];
        if y < picture.height() { picture.at(x - starts[place], y) } else { 0.5 }
    };
    (Image::from_fn(width, height, at), starts)
}

/// A board moved to the left by where its picture begins.
fn moved(found: &Found, by: usize) -> Found {
    let mut found = found.clone();
    found.points.iter_mut().for_each(|point| point.position.x -= by as f64);
    found
}

fn check(found: &[Found], views: &[View], starts: &[usize], layout: &Layout, what: &str) {
    assert_eq!(found.len(), views.len(), "{what}");
    for (k, view) in views.iter().enumerate() {
        view.check(layout, &moved(&found[k], starts[k]), WITHIN, &format!("{what}, board {k}"));
        assert_eq!(found[k].points.len(), layout.points.len(), "{what}, board {k}");
        assert_eq!(found[k].doubts, [], "{what}, board {k}");
    }
}

/// Two and three in one picture, in any order of sizes and turns, are told apart and have all of their points, from the left.
#[test]
fn each_of_several_boards_is_found_with_its_own_points() {
    for (_, example) in examples() {
        let (board, layout) = board(example);
        let upright = View::whole(&layout, scale(&board, &layout, 4.0));
        let larger = View { tilt: [20.0, 30.0], turn: 8.0, ..View::whole(&layout, scale(&board, &layout, 5.0)) };
        let tilted = View { tilt: [35.0, 0.0], turn: -12.0, ..upright };
        for views in [vec![upright, tilted], vec![tilted, larger], vec![larger, upright, tilted]] {
            let pictures: Vec<Image> = views.iter().map(|view| view.draw(&layout)).collect();
            let (image, starts) = beside(&pictures);
            let what = format!("{example}, {} boards", views.len());
            let found = detect_all(&image, &board).unwrap_or_else(|error| panic!("{what}: {error}"));
            check(&found, &views, &starts, &layout, &what);
            let counts = vec![layout.points.len(); views.len()];
            assert_eq!(seen_several(&image, &board, &detect(&image, &board)), Some(counts), "{what}");
        }
    }
}

#[test]
fn one_board_is_one_and_nothing_is_nothing() {
    for (_, example) in examples() {
        let (board, layout) = board(example);
        let view = View { tilt: [30.0, 50.0], turn: 10.0, ..View::whole(&layout, scale(&board, &layout, 5.0)) };
        let image = view.draw(&layout);
        let alone = detect(&image, &board);
        assert_eq!(seen_several(&image, &board, &alone), None, "{example}");
        assert_eq!(detect_all(&image, &board), alone.map(|found| vec![found]), "{example}");
        let empty = noisy(&Image::from_fn(400, 300, |_, _| 0.5), 0.02, 3);
        let none = detect(&empty, &board);
        assert_eq!(seen_several(&empty, &board, &none), None, "{example}");
        assert_eq!(detect_all(&empty, &board), none.map(|found| vec![found]), "{example}");
    }
}

/// Of a second board a part is in view: its marks are doubtful of the first alone, and a board of their own where each counts.
#[test]
fn a_part_of_a_second_board_has_its_own_points() {
    for (example, down) in [
        ("charuco:8x5:30:21:DICT_4X4_50", 1.1),
        ("aprilgrid:6x6:0.088:0.3", 1.1),
        ("gridboard:5x7:40:10:DICT_6X6_250", 1.1),
        ("rings:12:6x5:50:8", 1.1),
        ("puzzle:23x16:30:50,100", 1.0),
        ("dotted:13x10:25:5,1", 1.0),
    ] {
        let (board, layout) = board(example);
        let whole = View::whole(&layout, scale(&board, &layout, 5.0));
        let part = View { middle: [whole.middle[0], down * whole.height as f64], turn: 5.0, ..whole };
        let (image, starts) = beside(&[whole.draw(&layout), part.draw(&layout)]);
        let found = detect_all(&image, &board).unwrap_or_else(|error| panic!("{example}: {error}"));
        assert_eq!(found.len(), 2, "{example}");
        whole.check(&layout, &found[0], WITHIN, example);
        part.check(&layout, &moved(&found[1], starts[1]), WITHIN, example);
        assert_eq!(found[0].points.len(), layout.points.len(), "{example}");
        assert!(3 * found[1].points.len() < 2 * layout.points.len(), "{example}: {}", found[1].points.len());
    }
}

/// A large board that a coarse scale shows whole hides no small one.
#[test]
fn boards_of_unlike_sizes_are_all_found() {
    for example in ["puzzle:11x8:30:100,200", "dotted:9x6:25"] {
        let (board, layout) = board(example);
        let [small, large] = [4.0, 20.0].map(|pixels| View { turn: 5.0, ..View::whole(&layout, scale(&board, &layout, pixels)) });
        for views in [[small, large], [large, small]] {
            let (image, starts) = beside(&views.map(|view| view.draw(&layout)));
            check(&detect_all(&image, &board).unwrap(), &views, &starts, &layout, example);
            let counts = vec![layout.points.len(); 2];
            assert_eq!(seen_several(&image, &board, &detect(&image, &board)), Some(counts), "{example}");
        }
    }
}

/// A picture with a part of its width covered, as shares of it.
fn covered(picture: &Image, [from, to]: [f64; 2]) -> Image<'static> {
    let is_covered = |x: usize| (from..to).contains(&(x as f64 / picture.width() as f64));
    Image::from_fn(picture.width(), picture.height(), |x, y| if is_covered(x) { 0.4 } else { picture.at(x, y) })
}

/// Of two boards no corner is seen twice, and of one board two parts that nothing joins are.
#[test]
fn parts_are_of_one_board_where_it_goes_on_and_of_two_where_it_does_not() {
    let (board, layout) = board("puzzle:20x12:30:222,333");
    let view = View { tilt: [20.0, 60.0], ..View::whole(&layout, scale(&board, &layout, 5.0)) };
    let picture = view.draw(&layout);
    let [left, right] = [[0.48, 1.0], [0.0, 0.52]].map(|part| covered(&picture, part));
    let (image, starts) = beside(&[right, left]);
    let all = detect_all(&image, &board).unwrap();
    assert_eq!(all.len(), 2, "{:?}", all.iter().map(|found| found.points.len()).collect::<Vec<_>>());
    view.check(&layout, &all[0], WITHIN, "the right half");
    view.check(&layout, &moved(&all[1], starts[1]), WITHIN, "the left half");
    assert!(all.iter().all(|found| (70..120).contains(&found.points.len())));
    let counts = all.iter().map(|found| found.points.len()).collect();
    assert_eq!(seen_several(&image, &board, &detect(&image, &board)), Some(counts));
    let parts = covered(&picture, [0.46, 0.54]);
    let all = detect_all(&parts, &board).unwrap();
    assert_eq!(all.len(), 1);
    view.check(&layout, &all[0], WITHIN, "two parts");
    assert!(all[0].points.len() > 180, "{}", all[0].points.len());
}

/// A mark that is seen twice stays a doubt: fewer than three marks are no board.
#[test]
fn a_mark_that_is_seen_twice_is_in_doubt_whether_or_not_each_board_counts() {
    let (board, layout) = board("gridboard:5x7:40:10:DICT_6X6_250");
    let whole = View::whole(&layout, scale(&board, &layout, 5.0));
    let picture = whole.draw(&layout);
    // Its first marker once more, beside it.
    let corner = whole.at(&layout, layout.markers[0].corners[0]);
    let end = whole.at(&layout, layout.markers[0].corners[2]);
    let (side, rim) = ((end.x - corner.x) as usize, 8);
    let (left, top) = (corner.x as usize - rim, corner.y as usize - rim);
    let marker = Image::from_fn(side + 2 * rim, side + 2 * rim, |x, y| picture.at(left + x, top + y));
    let (image, _) = beside(&[picture.lent(), marker]);
    let said = detect(&image, &board);
    let twice = |found: &Found| found.doubts.iter().any(|doubt| matches!(doubt, Doubt::Twice { id: 0 } | Doubt::Stray { id: 0 }));
    assert!(twice(said.as_ref().unwrap()), "{said:?}");
    assert_eq!(seen_several(&image, &board, &said), None);
    let all = detect_all(&image, &board).unwrap();
    assert!(all.len() == 1 && twice(&all[0]), "{all:?}");
}
