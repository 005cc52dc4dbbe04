//! What a fit leaves: noise, or something that the model does not picture.

use nalgebra::SVector;

use super::levels::Levels;
use super::lists::{AREAS, CORNER, EDGES, Lists};
use super::model::{Fidelity, Model};
use super::window::Window;
use crate::lanes::{BLOCK, WIDE, less};
use crate::residuals::Structure;

impl<const P: usize, const GRADIENT: u8, const CURVED: bool> Window<'_, P, GRADIENT, CURVED> {
    /// How the residuals of the corrected grey values at `x` hang together. `None` where the model has no meaning.
    pub(super) fn structure(&mut self, x: &SVector<f64, P>) -> Option<Structure> {
        let shape = self.shape(x);
        let model = Model::new(&shape, Fidelity::Rough)?;
        let (levels, side, centre) = (self.levels(x), self.setting.side, shape.position.map(|p| p as f32));
        let stride = (side + 1).next_multiple_of(WIDE);
        let mut residual = vec![0.0; side * stride];
        fill::<GRADIENT, CURVED>(&model, &levels, centre, (&self.greys.grey, side), &mut self.pixels, (&mut residual, stride));
        self.sorted = Some(*x);
        let half = x[6].abs() as f32;
        residual.iter_mut().for_each(|r| *r /= half);
        Some(Structure::of_whole(&residual, (side, stride)))
    }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn fill<const GRADIENT: u8, const CURVED: bool>(
    model: &Model<f32>,
    levels: &Levels,
    [cx, cy]: [f32; 2],
    (grey, side): (&[f32], usize),
    lists: &mut Lists,
    (into, stride): (&mut [f32], usize),
) {
    lists.sort(model, grey, [cx, cy]);
    let half = (side / 2) as f32;
    for (kind, only) in [(CORNER, None), (EDGES[0], Some(0)), (EDGES[1], Some(1)), (AREAS, Some(2))] {
        for (chunk, count) in lists.list(kind).chunks() {
            let (x, y) = (less(chunk.x, cx), less(chunk.y, cy));
            let seen = model.seen(&x, &y);
            let value = match only {
                None => model.corner_value::<CURVED>(&seen),
                Some(2) => [1.0; BLOCK],
                Some(edge) => model.edge_value::<CURVED>(edge, &seen),
            };
            let (places, mut left) = (chunk.places((half, stride)), [0.0; BLOCK]);
            for i in 0..BLOCK {
                let level = levels.at::<GRADIENT>(x[i], y[i]);
                let side = if only.is_none() { 1.0 } else { chunk.side[i] };
                left[i] = chunk.grey[i] - (level.mean + level.half * side * value[i]);
            }
            for i in 0..count {
                into[places[i] as usize] = left[i];
            }
        }
    }
}
