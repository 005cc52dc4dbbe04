//! Pictures of boards: outlines in perspective, filled, blurred and noisy.

use calibench_detect::Found;
use calibench_model::boards::{Board, Layout};
use calibench_model::testfield::{Curve, PlatePoint};
use calibench_model::{Image, PixelPoint};

/// Samples to a side of a pixel.
const FINE: usize = 4;

/// How a board is seen.
#[derive(Clone, Copy, Debug)]
pub struct View {
    pub width: usize,
    pub height: usize,
    /// Its middle in the image, px.
    pub middle: [f64; 2],
    /// px per object unit in its middle.
    pub scale: f64,
    /// Turned in its plane, degrees, counterclockwise.
    pub turn: f64,
    /// Then tilted, degrees, about an axis in the image at the second angle.
    pub tilt: [f64; 2],
    pub mirrored: bool,
    /// Grey values of paper and ink.
    pub paper: f64,
    pub ink: f64,
    /// Standard deviations of the blur, px, and of the noise.
    pub blur: f64,
    pub noise: f64,
}

impl View {
    /// The whole board of this layout upright in the middle of the image.
    pub fn whole(layout: &Layout, scale: f64) -> Self {
        let [[u0, v0], [u1, v1]] = layout.printed;
        let side = |extent: f64| (1.25 * extent * scale) as usize + 40;
        let diagonal = (u1 - u0).hypot(v1 - v0);
        let (width, height) = (side(diagonal), side(diagonal));
        let middle = [width as f64 / 2.0, height as f64 / 2.0];
        Self { width, height, middle, scale, turn: 0.0, tilt: [0.0, 0.0], mirrored: false, paper: 0.85, ink: 0.1, blur: 0.7, noise: 0.01 }
    }

    /// Where a point of the board is seen, pixel centres at whole numbers.
    pub fn at(&self, layout: &Layout, [u, v]: PlatePoint) -> PixelPoint {
        let [[u0, v0], [u1, v1]] = layout.printed;
        let far = 2.5 * (u1 - u0).hypot(v1 - v0);
        let turned = rotated([u - 0.5 * (u0 + u1), v - 0.5 * (v0 + v1)], self.turn);
        let [along, across] = rotated(turned, -self.tilt[1]);
        let (sine, cosine) = self.tilt[0].to_radians().sin_cos();
        let depth = far / (far + sine * across);
        let [x, y] = rotated([along * depth, cosine * across * depth], self.tilt[1]);
        let x = if self.mirrored { -x } else { x };
        PixelPoint::new(self.middle[0] + self.scale * x, self.middle[1] - self.scale * y)
    }

    /// The picture.
    pub fn draw(&self, layout: &Layout) -> Image<'static> {
        let mut fine = Fine::new(self.width, self.height, 0.5);
        let [[u0, v0], [u1, v1]] = layout.printed;
        let rim = 0.06 * (u1 - u0).hypot(v1 - v0);
        let sheet = [[u0 - rim, v0 - rim], [u1 + rim, v0 - rim], [u1 + rim, v1 + rim], [u0 - rim, v1 + rim]];
        fine.fill(&sheet.map(|corner| self.at(layout, corner)), self.paper as f32);
        for shape in &layout.shapes {
            let vertices = shape.outline.0.iter().flat_map(|curve| {
                let steps = if matches!(curve, Curve::Arc { .. }) { 24 } else { 1 };
                (0..steps).map(move |step| curve.at(f64::from(step) / f64::from(steps)))
            });
            let outline: Vec<PixelPoint> = vertices.map(|at| self.at(layout, at)).collect();
            fine.fill(&outline, if shape.dark { self.ink } else { self.paper } as f32);
        }
        let image = blurred(&fine.picture(), self.blur);
        noisy(&image, self.noise, 1)
    }

    /// Checks that every point that was found is where it is, and its axes.
    pub fn check(&self, layout: &Layout, found: &Found, within: f64, what: &str) {
        assert!(!found.points.is_empty(), "{what}");
        for point in &found.points {
            let expected = &layout.points[point.index];
            let at = self.at(layout, expected.at);
            assert!(at.distance(point.position) < within, "{what}: {} at {:?}, not {at:?}", expected.id, point.position);
            let target = expected.target(0, expected.at);
            let step = 0.05 * expected.size;
            let [u, _] = target.axes;
            let there = self.at(layout, [expected.at[0] + step * u[0], expected.at[1] + step * u[1]]);
            let size = 0.05 * point.affine.axx.hypot(point.affine.ayx);
            let [dx, dy] = [there.x - at.x - 0.05 * point.affine.axx, there.y - at.y - 0.05 * point.affine.ayx];
            assert!(dx.hypot(dy) < 0.3 * size, "{what}: axes of {}: {:?}, ({dx}, {dy}) off", expected.id, point.affine);
        }
        let indices: Vec<usize> = found.points.iter().map(|point| point.index).collect();
        let mut sorted = indices.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(indices, sorted, "{what}: in order, each once");
    }
}

fn rotated([x, y]: [f64; 2], degrees: f64) -> [f64; 2] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    [cosine * x - sine * y, sine * x + cosine * y]
}

/// A picture with FINE x FINE samples a pixel.
pub struct Fine {
    width: usize,
    height: usize,
    grey: Vec<f32>,
}

impl Fine {
    /// `width` x `height` pixels of one grey value.
    pub fn new(width: usize, height: usize, grey: f32) -> Self {
        let (width, height) = (FINE * width, FINE * height);
        Self { width, height, grey: vec![grey; width * height] }
    }

    /// The means of the samples of each pixel.
    pub fn picture(self) -> Image<'static> {
        Image::new(self.width, self.height, self.grey).reduced(FINE)
    }

    /// Fills a polygon, by the crossings of each line.
    pub fn fill(&mut self, outline: &[PixelPoint], grey: f32) {
        let scale = FINE as f64;
        // The centre of pixel 0 lies between its samples.
        let fine = |at: f64| scale * at + 0.5 * (scale - 1.0);
        let vertices: Vec<[f64; 2]> = outline.iter().map(|at| [fine(at.x), fine(at.y)]).collect();
        let low = vertices.iter().map(|at| at[1]).fold(f64::INFINITY, f64::min).max(0.0) as usize;
        let high = vertices.iter().map(|at| at[1]).fold(0.0, f64::max).min(self.height as f64 - 1.0) as usize;
        for y in low..=high.max(low).min(self.height - 1) {
            let line = y as f64;
            let next = vertices.iter().cycle().skip(1);
            let mut crossings: Vec<f64> = vertices
                .iter()
                .zip(next)
                .filter(|(a, b)| (a[1] <= line) != (b[1] <= line))
                .map(|(a, b)| a[0] + (line - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
                .collect();
            crossings.sort_by(f64::total_cmp);
            for ends in crossings.chunks_exact(2) {
                let from = ends[0].ceil().clamp(0.0, self.width as f64) as usize;
                let to = ends[1].ceil().clamp(0.0, self.width as f64) as usize;
                self.grey[y * self.width + from..y * self.width + to.max(from)].fill(grey);
            }
        }
    }
}

/// By a normal distribution.
pub fn blurred(image: &Image, sigma: f64) -> Image<'static> {
    let reach = (3.5 * sigma).ceil() as i64;
    let weights: Vec<f32> = (-reach..=reach).map(|k| (-0.5 * (k as f64 / sigma).powi(2)).exp() as f32).collect();
    let sum: f32 = weights.iter().sum();
    let pass = |image: &Image, dx: i64, dy: i64| {
        let inside = |at: i64, size: usize| at.clamp(0, size as i64 - 1) as usize;
        Image::from_fn(image.width(), image.height(), |x, y| {
            let sample = |k: i64| image.at(inside(x as i64 + k * dx, image.width()), inside(y as i64 + k * dy, image.height()));
            (-reach..=reach).zip(&weights).map(|(k, weight)| weight * sample(k)).sum::<f32>() / sum
        })
    };
    pass(&pass(image, 1, 0), 0, 1)
}

/// Noise of nearly a normal distribution.
pub fn noisy(image: &Image, sigma: f64, seed: u64) -> Image<'static> {
    let mut state = seed;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1_u32 << 24) - 0.5
    };
    let mut normal = || (0..4).map(|_| uniform()).sum::<f64>() * 3_f64.sqrt();
    Image::from_fn(image.width(), image.height(), |x, y| image.at(x, y) + (sigma * normal()) as f32)
}

pub fn board(text: &str) -> (Board, Layout) {
    let board: Board = text.parse().unwrap();
    (board, board.layout().unwrap())
}

/// The least side of what has to be told apart: px per object unit so that it has `pixels`.
pub fn scale(board: &Board, layout: &Layout, pixels: f64) -> f64 {
    let size = match board.dictionary() {
        Some((dictionary, border)) => {
            let [a, b, ..] = layout.markers[0].corners;
            (b[0] - a[0]).hypot(b[1] - a[1]) / (dictionary.side + 2 * border) as f64
        }
        None => layout.points[0].size / 3.0,
    };
    pixels / size
}
