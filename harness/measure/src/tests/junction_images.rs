//! Exact images of junctions for tests: by Green's theorem along the arms, to 1e-9. The operator goes the other way about.

use std::f64::consts::TAU;

use calibench_model::quadrature::gauss_legendre;

use super::quadrature_images::profile;

/// Sectors that meet in a point: sector k lies between arm k and the next, turning from x to y.
#[derive(Clone, Debug)]
pub(crate) struct Junction {
    pub(crate) position: [f64; 2],
    pub(crate) directions: Vec<f64>,
    pub(crate) grey: Vec<f64>,
    pub(crate) blur: f64,
    /// What is added, a px.
    pub(crate) gradient: [f64; 2],
    /// By what share the light grows, a px.
    pub(crate) light: [f64; 2],
    /// How each sector changes, a px.
    pub(crate) each: Vec<[f64; 2]>,
    /// Side of the photosites, px.
    pub(crate) photosite: f64,
}

impl Junction {
    /// The grey values of `side` x `side` px, row by row, unrounded.
    pub(crate) fn render(&self, side: usize) -> Vec<f64> {
        let arms = self.directions.len();
        let steps: Vec<Vec<f64>> = self.directions.iter().map(|direction| self.steps(*direction, side)).collect();
        let shares: Vec<Vec<f64>> = (0..arms).map(|k| self.share(k, &steps)).collect();
        let grey = |i: usize| {
            let (x, y) = ((i % side) as f64 - self.position[0], (i / side) as f64 - self.position[1]);
            let plane = |[gx, gy]: [f64; 2]| gx * x + gy * y;
            let of = |k: usize| self.grey[k] + self.each.get(k).map_or(0.0, |slope| plane(*slope));
            let sum: f64 = (0..arms).map(|k| of(k) * shares[k][i]).sum();
            sum * (1.0 + plane(self.light)) + plane(self.gradient)
        };
        (0..side * side).map(grey).collect()
    }

    /// What is seen of sector `k`: the steps along its two arms.
    fn share(&self, k: usize, steps: &[Vec<f64>]) -> Vec<f64> {
        let next = (k + 1) % self.directions.len();
        let (first, last) = (self.directions[k], self.directions[next]);
        let width = (last - first).rem_euclid(TAU);
        // Whether the sector holds the direction to the far left, from which the steps come.
        let left = (std::f64::consts::PI - first).rem_euclid(TAU) < width;
        steps[k].iter().zip(&steps[next]).map(|(first, last)| f64::from(u8::from(left)) + first - last).collect()
    }

    /// The integral along an arm of the step that lies beyond, of a sector to its left, turning from x to y.
    fn steps(&self, direction: f64, side: usize) -> Vec<f64> {
        let far = 12.0 * self.blur + 2.0 + side as f64;
        let mut steps = vec![0.0; side * side];
        let (sin, cos) = direction.sin_cos();
        let rule = gauss_legendre(8);
        // In the image a panel is as long as the blur is wide. Further off only the way down counts, on which the arm passes all rows.
        let (near, steep) = (1.5 * far, sin.abs().max(1e-6));
        for (from, length, step) in [(0.0, near, self.blur), (near, far / steep, self.blur / steep)] {
            let panels = (length / step).ceil();
            for (panel, (node, weight)) in (0..panels as usize).flat_map(|panel| rule.iter().map(move |node| (panel, node))) {
                let t = from + length * (panel as f64 + node) / panels;
                let (x, y) = (self.position[0] + t * cos, self.position[1] + t * sin);
                if !(-far..2.0 * far).contains(&y) {
                    continue;
                }
                let jump = -sin * weight * length / panels;
                let across: Vec<f64> = (0..side).map(|column| profile(column as f64 - x, self.blur, self.photosite).0).collect();
                for (row, line) in steps.chunks_exact_mut(side).enumerate() {
                    let down = profile(row as f64 - y, self.blur, self.photosite).1;
                    if down > 1e-14 {
                        line.iter_mut().zip(&across).for_each(|(value, across)| *value += jump * down * across);
                    }
                }
            }
        }
        steps
    }
}
