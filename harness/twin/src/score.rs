//! Root mean squares of operators over views, with what chance makes of them.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// The chance of a difference at which two operators are no tie, of all comparisons together.
const ALPHA: f64 = 0.05;

/// Squares of an operator by view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rms {
    /// Name of the view, sum of squares (2D), px^2, and how many points.
    pub views: Vec<(String, f64, usize)>,
}

/// A root mean square with its interval of 95 %, px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RmsEstimate {
    /// The root mean square (2D), px.
    pub px: f64,
    /// Where it is at 95 %, px; `None` of fewer than three views.
    pub interval: Option<[f64; 2]>,
}

impl Rms {
    fn of(views: impl Iterator<Item = (f64, usize)>) -> Option<f64> {
        let (sum, count) = views.fold((0.0, 0), |(sum, count), view| (sum + view.0, count + view.1));
        (count > 0).then(|| (sum / count as f64).sqrt())
    }

    /// Of all views, px; `None` of none.
    pub fn px(&self) -> Option<f64> {
        Self::of(self.views.iter().map(|view| (view.1, view.2)))
    }

    /// Of all views but one, px.
    fn without(&self, left_out: usize) -> Option<f64> {
        let others = self.views.iter().enumerate().filter(|(view, _)| *view != left_out);
        Self::of(others.map(|(_, view)| (view.1, view.2)))
    }

    /// With its interval, from leaving each view out in turn (of its logarithm).
    pub fn estimate(&self) -> Option<RmsEstimate> {
        let px = self.px()?;
        let without = (0..self.views.len()).filter_map(|view| Some(self.without(view)?.ln())).collect::<Vec<_>>();
        let interval = jackknife(&without).map(|(sigma, freedom)| {
            let factor = (quantile(freedom, 0.975) * sigma).exp();
            [px / factor, px * factor]
        });
        Some(RmsEstimate { px, interval })
    }

    /// The chance of as large a difference to another operator on the same views if both were as good; `None` where views do not tell.
    pub fn p_of_tie(&self, other: &Self) -> Option<f64> {
        if self.views.len() != other.views.len() {
            return None;
        }
        let ratio = |left_out: usize| Some((self.without(left_out)? / other.without(left_out)?).ln());
        let without = (0..self.views.len()).map(ratio).collect::<Option<Vec<_>>>()?;
        let (sigma, freedom) = jackknife(&without)?;
        let difference = (self.px()? / other.px()?).ln().abs();
        if sigma == 0.0 {
            return Some(f64::from(u8::from(difference == 0.0)));
        }
        let student = StudentsT::new(0.0, 1.0, freedom).ok()?;
        Some(2.0 * student.sf(difference / sigma))
    }
}

/// Which operators are the best, as a tie: those that chance does not tell from the one with the least root mean square (Bonferroni over all comparisons).
pub fn best(all: &[Rms]) -> Vec<usize> {
    let values: Vec<(usize, f64)> = all.iter().enumerate().filter_map(|(place, one)| Some((place, one.px()?))).collect();
    let Some(&(first, _)) = values.iter().min_by(|a, b| a.1.total_cmp(&b.1)) else { return Vec::new() };
    let bound = ALPHA / (values.len().max(2) - 1) as f64;
    let ties = |place: &usize| *place == first || all[*place].p_of_tie(&all[first]).is_some_and(|p| p >= bound);
    values.into_iter().map(|(place, _)| place).filter(ties).collect()
}

/// The standard deviation that values without each of some groups show, and its degrees of freedom; `None` of fewer than three.
fn jackknife(without: &[f64]) -> Option<(f64, f64)> {
    let groups = without.len() as f64;
    if without.len() < 3 {
        return None;
    }
    let mean = without.iter().sum::<f64>() / groups;
    let squares: f64 = without.iter().map(|value| (value - mean).powi(2)).sum();
    Some((((groups - 1.0) / groups * squares).sqrt(), groups - 1.0))
}

fn quantile(freedom: f64, p: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::INFINITY, |student| student.inverse_cdf(p))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64]) -> Rms {
        Rms { views: values.iter().enumerate().map(|(view, rms)| (format!("v{view}"), rms * rms * 50.0, 50)).collect() }
    }

    #[test]
    fn intervals_hold_the_value_and_widen_with_the_scatter_of_views() {
        let (calm, wild) = (of(&[0.10, 0.11, 0.09, 0.10]).estimate().unwrap(), of(&[0.02, 0.17, 0.05, 0.10]).estimate().unwrap());
        let width =
            |estimate: RmsEstimate| estimate.interval.map(|[from, to]| (to / from, from < estimate.px && estimate.px < to)).unwrap();
        assert!(width(calm).1 && width(wild).1 && width(wild).0 > 3.0 * width(calm).0, "{calm:?} {wild:?}");
        assert!(of(&[0.1, 0.2]).estimate().unwrap().interval.is_none() && Rms::default().estimate().is_none());
        assert!((of(&[0.3, 0.4]).px().unwrap() - 0.125_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn the_best_are_those_that_chance_does_not_tell_from_the_first() {
        let first = of(&[0.10, 0.12, 0.09, 0.11, 0.10, 0.13]);
        let near = of(&[0.11, 0.115, 0.092, 0.108, 0.105, 0.128]);
        // Always a fifth worse: what views have in common does not hide it.
        let worse = of(&[0.12, 0.144, 0.108, 0.133, 0.119, 0.157]);
        assert_eq!(best(&[worse.clone(), first.clone(), near, Rms::default()]), [1, 2]);
        assert!(first.p_of_tie(&worse).unwrap() < 1e-4);
        assert_eq!(first.p_of_tie(&first), Some(1.0));
    }

    #[test]
    fn of_more_operators_each_comparison_asks_for_more() {
        let first = of(&[0.10, 0.12, 0.09, 0.11, 0.10, 0.13]);
        let worse = |by: f64| of(&[0.10 + by, 0.125 + by, 0.086, 0.112 + by, 0.104, 0.13 + by]);
        let doubtful =
            (1..400).map(|k| worse(1e-4 * f64::from(k))).find(|other| other.p_of_tie(&first).is_some_and(|p| p < 0.045)).unwrap();
        assert!(doubtful.p_of_tie(&first).unwrap() > 0.03);
        assert_eq!(best(&[first.clone(), doubtful.clone()]), [0], "at 5 % of one comparison");
        let far = of(&[0.5, 0.6, 0.5, 0.55, 0.52, 0.61]);
        assert_eq!(best(&[first, doubtful, far]), [0, 1], "at 2.5 % of two");
    }
}
