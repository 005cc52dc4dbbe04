//! A search for the drawing and the detector behind Zhu, Wu & Wan 2007, Table I: `cargo run --release --example zhu_search`.
//!
//! It shares no code with the operator but the fit of the paraboloid: gradients by explicit kernels, integration by explicit weights, everything in double
//! precision. As in the scenario, a point starts at the detection nearest to it and the operator takes the strongest pixel around that.
//!
//! The criterion is the RMS difference of the eight |v| from the printed ones; m, the RMS of the |v| themselves, stands beside it. A setting in which the
//! operator rejects one of the eight points, or takes a stronger detection than the nearest, measures other points than the table: it is discarded, and counted.

use calibench_measure::paraboloid::Weights;
use calibench_model::{PixelPoint, Scene};
use calibench_synth::optics::Optics;
use calibench_synth::raster::{Picture, Renderer};
use calibench_synth::testfield::{Figure4, Zhu};
use rayon::prelude::*;

/// |v| as it follows from the printed coordinates.
const PRINTED: [f64; 8] = [0.001, 0.0957, 0.0662, 0.1217, 0.2281, 0.2584, 0.1948, 0.0596];
/// Detections are sought within this many px of the corner in both axes.
const SEEK: usize = 5;
/// A detection is the strongest pixel within this many px of itself; half the operator's window, too.
const RADIUS: usize = 3;
/// The widest integration Gaussian looks this far, px.
const REACH: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Drawing {
    /// The grey value at the pixel's centre.
    Hard,
    /// The exact mean over the pixel.
    Area,
    /// The same after a Gaussian blur, px.
    Blurred(f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Derivative {
    Central,
    Prewitt,
    Sobel,
    Gaussian(f64),
}

#[derive(Clone, Copy, Debug)]
struct Picturing {
    drawing: Drawing,
    /// Whether the corner lies at a pixel's centre rather than between four.
    at_centre: bool,
    stroke: f64,
    /// Width of the pen that draws the outline, px; 0.02 decides that pixels on it are drawn.
    pen: f64,
    /// Whether one edge is along +x rather than the bisector.
    edge_along_x: bool,
}

#[derive(Clone, Copy, Debug)]
struct Detector {
    derivative: Derivative,
    integration: f64,
    alpha: f64,
}

struct Found {
    picturing: Picturing,
    detector: Detector,
    k: f64,
    v: [f64; 8],
}

/// Why a setting is discarded.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Discarded {
    /// The operator rejects a point: no positive strength, or no maximum of the paraboloid within a pixel.
    Rejected,
    /// The strongest detection near a point is not the nearest.
    AnotherPoint,
}

impl Found {
    fn m(&self) -> f64 {
        (self.v.iter().map(|v| v * v).sum::<f64>() / 8.0).sqrt()
    }

    fn off(&self) -> f64 {
        (self.v.iter().zip(PRINTED).map(|(v, p)| (v - p).powi(2)).sum::<f64>() / 8.0).sqrt()
    }
}

/// A square of values, row by row. All grids of an image have their middle in its corner: their sides are all odd, or all even.
struct Grid {
    side: usize,
    values: Vec<f64>,
}

fn picture(p: Picturing, figure: Figure4) -> Grid {
    let side = 60 - usize::from(p.at_centre);
    let middle = (side - 1) as f64 / 2.0;
    let at = PixelPoint::new(middle, middle);
    let zhu = Zhu { side, at, arm: 24.0, stroke: p.stroke, pen: p.pen, ..Zhu::default() };
    let mut scene = zhu.scene(figure).expect("a figure");
    if p.edge_along_x && !matches!(figure, Figure4::EndPoint | Figure4::Solid90) {
        turn(&mut scene, at, 0.5 * figure.degrees().to_radians());
    }
    let image = match p.drawing {
        Drawing::Hard => calibench_synth::draw(&scene),
        Drawing::Area => render(&scene, 0.0),
        Drawing::Blurred(blur) => render(&scene, blur),
    };
    Grid { side, values: image.grey().iter().map(|grey| f64::from(*grey)).collect() }
}

fn turn(scene: &mut Scene, at: PixelPoint, angle: f64) {
    let (sine, cosine) = angle.sin_cos();
    for vertex in scene.polygons.iter_mut().flat_map(|polygon| &mut polygon.vertices) {
        let (x, y) = (vertex.x - at.x, vertex.y - at.y);
        *vertex = PixelPoint::new(at.x + cosine * x - sine * y, at.y + sine * x + cosine * y);
    }
}

fn render(scene: &Scene, blur: f64) -> calibench_model::Image {
    let optics = Optics { blur, ..Optics::default() };
    Renderer::new(&optics, scene.width, scene.height).expect("optics").render(&Picture::from(scene), &[])
}

fn gaussian(sigma: f64) -> Vec<f64> {
    let radius = (4.0 * sigma).ceil().max(1.0) as i64;
    let raw: Vec<f64> = (-radius..=radius).map(|d| (-((d * d) as f64) / (2.0 * sigma * sigma)).exp()).collect();
    let sum: f64 = raw.iter().sum();
    raw.into_iter().map(|w| w / sum).collect()
}

/// The derivative's kernel along its own axis and across it.
fn kernels(derivative: Derivative) -> (Vec<f64>, Vec<f64>) {
    let step = vec![-0.5, 0.0, 0.5];
    match derivative {
        Derivative::Central => (step, vec![1.0]),
        Derivative::Prewitt => (step, vec![1.0 / 3.0; 3]),
        Derivative::Sobel => (step, vec![0.25, 0.5, 0.25]),
        Derivative::Gaussian(sigma) => {
            let smooth = gaussian(sigma);
            let radius = (smooth.len() / 2) as f64;
            let along = smooth.iter().enumerate().map(|(i, w)| w * (i as f64 - radius) / (sigma * sigma)).collect();
            (along, smooth)
        }
    }
}

/// Rows by `across`, then columns by `down`, for the middle `side` x `side` px of `grid`.
fn separable(grid: &Grid, across: &[f64], down: &[f64], side: usize) -> Grid {
    let (left, top) = ((grid.side - side) / 2 - across.len() / 2, (grid.side - side) / 2 - down.len() / 2);
    let rows = side + down.len() - 1;
    let mut first = vec![0.0; rows * side];
    for (row, line) in first.chunks_exact_mut(side).enumerate() {
        let from = &grid.values[(top + row) * grid.side + left..];
        for (shift, weight) in across.iter().enumerate() {
            line.iter_mut().zip(&from[shift..]).for_each(|(sum, value)| *sum += weight * value);
        }
    }
    let mut values = vec![0.0; side * side];
    for (row, line) in values.chunks_exact_mut(side).enumerate() {
        for (shift, weight) in down.iter().enumerate() {
            line.iter_mut().zip(&first[(row + shift) * side..]).for_each(|(sum, value)| *sum += weight * value);
        }
    }
    Grid { side, values }
}

/// The products of the gradients, as far around the corner as the widest integration needs.
fn products(image: &Grid, derivative: Derivative) -> [Grid; 3] {
    let (along, across) = kernels(derivative);
    let side = strengths_side(image) + 2 * REACH;
    let (gx, gy) = (separable(image, &along, &across, side), separable(image, &across, &along, side));
    let product = |a: &Grid, b: &Grid| Grid { side, values: a.values.iter().zip(&b.values).map(|(a, b)| a * b).collect() };
    [product(&gx, &gx), product(&gx, &gy), product(&gy, &gy)]
}

/// Strengths are computed as far as a detection at the border of what is sought is compared.
fn strengths_side(image: &Grid) -> usize {
    2 * (SEEK + RADIUS) + if image.side % 2 == 1 { 1 } else { 2 }
}

fn strengths([xx, xy, yy]: &[Grid; 3], alpha: f64) -> Grid {
    let at = |i: usize| xx.values[i] * yy.values[i] - xy.values[i].powi(2) - alpha * (xx.values[i] + yy.values[i]).powi(2);
    Grid { side: xx.side, values: (0..xx.values.len()).map(at).collect() }
}

/// The 3 x 3 strengths around the pixel that is detected, and its place from the corner.
type Peak = ([[f64; 3]; 3], f64, f64);

fn peak(strengths: &Grid) -> Result<Peak, Discarded> {
    let (side, middle) = (strengths.side, (strengths.side - 1) as f64 / 2.0);
    let at = |x: usize, y: usize| strengths.values[y * side + x];
    let far = |(x, y): (usize, usize)| (x as f64 - middle).hypot(y as f64 - middle);
    let is_detection = |(x, y): (usize, usize)| {
        let here = at(x, y);
        let around = (y - RADIUS..=y + RADIUS).flat_map(|v| (x - RADIUS..=x + RADIUS).map(move |u| (u, v)));
        here > 0.0 && around.into_iter().all(|(u, v)| if (v, u) < (y, x) { at(u, v) < here } else { at(u, v) <= here })
    };
    let pixels = (RADIUS..side - RADIUS).flat_map(|y| (RADIUS..side - RADIUS).map(move |x| (x, y)));
    let detections: Vec<(usize, usize)> = pixels.filter(|pixel| is_detection(*pixel)).collect();
    let nearest = detections.iter().min_by(|a, b| far(**a).total_cmp(&far(**b))).ok_or(Discarded::Rejected)?;
    let strongest = detections.iter().map(|(x, y)| at(*x, *y)).fold(0.0, f64::max);
    let (x, y) = *nearest;
    // Equal within rounding is a mirror image, not another point.
    if at(x, y) < strongest * (1.0 - 1e-9) {
        return Err(Discarded::AnotherPoint);
    }
    Ok(([y - 1, y, y + 1].map(|y| [x - 1, x, x + 1].map(|x| at(x, y))), x as f64 - middle, y as f64 - middle))
}

fn distance((f, x, y): &Peak, weights: Weights) -> Result<f64, Discarded> {
    let maximum = weights.fit(f).maximum().filter(|(dx, dy)| dx.abs() <= 1.0 && dy.abs() <= 1.0);
    maximum.map(|(dx, dy)| (x + dx).hypot(y + dy)).ok_or(Discarded::Rejected)
}

fn picturings() -> Vec<Picturing> {
    let drawings = [Drawing::Hard, Drawing::Area, Drawing::Blurred(0.5), Drawing::Blurred(0.7), Drawing::Blurred(1.0)];
    let mut all = Vec::new();
    for drawing in drawings {
        for at_centre in [false, true] {
            for edge_along_x in [false, true] {
                for pen in [0.0, 0.02, 0.5, 0.9, 1.1, 1.42] {
                    all.extend([1.0, 2.0, 3.0].map(|stroke| Picturing { drawing, at_centre, stroke, pen, edge_along_x }));
                }
            }
        }
    }
    all
}

/// All settings of the detector for one way of picturing: those that measure all eight points, and the others.
fn search(picturing: Picturing) -> (Vec<Found>, Vec<Discarded>) {
    let pictures = Figure4::ALL.map(|figure| picture(picturing, figure));
    let (mut found, mut discarded) = (Vec::new(), Vec::new());
    let derivatives = [0.5, 0.7, 1.0, 1.4].map(Derivative::Gaussian);
    for derivative in [Derivative::Central, Derivative::Prewitt, Derivative::Sobel].into_iter().chain(derivatives) {
        let products = pictures.each_ref().map(|image| products(image, derivative));
        for integration in [0.3, 0.5, 0.7, 1.0, 1.5, 2.0] {
            let window = gaussian(integration);
            let side = strengths_side(&pictures[0]);
            let moments = products.each_ref().map(|grids| grids.each_ref().map(|grid| separable(grid, &window, &window, side)));
            for alpha in [0.0, 0.04, 0.06, 0.15] {
                let peaks: Result<Vec<Peak>, Discarded> = moments.iter().map(|moments| peak(&strengths(moments, alpha))).collect();
                for k in [0.2, 1.0, 10.0] {
                    let weights = Weights::new(k);
                    let v: Result<Vec<f64>, Discarded> =
                        peaks.as_ref().map_err(|why| *why).and_then(|peaks| peaks.iter().map(|peak| distance(peak, weights)).collect());
                    match v {
                        Ok(v) => {
                            let detector = Detector { derivative, integration, alpha };
                            found.push(Found { picturing, detector, k, v: std::array::from_fn(|i| v[i]) });
                        }
                        Err(why) => discarded.push(why),
                    }
                }
            }
        }
    }
    (found, discarded)
}

fn print(found: &[&Found], title: &str) {
    println!(
        "\n{title}\n\n| m | rms from printed | drawing | corner | stroke | pen | edge | derivative | integration | alpha | k | a b c d e f g h |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for f in found.iter().take(12) {
        let (p, d) = (f.picturing, f.detector);
        let place = if p.at_centre { "pixel centre" } else { "pixel corner" };
        let edge = if p.edge_along_x { "edge along x" } else { "bisector along x" };
        let v: Vec<String> = f.v.iter().map(|v| format!("{v:.3}")).collect();
        let (m, off) = (f.m(), f.off());
        println!(
            "| {m:.3} | {off:.3} | {:?} | {place} | {} | {} | {edge} | {:?} | {} | {} | {} | {} |",
            p.drawing,
            p.stroke,
            p.pen,
            d.derivative,
            d.integration,
            d.alpha,
            f.k,
            v.join(" ")
        );
    }
}

fn main() {
    let all: Vec<(Vec<Found>, Vec<Discarded>)> = picturings().into_par_iter().map(search).collect();
    let found: Vec<&Found> = all.iter().flat_map(|(found, _)| found).collect();
    let count = |why: Discarded| all.iter().flat_map(|(_, discarded)| discarded).filter(|other| **other == why).count();
    let (rejected, another) = (count(Discarded::Rejected), count(Discarded::AnotherPoint));
    println!("{} settings: in {rejected} a point is rejected, in {another} another point is taken,", found.len() + rejected + another);
    println!("in {} all eight points are measured. Printed: m = 0.153", found.len());
    let mut by = found;
    by.sort_by(|a, b| a.off().total_cmp(&b.off()));
    print(&by, "Nearest to the print");
    let mut nearest = by.clone();
    nearest.sort_by(|a, b| a.m().total_cmp(&b.m()));
    print(&nearest, "Nearest to the truth");
    let only = |keep: fn(&Found) -> bool, title: &str| print(&by.iter().copied().filter(|f| keep(f)).collect::<Vec<_>>(), title);
    only(|f| f.detector.derivative == Derivative::Sobel, "Nearest to the print, Sobel");
    only(|f| f.picturing.drawing != Drawing::Hard, "Nearest to the print, with partial coverage");
    only(
        |f| f.picturing.drawing != Drawing::Hard && f.detector.derivative == Derivative::Sobel && f.detector.integration == 1.0,
        "The same with Sobel and integration 1",
    );
}
