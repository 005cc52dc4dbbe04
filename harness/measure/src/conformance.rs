//! What every operator must do, whoever wrote it: one check for all.

use calibench_model::{Image, PixelPoint, Rejection, Start};

use crate::operator::Operator;

/// The corner that is pictured, from the image's centre, px.
const CORNER: (f64, f64) = (0.31, -0.17);
const SIDE: usize = 90;
/// Where the check starts, from the image's centre, px: not a tie for rounding in any orientation.
const OFFSET: (f64, f64) = (0.9, 0.7);

/// A blurred corner of 80 degrees at (0.31, -0.17) px from the middle of a square image of `side` px, with a faint texture that has no symmetry.
#[cfg(test)]
pub(crate) fn textured_corner(side: usize) -> Image<'static> {
    let middle = (side / 2) as f64;
    Image::from_fn(side, side, |x, y| grey(x as f64 - middle, y as f64 - middle))
}

fn grey(x: f64, y: f64) -> f32 {
    (0.15 + 0.7 * edge(x, y, 0.2) * edge(x, y, 0.2 + 100_f64.to_radians()) + texture(x, y)) as f32
}

/// A blurred edge through the corner, from 0 to 1 in direction `angle`.
fn edge(x: f64, y: f64, angle: f64) -> f64 {
    let (u, v) = (x - CORNER.0, y - CORNER.1);
    0.5 + 0.5 * ((u * angle.cos() + v * angle.sin()) * 1.2).tanh()
}

fn texture(x: f64, y: f64) -> f64 {
    0.004 * ((0.31 * x + 0.17 * y).sin() + (0.23 * x - 0.41 * y).cos())
}

/// What is pictured: the grey value at (x, y) from the image's centre, px. The point to be measured is at (0.31, -0.17).
pub type Picture = fn(f64, f64) -> f32;

/// A blurred chess corner of 80 degrees with the same texture, for operators that measure no other corner.
pub fn chess_corner(x: f64, y: f64) -> f32 {
    let sign = |angle: f64| 2.0 * edge(x, y, angle) - 1.0;
    (0.5 + 0.35 * sign(0.2) * sign(0.2 + 100_f64.to_radians()) + texture(x, y)) as f32
}

/// A blurred dark ellipse of 6.5 x 4.5 px with the same texture, for operators that measure discs.
pub fn disc(x: f64, y: f64) -> f32 {
    let (sin, cos) = 0.4_f64.sin_cos();
    let (u, v) = (x - CORNER.0, y - CORNER.1);
    let (u, v) = ((u * cos + v * sin) / 6.5, (v * cos - u * sin) / 4.5);
    (0.5 + 0.35 * (6.0 * (u.hypot(v) - 1.0)).tanh() + texture(x, y)) as f32
}

/// A blurred board of 4 x 4 squares, 10 px wide and at 80 degrees, on a bright ground with the same texture, for operators that seek a board of 3 x 3 inner
/// corners: the middle one is measured.
pub fn chessboard(x: f64, y: f64) -> f32 {
    const SQUARE: f64 = 10.0;
    let along = |angle: f64| (x - CORNER.0) * angle.cos() + (y - CORNER.1) * angle.sin();
    let [u, v] = [along(0.2), along(0.2 + 100_f64.to_radians())];
    let sign = |t: f64| (1.2 * SQUARE / std::f64::consts::PI * (t * std::f64::consts::PI / SQUARE).sin()).tanh();
    let inside = |t: f64| 0.5 + 0.5 * (1.2 * (2.0 * SQUARE - t.abs())).tanh();
    let board = inside(u) * inside(v);
    (0.5 + 0.35 * (board * sign(u) * sign(v) + 1.0 - board) + texture(x, y)) as f32
}

fn image_of(picture: Picture) -> Image<'static> {
    let middle = (SIDE / 2) as f64;
    Image::from_fn(SIDE, SIDE, |x, y| picture(x as f64 - middle, y as f64 - middle))
}

/// Checks `operator`; positions must agree within `tolerance` px, which is the operator's own (f32 arithmetic has a wider one).
///
/// Shifts by whole pixels, the eight symmetries of the square, grey values scaled and offset, numbers that are not finite, flat images, windows that
/// leave the image, starts that are no place at all, many points at once.
///
/// # Panics
/// With what the operator did wrong.
pub fn check(operator: &dyn Operator, tolerance: f64) {
    check_on(operator, grey, tolerance);
}

/// As [`check`], on another picture than the corner of one area: [`chess_corner`], [`chessboard`], [`disc`].
///
/// # Panics
/// As [`check`].
pub fn check_on(operator: &dyn Operator, picture: Picture, tolerance: f64) {
    plausible(operator, picture);
    shifts(operator, picture, tolerance);
    symmetries(operator, picture, tolerance);
    grey_scale(operator, picture, tolerance);
    not_finite(operator, picture);
    flat(operator);
    borders(operator, picture);
    many(operator, picture);
}

fn start() -> Start {
    let middle = (SIDE / 2) as f64;
    Start::at(PixelPoint::new(middle + OFFSET.0, middle + OFFSET.1))
}

fn position(operator: &dyn Operator, image: &Image, start: &Start, what: &str) -> PixelPoint {
    let found = operator.measure(image, start).unwrap_or_else(|rejection| panic!("{what}: rejected a clear corner as {rejection}"));
    assert!(found.position.is_finite(), "{what}: {found:?}");
    assert!(found.covariance.is_none_or(|covariance| covariance.is_valid()), "{what}: {found:?}");
    found.position
}

fn agree(a: PixelPoint, b: PixelPoint, tolerance: f64, what: &str) {
    let distance = a.distance(b);
    assert!(distance <= tolerance, "{what}: {distance:e} px off, tolerance {tolerance:e}");
}

fn plausible(operator: &dyn Operator, picture: Picture) {
    let found = position(operator, &image_of(picture), &start(), "a clear corner");
    let middle = (SIDE / 2) as f64;
    // Wide: Harris with a large integration scale is biased by two pixels.
    agree(found, PixelPoint::new(middle + CORNER.0, middle + CORNER.1), 3.0, "a clear corner");
}

fn shifts(operator: &dyn Operator, picture: Picture, tolerance: f64) {
    let reference = position(operator, &image_of(picture), &start(), "unshifted");
    let middle = (SIDE / 2) as f64;
    for (dx, dy) in [(7.0, 0.0), (0.0, -5.0), (-3.0, 11.0)] {
        let image = Image::from_fn(SIDE, SIDE, |x, y| picture(x as f64 - middle - dx, y as f64 - middle - dy));
        let at = Start::at(PixelPoint::new(start().position.x + dx, start().position.y + dy));
        let found = position(operator, &image, &at, "shifted");
        agree(found, PixelPoint::new(reference.x + dx, reference.y + dy), tolerance, &format!("shift by ({dx}, {dy})"));
    }
}

fn symmetries(operator: &dyn Operator, picture: Picture, tolerance: f64) {
    let image = image_of(picture);
    let reference = position(operator, &image, &start(), "upright");
    let last = (SIDE - 1) as f64;
    for (swap, flip_x, flip_y) in (0..8).map(|i| (i & 1 != 0, i & 2 != 0, i & 4 != 0)) {
        let map = |p: PixelPoint| {
            let (x, y) = if swap { (p.y, p.x) } else { (p.x, p.y) };
            PixelPoint::new(if flip_x { last - x } else { x }, if flip_y { last - y } else { y })
        };
        let turned = Image::from_fn(SIDE, SIDE, |x, y| {
            let (x, y) = (if flip_x { SIDE - 1 - x } else { x }, if flip_y { SIDE - 1 - y } else { y });
            if swap { image.at(y, x) } else { image.at(x, y) }
        });
        let found = position(operator, &turned, &Start::at(map(start().position)), "turned");
        agree(found, map(reference), tolerance, &format!("axes swapped: {swap}, x reflected: {flip_x}, y reflected: {flip_y}"));
    }
}

fn grey_scale(operator: &dyn Operator, picture: Picture, tolerance: f64) {
    let image = image_of(picture);
    let reference = position(operator, &image, &start(), "full contrast");
    // Powers of two and a small offset: the grey values themselves lose few bits.
    let weaker = Image::new(SIDE, SIDE, image.grey().iter().map(|g| g * 0.5 + 0.25).collect());
    agree(position(operator, &weaker, &start(), "half contrast"), reference, tolerance.max(1e-5), "half the contrast, brighter");
}

fn not_finite(operator: &dyn Operator, picture: Picture) {
    let (x, y) = start().position.nearest_pixel().expect("a finite start");
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut image = image_of(picture);
        image.grey_mut()[y as usize * SIDE + x as usize] = bad;
        reject_or_ignore(operator, &image, &[Rejection::NotFinite], &format!("{bad} at the start"));
        let image = Image::new(SIDE, SIDE, vec![bad; SIDE * SIDE]);
        reject_or_ignore(operator, &image, &[Rejection::NotFinite], &format!("{bad} everywhere"));
    }
    let image = image_of(picture);
    for (x, y) in [(f64::NAN, 45.0), (45.0, f64::INFINITY), (f64::NEG_INFINITY, f64::NAN)] {
        let found = operator.measure(&image, &Start::at(PixelPoint::new(x, y)));
        assert_eq!(found.unwrap_err(), Rejection::NotFinite, "start ({x}, {y})");
    }
}

fn flat(operator: &dyn Operator) {
    for grey in [0.0, 0.3, 1.0] {
        let image = Image::new(SIDE, SIDE, vec![grey; SIDE * SIDE]);
        reject_or_ignore(operator, &image, &[Rejection::NoCorner, Rejection::NoMaximum], &format!("constant grey value {grey}"));
    }
}

/// An operator that reads grey values rejects the start for one of `reasons`; another one returns it.
fn reject_or_ignore(operator: &dyn Operator, image: &Image, reasons: &[Rejection], what: &str) {
    match operator.measure(image, &start()) {
        Err(rejection) => assert!(operator.reads_grey_values() && reasons.contains(&rejection), "{what}: rejected as {rejection}"),
        Ok(found) => assert!(!operator.reads_grey_values() && found.position == start().position, "{what}: measured {found:?}"),
    }
}

fn borders(operator: &dyn Operator, picture: Picture) {
    let image = image_of(picture);
    let last = (SIDE - 1) as f64;
    let border = |x: f64, y: f64| {
        let found = operator.measure(&image, &Start::at(PixelPoint::new(x, y)));
        assert_eq!(found.unwrap_err(), Rejection::Border, "start ({x}, {y})");
    };
    for (x, y) in
        [(-2.0, 45.0), (45.0, last + 2.0), (-1e300, 0.0), (1e18, 1e18), (4e9, 45.0), (f64::MAX, f64::MIN), (1e300, 45.0), (45.0, f64::MAX)]
    {
        border(x, y);
    }
    if operator.reads_grey_values() {
        for along in 0..SIDE {
            let along = along as f64;
            for (x, y) in [(0.0, along), (last, along), (along, 0.0), (along, last)] {
                border(x, y);
            }
        }
    }
    for side in [1, 2, 3] {
        let tiny = Image::new(side, side, vec![0.5; side * side]);
        let _ = operator.measure(&tiny, &Start::at(PixelPoint::new(0.0, 0.0)));
    }
}

fn many(operator: &dyn Operator, picture: Picture) {
    let image = image_of(picture);
    let starts: Vec<Start> = (-50..140).step_by(5).map(|i| Start::at(PixelPoint::new(f64::from(i), f64::from(i) + 0.4))).collect();
    let together = operator.measure_all(&image, &starts);
    let alone: Vec<_> = starts.iter().map(|start| operator.measure(&image, start)).collect();
    assert_eq!(together, alone, "many points at once");
}
