//! The Cramér-Rao bound of every target, for what each method has to estimate.

use std::collections::BTreeMap;

use calibench_model::{PixelPoint, TargetKind, Unknowns};
use calibench_scenario::Imaging;
use calibench_synth::bound::{Bounds, Work};
use calibench_synth::optics::OpticsError;
use calibench_synth::raster::Outlined;

/// Computes bounds for the images of one lens and sensor.
pub struct TargetBounds {
    bounds: Bounds,
    /// Those of discs, where their window is another.
    of_discs: Option<Bounds>,
    chain: Chain,
    /// The distinct sets of unknowns among the methods.
    sets: Vec<Unknowns>,
}

/// From light to grey values, as far as a bound needs it.
enum Chain {
    /// A described sensor.
    Sensor(Box<calibench_synth::sensor::Sensor>),
    /// Grey values as they are, with this variance.
    Plain(f64),
}

/// The bound of one target for each set of unknowns, px: the square root of its trace.
pub type BySet = BTreeMap<Unknowns, Option<f64>>;

impl TargetBounds {
    /// For windows of `window` x `window` px, of discs `discs` x `discs`, in pictures of `width` x `height` px; `plain` is the variance of the grey values (fractions of full
    /// scale, squared) where no sensor is described. `None` if there is nothing that bounds: no noise, or a chain of neighbours that are not
    /// independent.
    ///
    /// # Errors
    /// Optics that are out of range.
    pub fn new(
        imaging: &Imaging,
        plain: f64,
        [width, height]: [usize; 2],
        [window, discs]: [usize; 2],
        unknowns: impl Iterator<Item = Unknowns>,
    ) -> Result<Option<Self>, OpticsError> {
        let chain = match &imaging.sensor {
            Some(setup) if setup.row_jitter > 0.0 => return Ok(None),
            Some(setup) => Chain::Sensor(Box::new(setup.sensor.clone())),
            None => Chain::Plain(plain),
        };
        if chain.variance(0.5).is_none_or(|variance| variance <= 0.0) {
            return Ok(None);
        }
        let mut sets: Vec<Unknowns> = unknowns.collect();
        sets.sort_unstable();
        sets.dedup();
        let of = |window: usize| Bounds::new(&imaging.optics, width, height, window);
        let of_discs = if discs == window { None } else { Some(of(discs)?) };
        Ok(Some(Self { bounds: of(window)?, of_discs, chain, sets }))
    }

    /// The bounds of the target of this `kind` at `at`, px.
    pub fn of(&self, outlined: &Outlined<'_>, kind: TargetKind, at: PixelPoint, work: &mut Work) -> BySet {
        let bounds = self.of_discs.as_ref().filter(|_| kind == TargetKind::Disc).unwrap_or(&self.bounds);
        let covariances = match bounds.window(outlined, at) {
            Some(window) => window.bounds(&self.sets, |light| self.chain.mean(light), |grey| self.chain.variance(grey), work),
            None => vec![None; self.sets.len()],
        };
        let bounds = covariances.into_iter().map(|covariance| covariance.map(|c| (c.sxx + c.syy).sqrt()));
        self.sets.iter().copied().zip(bounds).collect()
    }
}

impl Chain {
    fn mean(&self, light: f64) -> Option<f64> {
        match self {
            Self::Sensor(sensor) => sensor.mean(light),
            Self::Plain(_) => Some(light),
        }
    }

    fn variance(&self, grey: f64) -> Option<f64> {
        match self {
            Self::Sensor(sensor) => sensor.variance(grey),
            Self::Plain(variance) => Some(*variance),
        }
    }
}
