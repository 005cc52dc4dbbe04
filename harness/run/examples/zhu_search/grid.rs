//! Squares of values, and their filters.

/// A square of values, row by row. All grids of an image have their middle in its corner: their sides are all odd, or all even.
pub struct Grid {
    pub side: usize,
    pub values: Vec<f64>,
}

impl Grid {
    /// Rows by `across`, then columns by `down`, for the middle `side` x `side` px.
    pub fn separable(&self, across: &[f64], down: &[f64], side: usize) -> Self {
        let (left, top) = ((self.side - side) / 2 - across.len() / 2, (self.side - side) / 2 - down.len() / 2);
        let rows = side + down.len() - 1;
        let mut first = vec![0.0; rows * side];
        for (row, line) in first.chunks_exact_mut(side).enumerate() {
            let from = &self.values[(top + row) * self.side + left..];
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
        Self { side, values }
    }

    /// Value by value; both have one side.
    pub fn times(&self, other: &Self) -> Self {
        Self { side: self.side, values: self.values.iter().zip(&other.values).map(|(a, b)| a * b).collect() }
    }
}

/// A Gaussian as far as four of its deviations, of sum one.
pub fn gaussian(sigma: f64) -> Vec<f64> {
    let radius = (4.0 * sigma).ceil().max(1.0) as i64;
    let raw: Vec<f64> = (-radius..=radius).map(|d| (-((d * d) as f64) / (2.0 * sigma * sigma)).exp()).collect();
    let sum: f64 = raw.iter().sum();
    raw.into_iter().map(|w| w / sum).collect()
}
