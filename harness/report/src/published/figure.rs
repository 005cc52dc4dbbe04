//! Our figure behind a printed cell.

use calibench_records::results::{Outcome, PointResult};
use calibench_records::statistics::running::Running;

use super::Metric;
use super::range::Range;

/// A figure in the first run and over all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ours {
    /// In the first trial, in the unit of the printed figure, as all here.
    pub one: f64,
    /// Mean over the trials.
    pub mean: f64,
    /// Half the 95 % interval of the mean.
    pub half: Option<f64>,
    /// Where single runs lie; `None` of one run.
    pub range: Option<Range>,
    /// The same figure of true errors, with half its 95 % interval, where it makes sense.
    pub truth: Option<(f64, Option<f64>)>,
}

impl Ours {
    /// Of the figures of all trials, in their order; `None` where there are none.
    pub fn of(trials: &[f64]) -> Option<Self> {
        let mut all = Running::default();
        trials.iter().for_each(|figure| all.add(*figure));
        let range = Range::of(trials).filter(|_| trials.len() > 1);
        Some(Self { one: *trials.first()?, mean: all.mean()?, half: all.half(), range, truth: None })
    }
}

/// The points of one method, by its place in the list of methods.
pub fn of_method(points: &[PointResult], method: usize) -> impl Iterator<Item = &PointResult> {
    points.iter().filter(move |point| point.method == method)
}

/// The errors (dx, dy) of one method's points, px, without the targets `except` and rejected points.
pub fn errors<'a>(points: &'a [PointResult], method: usize, except: &'a [String]) -> impl Iterator<Item = (f64, f64)> + 'a {
    of_method(points, method).filter(|p| !except.iter().any(|id| **id == *p.target)).filter_map(|p| match p.outcome {
        Outcome::Measured { error, .. } => error,
        Outcome::Rejected(_) => None,
    })
}

/// The figure `metric` of one method's points in one trial, px; `None` where no point of it was measured, or for figures of adjustments.
pub fn of_points(points: &[PointResult], method: usize, metric: Metric, target: Option<&str>, except: &[String]) -> Option<f64> {
    let outcome = || of_method(points, method).find(|point| Some(&*point.target) == target).map(|point| point.outcome);
    let position = || outcome()?.position();
    let error = || match outcome()? {
        Outcome::Measured { error, .. } => error,
        Outcome::Rejected(_) => None,
    };
    let mean = |value: fn((f64, f64)) -> f64| {
        let values: Vec<f64> = errors(points, method, except).map(value).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    match metric {
        Metric::Dx => error().map(|e| e.0),
        Metric::Dy => error().map(|e| e.1),
        Metric::Distance => error().map(|e| e.0.hypot(e.1)),
        Metric::X => position().map(|p| p.x),
        Metric::Y => position().map(|p| p.y),
        Metric::MeanDx => mean(|e| e.0),
        Metric::MeanDy => mean(|e| e.1),
        Metric::RmseX => mean(|e| e.0 * e.0).map(f64::sqrt),
        Metric::RmseY => mean(|e| e.1 * e.1).map(f64::sqrt),
        Metric::MeanDistance => mean(|e| e.0.hypot(e.1)),
        Metric::RmseXy => mean(|e| e.0 * e.0 + e.1 * e.1).map(f64::sqrt),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use calibench_model::{PixelPoint, Rejection};

    use super::*;

    fn point(target: &str, outcome: Option<(f64, f64)>) -> PointResult {
        let measured = |(dx, dy)| Outcome::Measured { position: PixelPoint::new(10.0 + dx, 20.0 + dy), error: Some((dx, dy)) };
        PointResult::new("v", target, 1, outcome.map_or(Outcome::Rejected(Rejection::Border), measured))
    }

    /// Errors (0.3, 0.4), (-0.6, 0.8), (0, -0.5): distances 0.5, 1 and 0.5.
    #[test]
    fn figures_of_points_are_those_computed_by_hand() {
        let mut points = vec![point("a", Some((0.3, 0.4))), point("b", Some((-0.6, 0.8))), point("c", Some((0.0, -0.5))), point("d", None)];
        points.push(PointResult { method: 0, ..point("a", Some((7.0, 7.0))) });
        let of = |metric, target| of_points(&points, 1, metric, target, &[]);
        let all = [
            (Metric::MeanDx, -0.1),
            (Metric::MeanDy, 0.7 / 3.0),
            (Metric::RmseX, 0.15_f64.sqrt()),
            (Metric::RmseY, 0.35_f64.sqrt()),
            (Metric::RmseXy, 0.5_f64.sqrt()),
            (Metric::MeanDistance, 2.0 / 3.0),
        ];
        for (metric, expected) in all {
            let found = of(metric, None).unwrap();
            assert!((found - expected).abs() < 1e-12, "{metric:?}: {found} is not {expected}");
        }
        let without = of_points(&points, 1, Metric::RmseXy, None, &["b".into()]).unwrap();
        assert!((without - 0.5).abs() < 1e-12, "{without}");
        let one = [(Metric::X, 9.4), (Metric::Y, 20.8), (Metric::Dx, -0.6), (Metric::Dy, 0.8), (Metric::Distance, 1.0)];
        for (metric, expected) in one {
            assert!((of(metric, Some("b")).unwrap() - expected).abs() < 1e-12, "{metric:?}");
            assert_eq!((of(metric, Some("d")), of(metric, Some("e"))), (None, None), "{metric:?}");
        }
        assert_eq!(of_points(&points, 2, Metric::MeanDx, None, &[]), None);
    }

    /// Values 1, 2 and 6: mean 3, variance 7, t(0.975, 2) = 4.302653.
    #[test]
    fn a_figure_has_its_first_run_its_mean_and_where_its_runs_lie() {
        let ours = Ours::of(&[1.0, 2.0, 6.0]).unwrap();
        assert!((ours.one - 1.0).abs() < 1e-12 && (ours.mean - 3.0).abs() < 1e-12);
        assert!((ours.half.unwrap() - 4.302_652_73 * (7.0_f64 / 3.0).sqrt()).abs() < 1e-6);
        assert_eq!(ours.range, Some(Range { median: 2.0, low: 1.0, high: 6.0 }));
        assert_eq!((Ours::of(&[2.0]).unwrap().range, Ours::of(&[])), (None, None), "one run has no range");
    }
}
