//! A square of an image's grey values in single precision.

use calibench_model::Image;

/// The grey values of a window. Their unit is `half`, their zero `mean`: so single precision is enough.
pub(crate) struct GreyWindow<'a> {
    image: &'a Image<'a>,
    pub(crate) side: usize,
    pub(crate) mean: f64,
    pub(crate) half: f64,
    /// First pixel.
    left: usize,
    top: usize,
    /// Row by row; what is worked out may be taken from them until they are read again.
    pub(crate) grey: Vec<f32>,
}

impl<'a> GreyWindow<'a> {
    /// Of `side` x `side` px, not yet laid anywhere.
    pub(crate) fn new(image: &'a Image<'a>, side: usize, mean: f64, half: f64) -> Self {
        Self { image, side, mean, half, left: 0, top: 0, grey: vec![0.0; side * side] }
    }

    /// Lays the window around a pixel from which `side / 2` px are in the image.
    pub(crate) fn centre_on(&mut self, (x, y): (i64, i64)) {
        let half = self.side as i64 / 2;
        (self.left, self.top) = ((x - half) as usize, (y - half) as usize);
        self.read();
    }

    /// Reads the grey values again.
    pub(crate) fn read(&mut self) {
        for (row, grey) in self.grey.chunks_exact_mut(self.side).enumerate() {
            let from = &self.image.row(self.top + row)[self.left..self.left + self.side];
            grey.iter_mut().zip(from).for_each(|(grey, from)| *grey = ((f64::from(*from) - self.mean) / self.half) as f32);
        }
    }
}
