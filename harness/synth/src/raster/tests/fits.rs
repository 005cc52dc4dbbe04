//! What a measurement of the best possible kind finds in a noise-free picture: the closed form is fitted by least squares, which for equal normal noise is the
//! likelihood's maximum.

use nalgebra::{DMatrix, DVector};

use super::shapes::{Spot, disc_area, pixel_mean};
use super::*;
use crate::raster::tests::shapes;

/// Blurs, px.
const BLURS: [f64; 6] = [0.0, 0.1, 0.3, 0.7, 1.3, 2.0];
/// Phases of the pixel grid.
const PHASES: [(f64, f64); 5] = [(0.0, 0.0), (0.5, 0.5), (0.13, 0.77), (0.31, 0.42), (0.91, 0.06)];
/// How far off a fit starts, in its own unknowns.
const START: f64 = 0.03;
/// What is asked for, px.
const WANTED: f64 = 1e-4;

/// Fits `shape(x, y)` of the unknowns, background and contrast to the middle of an image by Gauss-Newton; the unknowns.
fn fit(image: &calibench_model::Image, truth: &[f64], shape: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let grey = DVector::from_iterator(pixels().count(), pixels().map(|(x, y)| f64::from(image.at(x, y))));
    let mut unknowns: Vec<f64> = truth.iter().enumerate().map(|(i, value)| value + if i % 2 == 0 { START } else { -START }).collect();
    let (mut background, mut contrast) = (0.15, 0.6);
    for _ in 0..20 {
        let at = DVector::from_vec(shape(&unknowns));
        let mut columns = vec![DVector::from_element(grey.len(), 1.0), at.clone()];
        for i in 0..unknowns.len() {
            let moved = |h: f64| {
                let mut moved = unknowns.clone();
                moved[i] += h;
                DVector::from_vec(shape(&moved))
            };
            columns.push((moved(1e-4) - moved(-1e-4)) * (contrast / 2e-4));
        }
        let design = DMatrix::from_columns(&columns);
        let residual = &grey - at * contrast - DVector::from_element(grey.len(), background);
        let step = (design.transpose() * &design).cholesky().expect("the unknowns are determined").solve(&(design.transpose() * residual));
        background += step[0];
        contrast += step[1];
        unknowns.iter_mut().zip(step.iter().skip(2)).for_each(|(unknown, step)| *unknown += step);
        if step.amax() < 1e-6 {
            return unknowns;
        }
    }
    panic!("no convergence")
}

/// The pixels of the middle.
fn pixels() -> impl Iterator<Item = (usize, usize)> {
    (6..SIZE - 6).flat_map(|y| (6..SIZE - 6).map(move |x| (x, y)))
}

fn picture(blur: f64, pieces: Vec<Piece>) -> calibench_model::Image<'static> {
    let picture = Picture { width: SIZE, height: SIZE, background: 0.2, pieces };
    Renderer::new(&Optics { blur, ..Optics::default() }, SIZE, SIZE).unwrap().render(&picture, &[])
}

fn near(found: &[f64], truth: &[f64], what: &str) {
    for (found, truth) in found.iter().zip(truth) {
        assert!((found - truth).abs() < WANTED, "{what}: {:e} px", found - truth);
    }
}

#[test]
fn an_edges_place_and_direction_are_found() {
    for blur in BLURS {
        for (i, (dx, dy)) in PHASES.into_iter().enumerate() {
            let (x, y, angle) = (19.0 + dx, 20.0 + dy, 0.3 + 1.1 * i as f64);
            let image = picture(blur, half_plane(x, y, angle));
            // The unknowns are the distance from (x, y) and how much the edge turns over 14 px.
            let shape = |unknowns: &[f64]| {
                let (s, c) = (angle + unknowns[1] / 14.0).sin_cos();
                let grey = |(u, v): (usize, usize)| {
                    let d = (u as f64 - x) * c + (v as f64 - y) * s - unknowns[0];
                    if blur == 0.0 { shapes::sharp_edge(d, c, s) } else { shapes::edge(d / blur, c / blur, s / blur) }
                };
                pixels().map(grey).collect()
            };
            near(&fit(&image, &[0.0, 0.0], shape), &[0.0, 0.0], &format!("blur {blur}, phase ({dx}, {dy})"));
        }
    }
}

#[test]
fn a_corner_is_found() {
    for blur in BLURS {
        for (dx, dy) in PHASES {
            let truth = [19.0 + dx, 20.0 + dy];
            let step = |d: f64| if blur == 0.0 { (d + 0.5).clamp(0.0, 1.0) } else { shapes::edge(d / blur, 1.0 / blur, 0.0) };
            let far = 120.0;
            let image = picture(blur, polygon(&[(truth[0], truth[1]), (far, truth[1]), (far, far), (truth[0], far)]));
            let shape = |at: &[f64]| pixels().map(|(u, v)| step(u as f64 - at[0]) * step(v as f64 - at[1])).collect();
            near(&fit(&image, &truth, shape), &truth, &format!("blur {blur}, phase ({dx}, {dy})"));
        }
    }
}

#[test]
fn a_discs_centre_and_radius_are_found() {
    for blur in BLURS {
        for (dx, dy) in PHASES.into_iter().skip(3) {
            let truth = [19.0 + dx, 20.0 + dy, 6.7];
            let image = picture(blur, disc((truth[0], truth[1]), truth[2]));
            let sharp = |of: &[f64]| pixels().map(|(u, v)| disc_area(u as f64 - of[0], v as f64 - of[1], of[2])).collect();
            let blurred = |of: &[f64]| {
                let spot = Radial::new(of[2], blur);
                let cells = (2.0 / blur).ceil().clamp(4.0, 20.0) as usize;
                let grey = |(u, v): (usize, usize)| {
                    let (x, y) = (u as f64 - of[0], v as f64 - of[1]);
                    if spot.is_flat(x.hypot(y)) { spot.at(x, y) } else { pixel_mean(x, y, 1.0, cells, |x, y| spot.at(x, y)) }
                };
                pixels().map(grey).collect()
            };
            let found = if blur == 0.0 { fit(&image, &truth, sharp) } else { fit(&image, &truth, blurred) };
            near(&found, &truth, &format!("blur {blur}, phase ({dx}, {dy})"));
        }
    }
}

/// A [`Spot`] at the origin by a table over the distance.
struct Radial {
    start: f64,
    step: f64,
    values: Vec<f64>,
}

impl Radial {
    fn new(radius: f64, sigma: f64) -> Self {
        let spot = Spot { centre: (0.0, 0.0), radius, sigma };
        let (start, step) = ((radius - 7.0 * sigma).max(0.0), sigma / 40.0);
        let count = ((radius + 7.0 * sigma - start) / step).ceil() as usize;
        Self { start, step, values: (0..=count).map(|i| spot.at(start + i as f64 * step, 0.0)).collect() }
    }

    /// By the parabola through the three nearest entries.
    fn at(&self, x: f64, y: f64) -> f64 {
        let place = ((x.hypot(y) - self.start) / self.step).clamp(0.0, self.values.len() as f64 - 1.0);
        let middle = (place.round() as usize).clamp(1, self.values.len() - 2);
        let [a, b, c] = std::array::from_fn(|i| self.values[middle + i - 1]);
        let t = place - middle as f64;
        b + 0.5 * t * (c - a) + 0.5 * t * t * (a - 2.0 * b + c)
    }

    /// Whether a whole photosite at this distance, px, is within the disc or outside.
    fn is_flat(&self, distance: f64) -> bool {
        distance + 0.8 < self.start || distance - 0.8 > self.start + self.step * self.values.len() as f64
    }
}
