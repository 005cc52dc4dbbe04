//! A square's own level and noise.

use calibench_model::Image;

use crate::geometry::Square;

/// Pixels nearer to a side are left out, px.
const MARGIN: f64 = 4.0;
/// Squares with fewer pixels inside tell nothing.
const FEWEST: usize = 25;

/// What the inside of a square looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SquareFit {
    /// Its middle, px from the middle of the frame.
    pub at: [f64; 2],
    /// Mean grey value, fraction of full scale.
    pub level: f64,
    /// Variance about a plane of grey values.
    pub variance: f64,
    /// Correlation with the next pixel to the right and below, about that plane.
    pub correlation: [f64; 2],
    /// Pixels.
    pub count: usize,
    /// Share of them at the ends of the scale.
    pub clipped: f64,
}

/// The inside of `square` in `image`, if it has one.
pub fn fit_square(image: &Image, square: &Square) -> Option<SquareFit> {
    let xs = square.map(|corner| corner.x);
    let ys = square.map(|corner| corner.y);
    let bounds = |values: [f64; 4], most: usize| {
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
        (low >= 0.0 && high <= most as f64 - 1.0).then(|| (low.ceil() as usize, high.floor() as usize))
    };
    let ((left, right), (top, bottom)) = (bounds(xs, image.width())?, bounds(ys, image.height())?);
    let (width, height) = (right - left + 1, bottom - top + 1);
    let inside = Inside::of(square);
    let mut grey = vec![f64::NAN; width * height];
    let middle = [0.5 * (left + right) as f64, 0.5 * (top + bottom) as f64];
    let mut plane = Plane::default();
    let mut clipped = 0;
    for y in top..=bottom {
        let row = &image.row(y)[left..=right];
        for (x, value) in row.iter().enumerate() {
            if inside.holds((left + x) as f64, y as f64) {
                let level = f64::from(*value);
                clipped += usize::from(level <= 0.0 || level >= 1.0);
                grey[(y - top) * width + x] = level;
                plane.add((left + x) as f64 - middle[0], y as f64 - middle[1], level);
            }
        }
    }
    if plane.count() < FEWEST {
        return None;
    }
    let [mean, slope_x, slope_y] = plane.solve()?;
    for (place, value) in grey.iter_mut().enumerate() {
        *value -= mean + slope_x * ((left + place % width) as f64 - middle[0]) + slope_y * ((top + place / width) as f64 - middle[1]);
    }
    let moments = |step: usize, last: usize| {
        let pairs = (0..grey.len() - step).filter(|place| step != 1 || place % width != last).map(|place| grey[place] * grey[place + step]);
        let (sum, count) = pairs.filter(|product| product.is_finite()).fold((0.0, 0), |(sum, count), p| (sum + p, count + 1));
        sum / f64::from(count.max(1))
    };
    let own = grey.iter().filter(|value| value.is_finite()).map(|value| value * value).sum::<f64>() / plane.count() as f64;
    let correlation = [moments(1, width - 1) / own.max(1e-15), moments(width, width) / own.max(1e-15)];
    let at = [middle[0] - 0.5 * (image.width() as f64 - 1.0), middle[1] - 0.5 * (image.height() as f64 - 1.0)];
    let count = plane.count();
    Some(SquareFit {
        at,
        level: mean,
        variance: own * count as f64 / (count - 3) as f64,
        correlation,
        count,
        clipped: clipped as f64 / count as f64,
    })
}

/// The inside of a convex quadrilateral: half planes.
struct Inside([[f64; 3]; 4]);

impl Inside {
    fn of(square: &Square) -> Self {
        let centre = [0, 1].map(|k| square.iter().map(|c| [c.x, c.y][k]).sum::<f64>() / 4.0);
        Self(std::array::from_fn(|side| {
            let (a, b) = (square[side], square[(side + 1) % 4]);
            let length = a.distance(b).max(1e-9);
            let (nx, ny) = (-(b.y - a.y) / length, (b.x - a.x) / length);
            let sign = (nx * (centre[0] - a.x) + ny * (centre[1] - a.y)).signum();
            [sign * nx, sign * ny, -sign * (nx * a.x + ny * a.y)]
        }))
    }

    fn holds(&self, x: f64, y: f64) -> bool {
        self.0.iter().all(|[nx, ny, c]| nx * x + ny * y + c >= MARGIN)
    }
}

/// Sums of a plane through grey values.
#[derive(Default)]
struct Plane {
    normal: nalgebra::Matrix3<f64>,
    right: nalgebra::Vector3<f64>,
}

impl Plane {
    fn add(&mut self, x: f64, y: f64, grey: f64) {
        let row = nalgebra::Vector3::new(1.0, x, y);
        self.normal += row * row.transpose();
        self.right += row * grey;
    }

    fn count(&self) -> usize {
        self.normal[(0, 0)] as usize
    }

    fn solve(&self) -> Option<[f64; 3]> {
        Some(self.normal.cholesky()?.solve(&self.right).into())
    }
}
