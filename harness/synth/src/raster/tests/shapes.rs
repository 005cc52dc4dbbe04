//! Analytic shapes, blurred and integrated over a photosite.

use std::f64::consts::{PI, SQRT_2};

/// The standard normal distribution, by the error function of another library than the renderer's.
fn phi(s: f64) -> f64 {
    0.5 * statrs::function::erf::erfc(-s / SQRT_2)
}

fn density(s: f64) -> f64 {
    (-0.5 * s * s).exp() / (2.0 * PI).sqrt()
}

/// A blurred half plane's mean over a photosite: `d` is the centre's distance inside, `w`, `h` the photosite's width and height across the edge,
/// all in standard deviations of the blur.
pub fn edge(d: f64, w: f64, h: f64) -> f64 {
    let once = |s: f64| s * phi(s) + density(s);
    let twice = |s: f64| 0.5 * ((s * s + 1.0) * phi(s) + s * density(s));
    let (w, h) = (w.abs().max(h.abs()), w.abs().min(h.abs()));
    if h < 1e-3 {
        // A series in h: the second difference would lose its digits.
        return (once(d + w / 2.0) - once(d - w / 2.0)) / w + h * h / 24.0 * (density(d + w / 2.0) - density(d - w / 2.0)) / w;
    }
    (twice(d + (w + h) / 2.0) - twice(d + (w - h) / 2.0) - twice(d - (w - h) / 2.0) + twice(d - (w + h) / 2.0)) / (w * h)
}

/// A half plane's mean over a unit photosite, without blur; the normal is (`c`, `s`).
pub fn sharp_edge(d: f64, c: f64, s: f64) -> f64 {
    let square = |u: f64| 0.5 * u.max(0.0).powi(2);
    let (c, s) = (c.abs(), s.abs());
    (square(d + (c + s) / 2.0) - square(d + (c - s) / 2.0) - square(d - (c - s) / 2.0) + square(d - (c + s) / 2.0)) / (c * s)
}

/// The mean of `f` over a photosite of `width` px at (`x`, `y`): midpoints of `n` x `n` cells, with Richardson's extrapolation where `f` is smooth.
pub fn pixel_mean(x: f64, y: f64, width: f64, n: usize, f: impl Fn(f64, f64) -> f64) -> f64 {
    let mean = |n: usize| {
        let at = |i: usize| ((i as f64 + 0.5) / n as f64 - 0.5) * width;
        (0..n).flat_map(|j| (0..n).map(move |i| (i, j))).map(|(i, j)| f(x + at(i), y + at(j))).sum::<f64>() / (n * n) as f64
    };
    if n > 100 { mean(n) } else { (4.0 * mean(2 * n) - mean(n)) / 3.0 }
}

/// A disc under a Gaussian.
pub struct Spot {
    pub centre: (f64, f64),
    pub radius: f64,
    pub sigma: f64,
}

impl Spot {
    /// The share of the Gaussian around a point that falls into the disc: the integral over the disc's columns, each in closed form.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let (dx, dy) = (x - self.centre.0, y - self.centre.1);
        let distance = dx.hypot(dy);
        if (distance - self.radius).abs() > 9.0 * self.sigma {
            return f64::from(u8::from(distance < self.radius));
        }
        // Only the distance matters. u = R sin(angle) over the columns that the Gaussian reaches.
        let angle = |u: f64| (u / self.radius).clamp(-1.0, 1.0).asin();
        let (low, high) = (angle(distance - 9.0 * self.sigma), angle(distance + 9.0 * self.sigma));
        let n = 400;
        let step = (high - low) / f64::from(n);
        let column = |angle: f64| {
            let (u, half) = (self.radius * angle.sin(), self.radius * angle.cos());
            density((u - distance) / self.sigma) / self.sigma * (2.0 * phi(half / self.sigma) - 1.0) * half
        };
        let simpson = |i: i32| {
            if i == 0 || i == n {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        (0..=n).map(|i| simpson(i) * column(low + f64::from(i) * step)).sum::<f64>() * step / 3.0
    }
}

/// The share of the unit photosite at (`x`, `y`) that lies in a disc of `radius` around the origin, in closed form.
pub fn disc_area(x: f64, y: f64, radius: f64) -> f64 {
    let half = |u: f64| (radius * radius - u * u).max(0.0).sqrt();
    // The integral of the half chord up to u.
    let swept = |u: f64| 0.5 * (u * half(u) + radius * radius * (u / radius).clamp(-1.0, 1.0).asin());
    // The area of the disc's part left of a and above b.
    let quadrant = |a: f64, b: f64| {
        let (a, b) = (a.clamp(-radius, radius), b.clamp(-radius, radius));
        let w = half(b);
        let (low, high) = (a.min(-w), a.clamp(-w, w));
        let whole = if b > 0.0 { 2.0 * (swept(low) - swept(-radius) + swept(a.max(w)) - swept(w)) } else { 0.0 };
        whole + b * (high + w) + swept(high) - swept(-w)
    };
    let (left, right, top, bottom) = (x - 0.5, x + 0.5, y - 0.5, y + 0.5);
    quadrant(right, bottom) - quadrant(left, bottom) - quadrant(right, top) + quadrant(left, top)
}

/// The mean of `f(t)` with the density of a unit disc's points across an edge, `2/pi sqrt(1 - t^2)`, by midpoints in the angle.
pub fn half_circle(n: u32, f: impl Fn(f64) -> f64) -> f64 {
    let term = |i: u32| {
        let angle = PI * (f64::from(i) + 0.5) / f64::from(n);
        angle.sin().powi(2) * f(angle.cos())
    };
    (0..n).map(term).sum::<f64>() * 2.0 / f64::from(n)
}

/// The mean of `f(dx, dy)` over the unit disc: midpoints in the angle and in the square of the radius.
pub fn disc_mean(n: u32, f: impl Fn(f64, f64) -> f64) -> f64 {
    let rings = n / 2;
    let point = |i: u32, j: u32| {
        let (radius, angle) = (((f64::from(i) + 0.5) / f64::from(rings)).sqrt(), 2.0 * PI * (f64::from(j) + 0.5) / f64::from(n));
        f(radius * angle.cos(), radius * angle.sin())
    };
    (0..rings).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| point(i, j)).sum::<f64>() / f64::from(rings * n)
}
