use calibench_measure::{Registry, conformance};

use super::*;

fn operator(settings: &str) -> Box<dyn Operator> {
    Registry::default().with(method()).parse(&format!("opencv_subpix:{settings}")).unwrap().operator.unwrap()
}

fn at(x: f64, y: f64) -> Start {
    Start::at(PixelPoint::new(x, y))
}

/// A chessboard's corner at (`cx`, `cy`), blurred.
fn saddle(cx: f64, cy: f64) -> Image<'static> {
    Image::from_fn(61, 61, |x, y| (0.5 + 0.4 * ((x as f64 - cx) * 0.9).tanh() * ((y as f64 - cy) * 0.9).tanh()) as f32)
}

#[test]
fn conforms() {
    // One step of single precision at this place is 3.8e-6 px. The default epsilon needs no more: turned images take the same steps.
    for window in (3..=31).step_by(2) {
        conformance::check(&*operator(&format!("window={window}")), 1e-5);
        conformance::check(&*operator(&format!("window={window},iterations=100,epsilon=1e-6")), 1e-5);
    }
}

#[test]
fn a_saddle_is_found_at_its_centre() {
    for (cx, cy) in [(30.0, 30.0), (30.3, 29.8), (29.6, 30.45)] {
        let found = operator("window=11,epsilon=1e-6").measure(&saddle(cx, cy), &at(31.0, 29.0)).unwrap();
        assert!(found.position.distance(PixelPoint::new(cx, cy)) < 0.05, "{found:?}");
    }
}

#[test]
fn a_start_that_is_the_corner_is_measured() {
    let image = saddle(30.0, 30.0);
    let mut fixed = at(31.0, 29.0);
    for _ in 0..5 {
        fixed.position = operator("window=11,epsilon=0,iterations=100").measure(&image, &fixed).unwrap().position;
    }
    // More digits than single precision holds: the start's bits are not the result's.
    for nudge in [0.0, 1e-9, -1e-9] {
        let start = at(fixed.position.x + nudge, fixed.position.y - nudge);
        let found = operator("window=11").measure(&image, &start).unwrap();
        assert!(found.position.distance(fixed.position) < 1e-6, "{found:?}");
    }
}

#[test]
fn what_opencv_passes_over_in_silence_is_rejected() {
    // The corner is farther from the start than half the window: just, and too far for the second run as well.
    let image = saddle(30.0, 30.0);
    assert_eq!(operator("window=11").measure(&image, &at(24.9, 30.0)).unwrap_err(), Rejection::LeftWindow);
    assert_eq!(operator("window=11").measure(&image, &at(24.0, 24.0)).unwrap_err(), Rejection::NoCorner);
    // One straight edge along the columns has no gradient along the rows.
    let edge = Image::from_fn(61, 61, |x, _| if x > 30 { 1.0 } else { 0.0 });
    assert_eq!(operator("window=11").measure(&edge, &at(30.0, 30.0)).unwrap_err(), Rejection::NoCorner);
}

#[test]
fn what_is_not_a_number_is_found_wherever_the_window_goes() {
    let mut image = saddle(30.0, 30.0);
    image.grey_mut()[30 * 61 + 36] = f32::NAN;
    let measure = |x, y| operator("window=11").measure(&image, &at(x, y));
    assert_eq!(measure(30.0, 30.0).unwrap_err(), Rejection::NotFinite);
    // Outside the start's window and ring, inside the corner's.
    assert_eq!(measure(29.2, 30.0).unwrap_err(), Rejection::NotFinite);
    assert_eq!(measure(20.0, 30.0).map_err(|r| r == Rejection::NotFinite), Err(false));
}

#[test]
fn an_image_that_opencv_refuses_is_rejected() {
    for side in 11..=14 {
        let middle = (side / 2) as f64;
        let image = Image::from_fn(side, side, |x, y| ((x + y) % 3) as f32);
        assert_eq!(operator("window=11").measure(&image, &at(middle, middle)).unwrap_err(), Rejection::Border, "{side}");
    }
}

#[test]
fn one_by_one_and_together_are_the_same_bits() {
    let mut image = saddle(30.0, 30.0);
    image.grey_mut()[40 * 61 + 52] = f32::NAN;
    let places = (0..61).step_by(2).flat_map(|x| (0..61).step_by(3).map(move |y| (f64::from(x) + 0.3, f64::from(y))));
    let starts: Vec<Start> = places.map(|(x, y)| at(x, y)).chain([at(f64::NAN, 0.0), at(1e300, 3.0), at(26.9, 30.0)]).collect();
    let operator = operator("window=7");
    let alone: Vec<_> = starts.iter().map(|start| operator.measure(&image, start)).collect();
    assert_eq!(operator.measure_all(&image, &starts), alone);
    for reason in [Rejection::Border, Rejection::NotFinite, Rejection::NoCorner, Rejection::LeftWindow] {
        assert!(alone.contains(&Err(reason)), "{reason}");
    }
    assert!(operator.measure_all(&image, &[]).is_empty());
}
