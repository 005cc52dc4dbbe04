//! A search for the drawing and the detector behind Zhu, Wu & Wan 2007, Table I: `cargo run --release -p calibench-bench --example zhu_search`.
//!
//! It shares no code with the operator: gradients by explicit kernels, integration by explicit weights, everything in double precision.
//! It prints the best settings by two measures: the location precision m, and how far the eight |v| are from the printed ones.

use calibench_model::{PixelPoint, Scene};
use calibench_synth::optics::Optics;
use calibench_synth::raster::{Picture, Renderer};
use calibench_synth::testfield::{Figure4, Zhu};
use rayon::prelude::*;

/// |v| as it follows from the printed coordinates.
const PRINTED: [f64; 8] = [0.001, 0.0957, 0.0662, 0.1217, 0.2281, 0.2584, 0.1948, 0.0596];
const SIDE: usize = 60;
/// The strongest pixel is sought within this many px of the corner in both axes.
const SEEK: usize = 5;

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
    /// Does the corner lie at a pixel's centre rather than between four?
    at_centre: bool,
    stroke: f64,
    /// Width of the pen that draws the outline, px; 0.02 decides that pixels on it are drawn.
    pen: f64,
    /// Is one edge along +x rather than the bisector?
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

impl Found {
    fn m(&self) -> f64 {
        (self.v.iter().map(|v| v * v).sum::<f64>() / 8.0).sqrt()
    }

    fn off(&self) -> f64 {
        (self.v.iter().zip(PRINTED).map(|(v, p)| (v - p).powi(2)).sum::<f64>() / 8.0).sqrt()
    }
}

/// One value a pixel, row by row.
type Grid = Vec<f64>;

fn picture(p: Picturing, figure: Figure4) -> (Grid, f64) {
    let middle = SIDE as f64 / 2.0 - if p.at_centre { 0.0 } else { 0.5 };
    let at = PixelPoint::new(middle, middle);
    let zhu = Zhu { side: SIDE, at, arm: 24.0, stroke: p.stroke, pen: p.pen, ..Zhu::default() };
    let mut scene = zhu.scene(figure).expect("a figure");
    if p.edge_along_x && !matches!(figure, Figure4::EndPoint | Figure4::Solid90) {
        turn(&mut scene, at, 0.5 * figure.degrees().to_radians());
    }
    let image = match p.drawing {
        Drawing::Hard => calibench_synth::draw(&scene),
        Drawing::Area => render(&scene, 0.0),
        Drawing::Blurred(blur) => render(&scene, blur),
    };
    (image.grey().iter().map(|grey| f64::from(*grey)).collect(), middle)
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

/// Rows by `across`, then columns by `down`; zero where a kernel leaves the grid.
fn separable(grid: &Grid, across: &[f64], down: &[f64]) -> Grid {
    let pass = |grid: &Grid, kernel: &[f64], stride: usize| -> Grid {
        let half = kernel.len() / 2;
        let value = |index: usize| {
            let place = if stride == 1 { index % SIDE } else { index / SIDE };
            if place < half || place + half >= SIDE {
                return 0.0;
            }
            kernel.iter().enumerate().map(|(i, w)| w * grid[index + i * stride - half * stride]).sum()
        };
        (0..SIDE * SIDE).map(value).collect()
    };
    pass(&pass(grid, across, 1), down, SIDE)
}

/// The moments of the gradient, integrated.
fn moments(image: &Grid, derivative: Derivative, integration: f64) -> [Grid; 3] {
    let (along, across) = kernels(derivative);
    let (gx, gy) = (separable(image, &along, &across), separable(image, &across, &along));
    let window = gaussian(integration);
    let product = |a: &Grid, b: &Grid| separable(&a.iter().zip(b).map(|(a, b)| a * b).collect(), &window, &window);
    [product(&gx, &gx), product(&gx, &gy), product(&gy, &gy)]
}

/// The strengths around the strongest pixel, and where that is.
fn peak([xx, xy, yy]: &[Grid; 3], alpha: f64, middle: f64) -> ([[f64; 3]; 3], f64, f64) {
    let strength = |x: usize, y: usize| {
        let i = y * SIDE + x;
        xx[i] * yy[i] - xy[i] * xy[i] - alpha * (xx[i] + yy[i]).powi(2)
    };
    let seek = middle as usize - SEEK..=middle.ceil() as usize + SEEK;
    let pixels = seek.clone().flat_map(|y| seek.clone().map(move |x| (x, y)));
    let (x, y) = pixels.max_by(|a, b| strength(a.0, a.1).total_cmp(&strength(b.0, b.1))).expect("pixels");
    ([y - 1, y, y + 1].map(|y| [x - 1, x, x + 1].map(|x| strength(x, y))), x as f64 - middle, y as f64 - middle)
}

/// `None` where the operator rejects the point: no maximum, or one more than a pixel from the strongest.
fn v(f: &[[f64; 3]; 3], x: f64, y: f64, k: f64) -> Option<f64> {
    let (dx, dy) = calibench_measure::paraboloid::Paraboloid::fit(f, k).maximum().filter(|(dx, dy)| dx.abs() <= 1.0 && dy.abs() <= 1.0)?;
    Some((x + dx).hypot(y + dy))
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

fn search(picturing: Picturing) -> Vec<Found> {
    let pictures: Vec<(Grid, f64)> = Figure4::ALL.iter().map(|figure| picture(picturing, *figure)).collect();
    let mut found = Vec::new();
    let derivatives = [0.5, 0.7, 1.0, 1.4].map(Derivative::Gaussian);
    for derivative in [Derivative::Central, Derivative::Prewitt, Derivative::Sobel].into_iter().chain(derivatives) {
        for integration in [0.3, 0.5, 0.7, 1.0, 1.5, 2.0] {
            let moments: Vec<[Grid; 3]> = pictures.iter().map(|(image, _)| moments(image, derivative, integration)).collect();
            for alpha in [0.0, 0.04, 0.06, 0.15] {
                let peaks: Vec<_> = moments.iter().zip(&pictures).map(|(m, (_, middle))| peak(m, alpha, *middle)).collect();
                for k in [0.2, 1.0, 10.0] {
                    let v: Option<Vec<f64>> = peaks.iter().map(|(f, x, y)| v(f, *x, *y, k)).collect();
                    let Some(v) = v else { continue };
                    let v = std::array::from_fn(|i| v[i]);
                    found.push(Found { picturing, detector: Detector { derivative, integration, alpha }, k, v });
                }
            }
        }
    }
    found
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
    let all: Vec<Found> = picturings().into_par_iter().flat_map_iter(search).collect();
    println!("{} settings in which all eight points are found; printed: m = 0.153", all.len());
    let mut by: Vec<&Found> = all.iter().collect();
    by.sort_by(|a, b| a.m().total_cmp(&b.m()));
    print(&by, "Nearest to the truth");
    by.sort_by(|a, b| a.off().total_cmp(&b.off()));
    print(&by, "Nearest to the print");
    by.retain(|f| f.picturing.drawing != Drawing::Hard);
    print(&by, "Nearest to the print, with partial coverage");
    by.retain(|f| f.detector.derivative == Derivative::Sobel && f.detector.integration == 1.0 && f.detector.alpha == 0.04);
    print(&by, "The same with Sobel, integration 1, alpha 0.04");
}
