//! Exact images for tests: shapes blurred by a Gaussian and averaged over the pixel's area, by quadrature to 1e-9.
//!
//! Chess corners by Green's theorem along their edges, ellipses area by area: the operators go the other way about.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use calibench_model::Image;
use calibench_model::quadrature::gauss_legendre;
use statrs::function::erf::erfc;

/// A chess corner: the grey value is `mean + half * sign u * sign v`, with `u = n1 . d + curvature t^2 / 2`, d from the corner and t along the edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chess {
    pub(crate) position: [f64; 2],
    pub(crate) normals: [f64; 2],
    pub(crate) curvature: [f64; 2],
    pub(crate) blur: f64,
    pub(crate) mean: f64,
    pub(crate) half: f64,
    /// What is added, a px.
    pub(crate) gradient: [f64; 2],
    /// By what share the light grows, a px.
    pub(crate) light: [f64; 2],
    /// Side of the photosites, px.
    pub(crate) photosite: f64,
}

/// An ellipse: the points `position + A (cos t, sin t)`, with A symmetric, `shape` = axx, axy, ayy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ellipse {
    pub(crate) position: [f64; 2],
    pub(crate) shape: [f64; 3],
    pub(crate) blur: f64,
    pub(crate) inside: f64,
    pub(crate) outside: f64,
}

fn phi(x: f64) -> f64 {
    0.5 * erfc(-x * FRAC_1_SQRT_2)
}

fn bell(x: f64) -> f64 {
    (-0.5 * x * x).exp() / (2.0 * PI).sqrt()
}

/// The mean over a photosite of this `width` at distance z of a blurred unit step, and its derivative by z.
pub(crate) fn profile(z: f64, blur: f64, width: f64) -> (f64, f64) {
    let (high, low) = ((z + 0.5 * width) / blur, (z - 0.5 * width) / blur);
    let area = |x: f64| x * phi(x) + bell(x);
    (blur * (area(high) - area(low)) / width, (phi(high) - phi(low)) / width)
}

impl Chess {
    /// The grey values of `side` x `side` px, row by row, unrounded.
    pub(crate) fn render(&self, side: usize) -> Vec<f64> {
        let far = 12.0 * self.blur + 2.0;
        let (low, high) = (-far, side as f64 - 1.0 + far);
        let mut sum = vec![self.sides(low, low); side * side];
        let rule = gauss_legendre(8);
        for which in 0..2 {
            for direction in [1.0, -1.0] {
                let (x, y) = self.leave(which, direction, low, high);
                // On the left-hand side of the frame the sign changes where an edge comes through.
                if x < low + 0.5 * far && y > low && y < high {
                    let (u, v) = (self.sides(low, y - 1e-6), self.sides(low, y + 1e-6));
                    sum.chunks_mut(side).enumerate().for_each(|(row, line)| {
                        let passed = (v - u) * profile(row as f64 - y, self.blur, self.photosite).0;
                        line.iter_mut().for_each(|value| *value += passed);
                    });
                }
                self.along(which, direction, (low, high), &rule, side, &mut sum);
            }
        }
        let plane =
            |i: usize, [gx, gy]: [f64; 2]| gx * ((i % side) as f64 - self.position[0]) + gy * ((i / side) as f64 - self.position[1]);
        let grey = |(i, f): (usize, &f64)| (self.mean + self.half * f) * (1.0 + plane(i, self.light)) + plane(i, self.gradient);
        sum.iter().enumerate().map(grey).collect()
    }

    fn signed(&self, which: usize, x: f64, y: f64) -> f64 {
        let (ny, nx) = self.normals[which].sin_cos();
        let (dx, dy) = (x - self.position[0], y - self.position[1]);
        let t = nx * dy - ny * dx;
        nx * dx + ny * dy + 0.5 * self.curvature[which] * t * t
    }

    fn sides(&self, x: f64, y: f64) -> f64 {
        (self.signed(0, x, y) * self.signed(1, x, y)).signum()
    }

    fn point(&self, which: usize, t: f64) -> (f64, f64) {
        let (ny, nx) = self.normals[which].sin_cos();
        let sag = 0.5 * self.curvature[which] * t * t;
        (self.position[0] - t * ny - sag * nx, self.position[1] + t * nx - sag * ny)
    }

    /// How far an edge goes, and where it leaves the frame.
    fn length(&self, which: usize, direction: f64, low: f64, high: f64) -> f64 {
        let inside = |t: f64| {
            let (x, y) = self.point(which, direction * t);
            x > low && x < high && y > low && y < high
        };
        let (mut near, mut beyond) = (0.0, 1.0);
        while inside(beyond) {
            (near, beyond) = (beyond, beyond + 1.0);
        }
        for _ in 0..60 {
            let middle = 0.5 * (near + beyond);
            if inside(middle) { near = middle } else { beyond = middle }
        }
        beyond
    }

    fn leave(&self, which: usize, direction: f64, low: f64, high: f64) -> (f64, f64) {
        self.point(which, direction * self.length(which, direction, low, high))
    }

    fn along(&self, which: usize, direction: f64, (low, high): (f64, f64), rule: &[(f64, f64)], side: usize, sum: &mut [f64]) {
        let length = self.length(which, direction, low, high);
        let panels = (length / self.blur).ceil().max(1.0);
        let (ny, nx) = self.normals[which].sin_cos();
        for panel in 0..panels as usize {
            for (node, weight) in rule {
                let t = direction * length * (panel as f64 + node) / panels;
                let (x, y) = self.point(which, t);
                let other = self.signed(1 - which, x, y).signum();
                let jump = 2.0 * other * (nx - self.curvature[which] * t * ny) * weight * length / panels;
                let across: Vec<f64> = (0..side).map(|column| profile(column as f64 - x, self.blur, self.photosite).0).collect();
                for row in 0..side {
                    let down = profile(row as f64 - y, self.blur, self.photosite).1;
                    if down > 1e-14 {
                        let line = &mut sum[row * side..(row + 1) * side];
                        line.iter_mut().zip(&across).for_each(|(value, across)| *value += jump * down * across);
                    }
                }
            }
        }
    }
}

impl Ellipse {
    /// The grey values of `side` x `side` px, row by row, unrounded.
    pub(crate) fn render(&self, side: usize) -> Vec<f64> {
        let [a, b, c] = self.shape;
        let determinant = (a * c - b * b).powi(2);
        // The inverse of A^2.
        let (q12, q22) = (-(a * b + b * c) / determinant, (a * a + b * b) / determinant);
        let width = (q22 * determinant).sqrt();
        let (panels, rule, pixel) = ((PI * width / self.blur).ceil(), gauss_legendre(8), gauss_legendre(8));
        let mut covered = vec![0.0; side * side];
        for panel in 0..panels as usize {
            for (node, weight) in &rule {
                let psi = PI * ((panel as f64 + node) / panels - 0.5);
                let dx = width * psi.sin();
                let (middle, half) = (self.position[1] - q12 * dx / q22, psi.cos() / q22.sqrt());
                let mean = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
                    let over = |at: usize| pixel.iter().map(|(node, weight)| weight * f(at as f64 - 0.5 + node)).sum();
                    (0..side).map(over).collect()
                };
                let across = mean(&|x| bell((x - self.position[0] - dx) / self.blur) / self.blur);
                let down = mean(&|y| phi((middle + half - y) / self.blur) - phi((middle - half - y) / self.blur));
                let weight = weight * PI / panels * width * psi.cos();
                for (line, down) in covered.chunks_mut(side).zip(&down) {
                    line.iter_mut().zip(&across).for_each(|(value, across)| *value += weight * down * across);
                }
            }
        }
        covered.iter().map(|c| self.outside + (self.inside - self.outside) * c).collect()
    }
}

/// The grey values as an image.
pub(crate) fn image(grey: &[f64], side: usize) -> Image<'static> {
    Image::new(side, side, grey.iter().map(|g| *g as f32).collect())
}

#[test]
fn an_upright_chess_corner_is_the_product_of_two_profiles() {
    let corner = Chess {
        position: [9.3, 8.8],
        normals: [0.0, 0.5 * PI],
        curvature: [0.0; 2],
        blur: 0.4,
        mean: 0.5,
        half: 0.5,
        gradient: [0.0; 2],
        light: [0.0; 2],
        photosite: 1.0,
    };
    let grey = corner.render(19);
    let step = |z: f64| 2.0 * profile(z, 0.4, 1.0).0 - 1.0;
    for (i, grey) in grey.iter().enumerate() {
        let expected = 0.5 + 0.5 * step((i % 19) as f64 - 9.3) * step((i / 19) as f64 - 8.8);
        assert!((grey - expected).abs() < 1e-9, "{i}: {grey} {expected}");
    }
}

#[test]
fn all_of_an_ellipse_is_in_its_image() {
    let ellipse = Ellipse { position: [14.2, 15.1], shape: [4.0, 0.7, 2.5], blur: 0.5, inside: 1.0, outside: 0.0 };
    let area: f64 = ellipse.render(30).iter().sum();
    assert!((area - PI * (4.0 * 2.5 - 0.49)).abs() < 1e-8, "{area}");
}
