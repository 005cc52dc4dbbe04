//! What the report says of Galo's Table 1, searched for again.

use calibench_measure::{Operator, forstner::Forstner};
use calibench_model::{PixelPoint, Polygon, Scene, Start};
use calibench_synth::draw;

/// Columns and rows of the image around a corner, px; the corner lies near its middle.
const SIDE: usize = 48;

/// A printed point of Table 1: reference and estimate.
struct Printed {
    reference: (f64, f64),
    estimate: (f64, f64),
}

/// Figures that nobody drew.
const DRAWN: usize = 4000;

const FIVE: Printed = Printed { reference: (93.5, 91.5), estimate: (93.532, 91.481) };
const NINE: Printed = Printed { reference: (209.5, 151.0), estimate: (209.487, 151.066) };
const TEN: Printed = Printed { reference: (178.0, 182.5), estimate: (178.099, 182.518) };

impl Printed {
    /// The smallest largest difference from the print, px, over starts within 3 px, for a wedge drawn between two directions.
    fn best(&self, first: (i32, i32), second: (i32, i32)) -> f64 {
        let printed = self.error();
        let off = self.errors(first, second).into_iter().map(|(x, y)| (x - printed.0).abs().max((y - printed.1).abs()));
        off.fold(f64::INFINITY, f64::min)
    }

    /// The printed error, px.
    fn error(&self) -> (f64, f64) {
        (self.estimate.0 - self.reference.0, self.estimate.1 - self.reference.1)
    }

    /// The errors, px, from all starts within 3 px.
    fn errors(&self, first: (i32, i32), second: (i32, i32)) -> Vec<(f64, f64)> {
        let offset = (self.reference.0.floor() - 23.0, self.reference.1.floor() - 23.0);
        let apex = PixelPoint::new(self.reference.0 - offset.0, self.reference.1 - offset.1);
        let far = |d: (i32, i32)| PixelPoint::new(apex.x + 100.0 * f64::from(d.0), apex.y + 100.0 * f64::from(d.1));
        let wedge = Polygon { id: "wedge".into(), vertices: vec![apex, far(first), far(second)], grey: 0.2 };
        let image = draw(&Scene { width: SIDE, height: SIDE, background: 0.8, polygons: vec![wedge], targets: Vec::new() });
        let operator = Forstner::new(11);
        let starts = (-3..=3).flat_map(|dx| (-3..=3).map(move |dy| (f64::from(dx), f64::from(dy))));
        let error = |(dx, dy): (f64, f64)| {
            let start = Start::at(PixelPoint::new(apex.x.round() + dx, apex.y.round() + dy));
            let found = operator.measure(&image, &start).ok()?.position;
            Some((found.x - apex.x, found.y - apex.y))
        };
        starts.filter_map(error).collect()
    }

    /// The chance that a figure which nobody drew is met as nearly as the print: figures are errors of some wedge, moved by up to `by` px in each axis.
    fn chance(&self, by: f64) -> f64 {
        let directions = directions(3);
        let pairs = directions.iter().enumerate().flat_map(|(i, first)| directions[i + 1..].iter().map(move |second| (*first, *second)));
        let wedges = pairs.filter(|(first, second)| first.0 * second.1 != first.1 * second.0);
        let all: Vec<(f64, f64)> =
            wedges.flat_map(|(first, second)| self.errors(first, second)).filter(|(x, y)| x.hypot(*y) < 0.15).collect();
        // Evenly spread, by the plastic number.
        let spread = |step: usize, power: i32| 2.0 * (step as f64 * 1.324_717_957_244_746_f64.powi(-power)).fract() - 1.0;
        let is_met = |step: &usize| {
            let (x, y) = all[step * all.len() / DRAWN];
            let (x, y) = (x + by * spread(*step, 1), y + by * spread(*step, 2));
            all.iter().any(|other| (other.0 - x).abs().max((other.1 - y).abs()) < 7e-4)
        };
        (0..DRAWN).filter(is_met).count() as f64 / DRAWN as f64
    }

    /// The wedges with whole-number directions up to `most` that come within 0.0007 px of the print.
    fn search(&self, most: i32) -> Vec<[(i32, i32); 2]> {
        let directions = directions(most);
        let mut found = Vec::new();
        for (i, &first) in directions.iter().enumerate() {
            for &second in &directions[i + 1..] {
                let straight = first.0 * second.1 == first.1 * second.0;
                if !straight && self.best(first, second) < 7e-4 {
                    found.push([first, second]);
                }
            }
        }
        found
    }
}

/// Directions with coprime components up to `most`.
fn directions(most: i32) -> Vec<(i32, i32)> {
    let gcd = |mut a: i32, mut b: i32| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a.abs()
    };
    let all = (-most..=most).flat_map(|x| (-most..=most).map(move |y| (x, y)));
    all.filter(|&(x, y)| gcd(x, y) == 1).collect()
}

#[test]
fn the_search_is_as_wide_as_the_report_says() {
    // 32 directions; a pair is a wedge unless it is one straight line.
    let n = directions(3).len();
    assert_eq!(n * (n - 1) / 2 - n / 2, 480);
}

#[test]
fn table_1_determines_the_edges_at_5_9_and_10() {
    assert_eq!(FIVE.search(3), [[(0, -1), (1, 0)]], "5: up and right, nothing else");
    assert_eq!(NINE.search(3), [[(-1, 1), (0, -1)]], "9: down to 10 at 45 degrees, and straight up");
    assert_eq!(TEN.search(3), [[(1, -1), (1, 1)]], "10: both edges at 45 degrees");
}

/// So many directions and starts meet many a figure: the share of those that nobody drew but that lie among the others.
#[test]
fn the_chance_of_such_an_agreement_is_what_the_report_says() {
    let chances = [FIVE, NINE, TEN].map(|point| point.chance(0.01));
    let said = [0.054, 0.061, 0.058];
    for (chance, said) in chances.into_iter().zip(said) {
        assert!((chance - said).abs() < 0.005, "{chances:?}");
    }
}

#[test]
fn a_square_on_its_corner_does_not_give_9_and_10() {
    let (nine, ten) = (NINE.best((-1, 1), (-1, -1)), TEN.best((-1, -1), (1, -1)));
    assert!(nine > 5e-3 && ten > 3e-2, "{nine} {ten}");
}

#[test]
fn the_report_reproduces_what_is_comparable() {
    let project = crate::project::copy();
    for arguments in
        [&["run", "galo-2011/corners", "galo-2011/corners-drawn", "galo-2011/distinct-points", "-q"][..], &["report", "galo-2011", "-q"]]
    {
        let output = crate::project::run(project.path(), arguments);
        assert!(output.status.success(), "{}", crate::project::stderr(&output));
    }
    let read = |page: &str| std::fs::read_to_string(project.path().join("reports/galo-2011").join(page)).unwrap();
    let first = read("README.md");
    assert!(first.contains("## What nobody can know") && first.contains("(not run here)") && first.contains("](tables.md)"), "{first}");
    let page = read("tables.md");
    assert!(page.contains("Of 62 cells, 40 reproduce, 0 differ and 22 are not comparable."), "{page}");
    let row = |label: &str| page.lines().find(|line| line.starts_with(&format!("| {label} "))).unwrap_or_else(|| panic!("no row {label}"));
    assert!(row("9").contains("| reproduces "), "{}", row("9"));
    assert!(row("8").contains("| not comparable ") && row("8").contains("222.7792"), "{}", row("8"));
    for picture in ["corners.png", "corners-targets.png", "corners-drawn.png", "corners-drawn-targets.png"] {
        assert!(read("runs.md").contains(&format!("({picture})")), "{picture} is shown");
        assert!(image::open(project.path().join("reports/galo-2011").join(picture)).is_ok(), "{picture} is an image");
    }
}

#[test]
fn rendered_right_angles_on_the_pixel_grid_have_the_closed_form_bias() {
    let apex = PixelPoint::new(23.5, 23.5);
    let corners = [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    for (sx, sy) in corners {
        let vertices = [(0.0, 0.0), (sx * 90.0, 0.0), (sx * 90.0, sy * 90.0), (0.0, sy * 90.0)];
        let vertices = vertices.map(|(dx, dy)| PixelPoint::new(apex.x + dx, apex.y + dy)).to_vec();
        let polygons = vec![Polygon { id: "corner".into(), vertices, grey: 0.2 }];
        let image = calibench_synth::render(&Scene { width: SIDE, height: SIDE, background: 0.8, polygons, targets: Vec::new() });
        for window in [9, 11, 15, 21] {
            // From the nearest pixel inside, the centres of m = window / 2 rows lie at least 1.5 px inside.
            let start = Start::at(PixelPoint::new(apex.x + sx * 0.5, apex.y + sy * 0.5));
            let found = Forstner::new(window).measure(&image, &start).unwrap().position;
            let expected = 1.0 / (9.0 + 8.0 * (window / 2) as f64);
            let (ex, ey) = (sx * (found.x - apex.x) - expected, sy * (found.y - apex.y) - expected);
            assert!(ex.abs() < 1e-7 && ey.abs() < 1e-7, "{sx} {sy} {window}: {ex:e} {ey:e}");
        }
    }
}
