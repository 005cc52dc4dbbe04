//! Grids of circles with an origin, in whole and in part; lights; what is unlike the others without being said.

use calibench_detect::{Doubt, detect};
use calibench_model::Image;
use calibench_model::boards::{Layout, Shape};
use calibench_model::testfield::Outline;

use crate::picture::{View, blurred, board, noisy, scale};

/// An origin at a corner, four larger ones, rings, places without a circle.
const WITH_ORIGIN: [&str; 6] = [
    "circles:10x10:20:10:20@r10c1",
    "circles:11x9:20:8:12@r3c3,r3c9,r7c3,r6c9",
    "circles:9x7:20:9:9/4@r3c3,r4c7",
    "circles:8x8:20:9:14/7@r4c4:14@r5c6",
    "circles:9x7:20:9:gap@r3c3,r4c7",
    "acircles:5x9:20:14:14/7@r3c2,r7c2,r7c4",
];

/// A view with a point of the board in its middle.
fn centred(view: View, layout: &Layout, at: [f64; 2], [width, height]: [usize; 2]) -> View {
    let there = view.at(layout, at);
    let middle = [view.middle[0] - there.x + width as f64 / 2.0, view.middle[1] - there.y + height as f64 / 2.0];
    View { width, height, middle, ..view }
}

#[test]
fn an_origin_numbers_the_circles_in_every_turn_dark_and_light() {
    for text in WITH_ORIGIN {
        let (board, layout) = board(text);
        assert!(board.is_coded());
        for (turn, tilt, [paper, ink]) in [
            (0.0, [0.0, 0.0], [0.85, 0.1]),
            (95.0, [35.0, 20.0], [0.1, 0.9]),
            (180.0, [-40.0, 70.0], [0.85, 0.1]),
            (262.0, [30.0, 10.0], [0.2, 0.6]),
        ] {
            let view = View { turn, tilt, paper, ink, ..View::whole(&layout, scale(&board, &layout, 4.0)) };
            let what = format!("{text}, turned by {turn}");
            let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{what}: {error}"));
            view.check(&layout, &found, 1.0, &what);
            assert_eq!((found.points.len(), found.doubts.len()), (layout.points.len(), 0), "{what}: {:?}", found.doubts);
            assert_eq!(found.light, ink > paper, "{what}");
        }
    }
}

#[test]
fn a_part_with_its_origin_is_enough() {
    for (text, at) in [("circles:10x10:20:10:20@r10c1", [60.0, -120.0]), ("circles:14x10:20:7:7/3@r3c3,r8c3,r8c12", [100.0, -90.0])] {
        let (board, layout) = board(text);
        for turn in [0.0, 90.0, 200.0, 310.0] {
            let whole = View { turn, tilt: [30.0, 30.0], ..View::whole(&layout, scale(&board, &layout, 5.0)) };
            let view = centred(whole, &layout, at, [3 * whole.width / 5, 3 * whole.height / 5]);
            let found = detect(&view.draw(&layout), &board).unwrap_or_else(|error| panic!("{text} {turn}: {error}"));
            view.check(&layout, &found, 1.0, text);
            assert!(
                found.points.len() > layout.points.len() / 3 && found.points.len() < layout.points.len(),
                "{text} {turn}: {}",
                found.points.len()
            );
            assert_eq!(found.doubts, [], "{text} {turn}");
        }
    }
}

#[test]
fn a_part_without_its_origin_or_with_one_that_is_half_in_view_is_refused() {
    let (board, layout) = board("circles:10x10:20:10:20@r10c1");
    let whole = View::whole(&layout, scale(&board, &layout, 5.0));
    let size = [3 * whole.width / 5, 3 * whole.height / 5];
    for at in [[120.0, -60.0], [90.0, -60.0]] {
        let error = detect(&centred(whole, &layout, at, size).draw(&layout), &board).unwrap_err();
        assert_eq!(error.name(), "other_marks", "{error}");
    }
    // An origin in the middle of a part leaves four ways.
    let middle = "circles:21x21:20:10:20@r11c11:gap@r21c21".parse().unwrap();
    let (_, layout) = crate::picture::board("circles:21x21:20:10:20@r11c11:gap@r21c21");
    let error = detect(&centred(View { turn: 10.0, ..whole }, &layout, [200.0, -200.0], [200, 200]).draw(&layout), &middle).unwrap_err();
    assert_eq!(error.name(), "unsure_part", "{error}");
}

#[test]
fn what_is_unlike_the_others_is_found_and_said() {
    for (pictured, asked, unlike) in [
        ("circles:10x10:20:10:20@r10c1", "circles:10x10:20:10", 1),
        ("circles:11x9:20:8:12@r3c3,r3c9,r7c3,r7c9", "circles:11x9:20:8", 4),
        ("circles:9x7:20:9:9/4@r3c3,r4c7", "circles:9x7:20:9", 2),
    ] {
        let (of, layout) = board(pictured);
        let view = View { turn: 10.0, tilt: [25.0, 60.0], ..View::whole(&layout, scale(&of, &layout, 5.0)) };
        let found = detect(&view.draw(&layout), &board(asked).0).unwrap_or_else(|error| panic!("{pictured}: {error}"));
        view.check(&layout, &found, 1.0, pictured);
        assert_eq!(found.points.len(), layout.points.len(), "{pictured}");
        let [Doubt::Unlike { circles, instead: Some(instead), .. }] = &found.doubts[..] else { panic!("{pictured}: {:?}", found.doubts) };
        assert_eq!(*circles, unlike, "{pictured}");
        // What is said describes the board, and finds it without a doubt.
        let again = detect(&view.draw(&layout), &instead.parse().unwrap()).unwrap_or_else(|error| panic!("{instead}: {error}"));
        assert_eq!((again.points.len(), again.doubts.len()), (layout.points.len(), 0), "{instead}");
    }
}

/// Squares where two circles are left out, and circles one of which is hidden.
#[test]
fn signs_of_another_shape_and_a_hidden_circle_are_said() {
    let (gaps, mut layout) = board("circles:9x7:20:9:gap@r3c3,r4c7");
    let square = |[u, v]: [f64; 2]| Shape::dark(Outline::rectangle([u - 5.0, v - 5.0], [u + 5.0, v + 5.0]));
    layout.shapes.extend([[40.0, -40.0], [120.0, -60.0]].map(square));
    let view = View { turn: 10.0, tilt: [25.0, 60.0], ..View::whole(&layout, scale(&gaps, &layout, 5.0)) };
    let picture = view.draw(&layout);
    let found = detect(&picture, &gaps).unwrap();
    view.check(&layout, &found, 1.0, "gaps");
    assert_eq!((found.points.len(), found.doubts.len()), (61, 0));
    let (plain, whole) = board("circles:9x7:20:9");
    let found = detect(&picture, &plain).unwrap();
    view.check(&whole, &found, 1.0, "squares");
    assert!(matches!(&found.doubts[..], [Doubt::Unlike { circles: 2, .. }]) && found.points.len() == 63, "{:?}", found.doubts);
    let hidden = view.at(&layout, [60.0, -60.0]);
    let covers = |x: usize, y: usize| (x as f64 - hidden.x).hypot(y as f64 - hidden.y) < 12.0;
    let image = Image::from_fn(picture.width(), picture.height(), |x, y| if covers(x, y) { 0.85 } else { picture.at(x, y) });
    let found = detect(&image, &plain).unwrap();
    assert!(found.doubts.contains(&Doubt::Unseen { corners: 1 }) && found.points.len() == 62, "{:?}", found.doubts);
    assert!(found.points.iter().all(|point| whole.points[point.index].id != "r4c4"));
}

/// Lights of one to four pixels in the dark, of many brightnesses, and dots as small on paper.
#[test]
fn lights_and_dots_of_a_few_pixels_are_found() {
    let (board, layout) = board("circles:6x8:50:5");
    for (pixels, size, noise) in [(14.0, 0.35, 0.0), (14.0, 0.6, 0.01), (25.0, 1.0, 0.02)] {
        for (dark, turn) in [(true, 15.0), (false, 100.0)] {
            let view = View { turn, tilt: [30.0, 20.0], ..View::whole(&layout, pixels / 50.0) };
            let centres: Vec<_> = layout.points.iter().map(|point| view.at(&layout, point.at)).collect();
            let bright = |x: usize, y: usize| {
                let one = |(k, at): (usize, &calibench_model::PixelPoint)| {
                    let far = (x as f64 - at.x).powi(2) + (y as f64 - at.y).powi(2);
                    (0.35 + 0.15 * (k % 5) as f64) * (-0.5 * far / (size * size)).exp()
                };
                centres.iter().enumerate().map(one).sum::<f64>() as f32
            };
            let image =
                Image::from_fn(
                    view.width,
                    view.height,
                    |x, y| if dark { bright(x, y).min(1.0) } else { 0.9 - 0.8 * bright(x, y).min(1.0) },
                );
            let image = noisy(&image, noise, 3);
            let what = format!("{pixels} {size} {dark}");
            let found = detect(&image, &board).unwrap_or_else(|error| panic!("{what}: {error}"));
            let near = |at: &calibench_model::PixelPoint| centres.iter().any(|centre| centre.distance(*at) < 0.7);
            assert!(found.points.len() == 48 && found.points.iter().all(|point| near(&point.position)), "{what}");
            assert!(found.light == dark && found.doubts.is_empty(), "{what}: {:?}", found.doubts);
        }
    }
}

/// As many circles as the board has are never said to be expected to be as many.
#[test]
fn as_many_circles_in_no_such_grid_are_refused_for_what_they_are() {
    let (board, layout) = board("circles:8x6:20:8");
    let with = |size: &dyn Fn(usize) -> f64, by: &dyn Fn(usize) -> f64| {
        let mut layout = layout.clone();
        layout.shapes = layout
            .points
            .iter()
            .enumerate()
            .map(|(k, point)| Shape::dark(Outline::disc([point.at[0] + by(k), point.at[1]], 0.5 * size(k))))
            .collect();
        detect(&View::whole(&layout, 1.5).draw(&layout), &board).unwrap_err()
    };
    let sizes = with(&|k| if k % 2 == 0 { 7.0 } else { 9.5 }, &|_| 0.0);
    assert_eq!(sizes.name(), "other_sizes", "{sizes}");
    let rows = with(&|_| 8.0, &|k| if k / 8 % 2 == 1 { 10.0 } else { 0.0 });
    assert!(rows.name() == "other_rows" && !rows.to_string().contains("expected"), "{rows}");
}

/// In a fisheye no homography has the circles where they are.
#[test]
fn a_grid_in_a_wide_lens_is_found_whole() {
    let (board, layout) = board("circles:11x9:20:8:14@r9c1");
    let flat = View { turn: 20.0, ..View::whole(&layout, 5.0) };
    let picture = flat.draw(&layout);
    // Equidistant, the rim of the board 55 degrees off the axis.
    let (width, height) = (560, 560);
    let (middle, focal) = ([flat.middle[0], flat.middle[1]], 180.0);
    let reach = 0.5 * flat.width as f64 * 0.8 / 55_f64.to_radians().tan();
    let image = Image::from_fn(width, height, |x, y| {
        let off = [x as f64 - 279.5, y as f64 - 279.5];
        let radius = off[0].hypot(off[1]).max(1e-9);
        let angle = (radius / focal).min(1.5);
        let far = reach * angle.tan() / radius;
        let at = [middle[0] + off[0] * far, middle[1] + off[1] * far];
        let inside = picture.holds(at[0].round() as i64, at[1].round() as i64, 1);
        if inside { picture.at(at[0].round() as usize, at[1].round() as usize) } else { 0.5 }
    });
    let found = detect(&blurred(&image, 0.8), &board).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(found.points.len(), layout.points.len());
    for point in &found.points {
        let there = flat.at(&layout, layout.points[point.index].at);
        let off = [there.x - middle[0], there.y - middle[1]];
        let radius = off[0].hypot(off[1]).max(1e-9);
        let far = focal * (radius / reach).atan() / radius;
        let expected = calibench_model::PixelPoint::new(279.5 + off[0] * far, 279.5 + off[1] * far);
        assert!(expected.distance(point.position) < 1.5, "{}: {:?}, not {expected:?}", layout.points[point.index].id, point.position);
    }
}
