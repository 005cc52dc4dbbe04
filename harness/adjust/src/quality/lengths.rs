//! Lengths between adjusted points, and how well they are known.

use crate::AdjustError;
use crate::datum::STransformation;
use crate::network::NetworkError;
use crate::normal::Stretch;
use crate::solution::Solution;
use crate::solve::Inverse;
use crate::state::Step;

use super::covariance::{NO_FRAME, Variance};

/// A length between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length {
    /// How long it is, object units.
    pub value: f64,
    /// Its standard deviation, object units.
    pub sigma: f64,
}

impl Solution<'_> {
    /// The length between two points, by their indices, with what all unknowns together say of its standard deviation. Where nothing but the datum fixes
    /// the scale, that is the datum's.
    ///
    /// # Errors
    /// A point that is none, the same point twice; [`AdjustError::NotAvailable`] as of [`Self::covariances`].
    pub fn length(&self, points: [usize; 2], variance: Variance) -> Result<Length, AdjustError> {
        let (count, state) = (self.network().points.len(), &self.end.state);
        let none = |index: usize| NetworkError::NoSuch { of: "a length".into(), what: "point", index, count };
        if let Some(&index) = points.iter().find(|&&index| index >= count) {
            return Err(none(index).into());
        }
        let across = state.points[points[1]] - state.points[points[0]];
        let value = across.norm();
        if value == 0.0 {
            return Err(AdjustError::NotAvailable("a length between points at one place has no direction"));
        }
        let along = across / value;
        let mut right = self.engine.zero_step();
        right.points[points[0]] = (-along).into();
        right.points[points[1]] = along.into();
        if self.is_transformed() {
            self.take_over(&mut right)?;
        }
        self.engine.mask(&mut right);
        let mut answer = self.engine.answer(&self.solved, &self.end, &right);
        self.engine.mask(&mut answer);
        let cofactor: f64 = right.points.as_flattened().iter().zip(answer.points.as_flattened()).map(|(a, b)| a * b).sum();
        Ok(Length { value, sigma: (cofactor.max(0.0) * self.variance_factor(variance)?).sqrt() })
    }

    /// `S^T g` of a form of the points: what it asks of the datum in which the network was solved.
    fn take_over(&self, right: &mut Step) -> Result<(), AdjustError> {
        let (engine, state) = (&self.engine, &self.end.state);
        let s = STransformation::to(engine.network, &self.datum, state, &engine.zero_step()).ok_or(NO_FRAME)?;
        let mut amounts = vec![0.0; s.constraints.len()];
        for (point, form) in right.points.iter().enumerate().filter(|(_, form)| **form != [0.0; 3]) {
            let g = s.of_point(state, point);
            amounts.iter_mut().enumerate().for_each(|(k, amount)| *amount += (0..3).map(|i| form[i] * g[(i, k)]).sum::<f64>());
        }
        for (amount, constraint) in amounts.iter().zip(&s.constraints) {
            let (into, from) = (right.points.as_flattened_mut(), constraint.points.as_flattened());
            into.iter_mut().zip(from).for_each(|(x, b)| *x -= amount * b);
        }
        Ok(())
    }

    /// The cofactor of an observed distance, adjusted.
    pub(super) fn of_distance(&self, inverse: &Inverse, index: usize, stretch: &Stretch) -> f64 {
        let plan = &self.engine.plan;
        let mut right = self.engine.zero_step();
        let ends = self.engine.network.distances[index].points;
        if let Some([low, high]) = plan.joint(ends) {
            let [a, b] = if plan.point_block[ends[0]] == low { [0, 1] } else { [1, 0] };
            let form =
                |q: &[f64], a: usize, b: usize| (0..9).map(|k| stretch.slopes[a][k / 3] * q[k] * stretch.slopes[b][k % 3]).sum::<f64>();
            let across = inverse.block(plan, low, high);
            return form(&inverse.block(plan, low, low), a, a) + form(&inverse.block(plan, high, high), b, b) + 2.0 * form(&across, a, b);
        }
        // One end is known: the other may have been eliminated.
        ends.into_iter().zip(stretch.slopes).for_each(|(point, slope)| right.points[point] = slope);
        let answer = self.engine.answer(&self.solved, &self.end, &right);
        right.points.as_flattened().iter().zip(answer.points.as_flattened()).map(|(a, b)| a * b).sum()
    }
}
