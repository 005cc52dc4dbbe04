//! Projections with derivatives: one that owns its memory, and one for loops.

use super::NoCounterpart;
use crate::PixelPoint;

/// Most parameters that a model has: ten of the canonical orientation and Ebner's twelve.
pub const MOST_PARAMETERS: usize = 22;

/// A projection with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// The projected point.
    pub point: PixelPoint,
    /// d(x, y) / d(ray), px per unit of the ray's components: rows x, y.
    pub by_ray: [[f64; 3]; 2],
    /// d(x, y) / d(parameter), px per unit of the parameter, in the order of [`super::CameraModel::parameters`].
    pub by_parameters: Vec<[f64; 2]>,
}

/// A projection with its derivatives by the ray alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slopes {
    /// The projected point.
    pub point: PixelPoint,
    /// d(x, y) / d(ray), px per unit of the ray's components: rows x, y.
    pub by_ray: [[f64; 3]; 2],
}

/// [`Derivatives`] of a fixed size, to be filled again and again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DerivativeBuffer {
    /// The projected point.
    pub point: PixelPoint,
    /// d(x, y) / d(ray), px per unit of the ray's components: rows x, y.
    pub by_ray: [[f64; 3]; 2],
    by_parameters: [[f64; 2]; MOST_PARAMETERS],
    parameters: usize,
}

impl Default for DerivativeBuffer {
    fn default() -> Self {
        Self { point: PixelPoint::default(), by_ray: [[0.0; 3]; 2], by_parameters: [[0.0; 2]; MOST_PARAMETERS], parameters: 0 }
    }
}

impl DerivativeBuffer {
    /// d(x, y) / d(parameter), px per unit of the parameter, in the order of [`super::CameraModel::parameters`].
    #[inline]
    pub fn by_parameters(&self) -> &[[f64; 2]] {
        &self.by_parameters[..self.parameters]
    }

    /// Forgets what it holds.
    pub fn clear(&mut self) {
        self.parameters = 0;
    }

    /// Adds the derivatives (x, y) by the next parameters, px per unit of each.
    ///
    /// # Panics
    /// Beyond [`MOST_PARAMETERS`].
    #[inline(always)]
    pub fn extend(&mut self, by: impl IntoIterator<Item = [f64; 2]>) {
        for by in by {
            self.by_parameters[self.parameters] = by;
            self.parameters += 1;
        }
    }

    /// Changes what was added from parameter `first` on.
    pub(super) fn change_from(&mut self, first: usize, change: impl Fn([f64; 2]) -> [f64; 2]) {
        for by in &mut self.by_parameters[first..self.parameters] {
            *by = change(*by);
        }
    }

    /// The same with memory of its own.
    pub(super) fn to_owned(self) -> Derivatives {
        Derivatives { point: self.point, by_ray: self.by_ray, by_parameters: self.by_parameters().to_vec() }
    }

    /// Fills it by `work`.
    pub(super) fn owned(work: impl FnOnce(&mut Self) -> Result<(), NoCounterpart>) -> Result<Derivatives, NoCounterpart> {
        let mut buffer = Self::default();
        work(&mut buffer)?;
        Ok(buffer.to_owned())
    }
}
