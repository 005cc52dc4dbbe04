//! The normal equations of a junction over one window.
//!
//! They are those of a model that takes the photosite's area for one Gaussian. What that leaves out is worked out once in a while and taken from the grey
//! values: see [`Laid::correct`].

use calibench_model::Image;
use nalgebra::SVector;

use super::arms::Model;
use super::gram::Gram;
use super::lists::Lists;
use super::rows::{self, Place};
use super::unknowns::{Levels, Unknowns};
use crate::following::Laid;
use crate::gradient::EVEN;
use crate::grey_window::GreyWindow;
use crate::marquardt::{Normal, Problem};
use crate::photosite::Fidelity;
use crate::residuals::Residuals;

/// How often the normal equations of one junction are set up at most.
const EVALUATIONS: usize = 80;
/// What single precision leaves of a residual, in units of half the contrast.
const PRECISION: f64 = 2e-7;

/// One window of an image, as the least-squares problem of `P` unknowns.
pub(super) struct Window<'a, const P: usize> {
    unknowns: Unknowns,
    photosite: f64,
    /// Grey values, corrected.
    greys: GreyWindow<'a>,
    lists: Lists,
    gram: Gram,
    /// How often the normal equations may still be set up.
    patience: usize,
}

impl<'a, const P: usize> Window<'a, P> {
    /// Of `side` px; `mean` and `half` are about the mean of the grey values and half their difference.
    pub(super) fn new(image: &'a Image, side: usize, unknowns: Unknowns, photosite: f64, [mean, half]: [f64; 2]) -> Self {
        debug_assert_eq!(unknowns.count(), P);
        let greys = GreyWindow::new(image, side, mean, half);
        Self { unknowns, photosite, greys, lists: Lists::new(side), gram: Gram::new(), patience: EVALUATIONS }
    }

    fn model(&self, x: &SVector<f64, P>, fidelity: Fidelity) -> Option<Model<f32>> {
        Model::new(&self.unknowns.shape(x.as_slice(), self.photosite), fidelity)
    }

    fn levels(&self, x: &SVector<f64, P>) -> Levels {
        self.unknowns.levels(x.as_slice(), -self.greys.mean / self.greys.half)
    }

    fn sort(&mut self, model: (&Model<f32>, f32), x: &SVector<f64, P>) {
        self.lists.sort(model, (&self.greys.grey, self.greys.side), centre(x));
    }

    /// Adds what the pixels say that see one sector alone.
    fn add_plain(&self, x: &SVector<f64, P>, normal: &mut Normal<P>) {
        for (sector, plain) in self.lists.plain.iter().enumerate().take(self.unknowns.arms) {
            let (unknown, level) = (self.unknowns.grey(sector), x[self.unknowns.grey(sector)]);
            normal.n[(unknown, unknown)] += plain.count;
            normal.b[unknown] += plain.sum - plain.count * level;
            normal.omega += plain.square - level * (2.0 * plain.sum - plain.count * level);
        }
    }

    /// The range of the window's grey values.
    pub(super) fn range(&self) -> f64 {
        let ends = self.greys.grey.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], grey| [low.min(*grey), high.max(*grey)]);
        f64::from(ends[1] - ends[0])
    }

    /// The residuals of the corrected grey values at `x`, in units of half of `contrast`. `None` where the model has no meaning.
    pub(super) fn residuals(&mut self, x: &SVector<f64, P>, contrast: f64) -> Option<Residuals> {
        let model = self.model(x, Fidelity::Rough)?;
        let (levels, side) = (self.levels(x), self.greys.side);
        let mut grey = vec![0.0; side * side];
        self.sort((&model, model.reach), x);
        rows::leave(Place { model: &model, levels: &levels, centre: centre(x) }, &self.lists, &mut grey);
        grey.iter_mut().for_each(|r| *r /= (0.5 * contrast) as f32);
        Some(Residuals { grey, side })
    }
}

impl<const P: usize> Laid<P> for Window<'_, P> {
    fn centre_on(&mut self, pixel: (i64, i64)) {
        self.greys.centre_on(pixel);
        self.lists.forget();
    }

    fn thin(&mut self, thin: bool) -> bool {
        (self.lists.thin, self.patience) = (thin, EVALUATIONS);
        self.lists.forget();
        true
    }

    fn correct(&mut self, x: &SVector<f64, P>) -> Option<()> {
        let (rough, full) = (self.model(x, Fidelity::Rough)?, self.model(x, Fidelity::Full)?);
        self.greys.read();
        self.lists.forget();
        // As far as the mixture of Gaussians reaches.
        self.sort((&rough, rough.reach.max(full.reach)), x);
        let levels = self.levels(x);
        let place = Place { model: &rough, levels: &levels, centre: centre(x) };
        rows::correct(place, &full, &mut self.lists, &mut self.greys.grey);
        Some(())
    }
}

impl<const P: usize> Problem<P> for Window<'_, P> {
    fn normal(&mut self, x: &SVector<f64, P>) -> Option<Normal<P>> {
        self.patience = self.patience.checked_sub(1)?;
        let limit = self.greys.side as f64;
        let inside = x.as_slice()[..2].iter().all(|p| p.abs() < limit) && x[self.unknowns.variance()] < limit * limit;
        if !(inside && x.iter().all(|value| value.is_finite())) {
            return None;
        }
        let model = self.model(x, Fidelity::Rough)?;
        let levels = self.levels(x);
        self.sort((&model, model.reach), x);
        rows::add(Place { model: &model, levels: &levels, centre: centre(x) }, &self.lists, &mut self.gram);
        let mut normal = self.gram.normal();
        if self.unknowns.gradient == EVEN {
            self.add_plain(x, &mut normal);
        }
        Some(normal)
    }

    fn lowest(&self, unknown: usize) -> f64 {
        if unknown == self.unknowns.variance() { 0.0 } else { f64::NEG_INFINITY }
    }

    fn redundancy(&self) -> f64 {
        let pixels = self.greys.side * self.greys.side;
        (if self.lists.thin { pixels.div_ceil(2) } else { pixels } - P) as f64
    }

    fn same(&self, omega: f64) -> f64 {
        let pixels = (self.greys.side * self.greys.side) as f64;
        omega + 4.0 * PRECISION * omega.sqrt() + pixels * PRECISION * PRECISION
    }
}

fn centre<const P: usize>(x: &SVector<f64, P>) -> [f32; 2] {
    [x[0] as f32, x[1] as f32]
}
