//! A square of an image's grey values in single precision.

use calibench_model::Image;

/// The grey values of a window. Their unit is `half`, their zero `mean`: so single precision is enough.
pub(crate) struct GreyWindow<'a> {
    image: &'a Image<'a>,
    pub(crate) side: usize,
    pub(crate) mean: f64,
    pub(crate) half: f64,
    /// As they were read, row by row.
    plain: Vec<f32>,
    /// The same, from which what is worked out may be taken until they are read again.
    pub(crate) grey: Vec<f32>,
}

impl<'a> GreyWindow<'a> {
    /// Of `side` x `side` px, not yet laid anywhere.
    pub(crate) fn new(image: &'a Image<'a>, side: usize, mean: f64, half: f64) -> Self {
        Self { image, side, mean, half, plain: vec![0.0; side * side], grey: vec![0.0; side * side] }
    }

    /// Lays the window around a pixel from which `side / 2` px are in the image.
    pub(crate) fn centre_on(&mut self, (x, y): (i64, i64)) {
        let half = self.side as i64 / 2;
        let (left, top, side) = ((x - half) as usize, (y - half) as usize, self.side);
        let rows = (0..side).map(|row| &self.image.row(top + row)[left..left + side]);
        scale(rows, &mut self.plain, (self.mean, self.half));
        self.read();
    }

    /// Reads the grey values again.
    pub(crate) fn read(&mut self) {
        self.grey.copy_from_slice(&self.plain);
    }
}

/// As many rows in units of `half` about `mean`.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn scale<'i>(rows: impl ExactSizeIterator<Item = &'i [f32]>, to: &mut [f32], (mean, half): (f64, f64)) {
    let side = rows.len();
    for (to, from) in to.chunks_exact_mut(side).zip(rows) {
        for i in 0..side {
            to[i] = ((f64::from(from[i]) - mean) / half) as f32;
        }
    }
}
