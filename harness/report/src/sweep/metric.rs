//! The figures of a sweep, each with its 95 % interval.

use calibench_records::score::{Pooled, Score, root};

/// What is plotted; [`Metric::meaning`] says what each one is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "`meaning` says it, for readers of the documentation and of the command line alike")]
pub enum Metric {
    Rmse,
    Bias,
    MeanX,
    Scatter,
    Ratio,
    Predicted,
    Lost,
    Rejected,
    Failed,
}

/// A figure with its 95 % interval, where there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The figure.
    pub value: f64,
    /// The ends of its interval.
    pub interval: Option<(f64, f64)>,
}

const LEVEL: f64 = 0.95;

impl Metric {
    /// All of them.
    pub const ALL: [Self; 9] =
        [Self::Rmse, Self::Bias, Self::MeanX, Self::Scatter, Self::Ratio, Self::Predicted, Self::Lost, Self::Rejected, Self::Failed];

    /// What it is, with its unit, in a line.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Rmse => "`sqrt(mean(dx^2 + dy^2))` of the points that were measured and not lost, px",
            Self::Bias => "Length of their mean error, px",
            Self::MeanX => "Mean error in x of all points that were measured, lost ones among them, px",
            Self::Scatter => "Their 2D deviation about the mean error, px",
            Self::Ratio => "Root mean squared error in units of the Cramér-Rao bound of each point",
            Self::Predicted => "Root mean squared error in units of the method's own standard deviation of each point",
            Self::Lost => "Share of points measured more than 1 px from the truth, %",
            Self::Rejected => "Share of points that the operator rejected, %",
            Self::Failed => "Share of points lost or rejected, %",
        }
    }

    /// Its name and unit, for an axis.
    pub fn title(self) -> &'static str {
        match self {
            Self::Rmse => "RMSE, px",
            Self::Bias => "bias (length), px",
            Self::MeanX => "mean error in x, lost points too, px",
            Self::Scatter => "scatter, px",
            Self::Ratio => "RMSE / bound",
            Self::Predicted => "RMSE / predicted",
            Self::Lost => "lost, %",
            Self::Rejected => "rejected, %",
            Self::Failed => "lost or rejected, %",
        }
    }

    /// Its name in files and its unit.
    pub fn name(self) -> (&'static str, &'static str) {
        match self {
            Self::Rmse => ("rmse", "px"),
            Self::Bias => ("bias", "px"),
            Self::MeanX => ("mean_x", "px"),
            Self::Scatter => ("scatter", "px"),
            Self::Ratio => ("ratio", ""),
            Self::Predicted => ("predicted", ""),
            Self::Lost => ("lost", "%"),
            Self::Rejected => ("rejected", "%"),
            Self::Failed => ("failed", "%"),
        }
    }

    /// Where it should be: a line across the plot.
    pub fn reference(self) -> Option<f64> {
        matches!(self, Self::Ratio | Self::Predicted).then_some(1.0)
    }

    /// The figure of a method in a cell; `None` where no point says anything of it.
    pub fn of(self, score: &Score) -> Option<Estimate> {
        match self {
            Self::Rmse => Some(Estimate { value: score.kept.rmse()?, interval: score.kept.rmse_interval() }),
            Self::Bias => bias(score),
            Self::MeanX => Some(Estimate { value: score.whole.dx.mean()?, interval: score.whole.dx.interval(LEVEL) }),
            Self::Scatter => scatter(score),
            Self::Ratio => ratio(&score.to_bound),
            Self::Predicted => ratio(&score.to_predicted),
            Self::Lost => share(score.lost, score.points()),
            Self::Rejected => share(score.rejected.values().sum(), score.points()),
            Self::Failed => share(score.points() - score.measured, score.points()),
        }
    }
}

/// Half the interval of a mean.
fn half(pooled: &Pooled) -> Option<f64> {
    pooled.interval(LEVEL).map(|(low, high)| (high - low) / 2.0)
}

/// The length of the mean error. Its interval is not too short whatever the correlation of x and y: the half-widths of both, each by its share of
/// the direction, are added.
fn bias(score: &Score) -> Option<Estimate> {
    let errors = &score.kept;
    let (x, y) = (errors.dx.mean()?, errors.dy.mean()?);
    let value = x.hypot(y);
    let interval = half(&errors.dx).zip(half(&errors.dy)).map(|(dx, dy)| {
        let width = if value > 0.0 { (x.abs() * dx + y.abs() * dy) / value } else { dx.hypot(dy) };
        ((value - width).max(0.0), value + width)
    });
    Some(Estimate { value, interval })
}

/// The scatter `sqrt(q - x^2 - y^2)`, `q` the mean squared error. By the delta method, with the half-widths of the three means added: not too short
/// whatever their correlation.
fn scatter(score: &Score) -> Option<Estimate> {
    let errors = &score.kept;
    let value = errors.scatter()?;
    let (x, y) = (errors.dx.mean()?, errors.dy.mean()?);
    let widths = [half(&errors.square), half(&errors.dx), half(&errors.dy)];
    let interval = if let [Some(square), Some(dx), Some(dy)] = widths {
        let width = square + 2.0 * x.abs() * dx + 2.0 * y.abs() * dy;
        Some(((value * value - width).max(0.0).sqrt(), (value * value + width).sqrt()))
    } else {
        None
    };
    Some(Estimate { value, interval })
}

fn ratio(squares: &Pooled) -> Option<Estimate> {
    root(squares, LEVEL).map(|(value, interval)| Estimate { value, interval })
}

/// A share in %, with the interval of Wilson (1927): it takes what is counted as independent of each other. `None` of nothing.
pub fn share(count: u64, of: u64) -> Option<Estimate> {
    if of == 0 {
        return None;
    }
    let (n, part) = (of as f64, count as f64 / of as f64);
    let z2 = Z * Z;
    let middle = (part + z2 / (2.0 * n)) / (1.0 + z2 / n);
    let width = Z / (1.0 + z2 / n) * (part * (1.0 - part) / n + z2 / (4.0 * n * n)).sqrt();
    let ends = (100.0 * (middle - width).max(0.0), 100.0 * (middle + width).min(1.0));
    Some(Estimate { value: 100.0 * part, interval: Some((ends.0.min(100.0 * part), ends.1.max(100.0 * part))) })
}

/// The 97.5 % point of the normal distribution.
const Z: f64 = 1.959_963_984_540_054;

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_records::score::Errors;

    fn score() -> Score {
        let mut kept = Errors::default();
        for trial in [[(0.31, 0.39), (0.28, 0.44)], [(0.33, 0.41), (0.27, 0.38)], [(0.30, 0.42), (0.29, 0.36)]] {
            kept.add(&trial);
        }
        Score { measured: 6, lost: 2, kept, rejected: [("border", 8)].into(), ..Score::default() }
    }

    #[test]
    fn bias_and_scatter_make_the_rmse_and_lie_in_their_intervals() {
        let score = score();
        let [rmse, bias, scatter] = [Metric::Rmse, Metric::Bias, Metric::Scatter].map(|metric| metric.of(&score).unwrap());
        assert!((bias.value.hypot(scatter.value) - rmse.value).abs() < 1e-15);
        for found in [rmse, bias, scatter] {
            let (low, high) = found.interval.unwrap();
            assert!(low < found.value && found.value < high, "{found:?}");
        }
    }

    #[test]
    fn shares_have_wilsons_interval() {
        // 8 of 16: Wilson's interval is symmetric about a half, with half-width z / sqrt(n + z^2) / 2.
        let rejected = Metric::Rejected.of(&score()).unwrap();
        let half = 50.0 * Z / (16.0 + Z * Z).sqrt();
        let (low, high) = rejected.interval.unwrap();
        assert!((rejected.value - 50.0).abs() < 1e-12 && (high - 50.0 - half).abs() < 1e-9 && (50.0 - low - half).abs() < 1e-9);
        assert_eq!(Metric::Lost.of(&Score::default()), None);
        assert_eq!(share(0, 10).unwrap().interval.unwrap().0, 0.0);
    }

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
    }

    fn kept(trials: &[(f64, f64)]) -> Score {
        let mut kept = Errors::default();
        trials.iter().for_each(|error| kept.add(&[*error]));
        Score { kept, ..Score::default() }
    }

    /// t(0.975, 1) = 12.7062. dx 2 and 4: mean 3, half 12.7062; dy 3.5 and 4.5: mean 4, half 6.3531. Length 5, half (3 * 12.7062 + 4 * 6.3531) / 5.
    #[test]
    fn the_interval_of_a_bias_adds_both_axes_by_their_share() {
        let t: f64 = 12.706_204_736;
        let score = kept(&[(2.0, 3.5), (4.0, 4.5)]);
        let bias = Metric::Bias.of(&score).unwrap();
        let width = (3.0 * t + 4.0 * t / 2.0) / 5.0;
        close(bias.value, 5.0);
        assert_eq!(bias.interval.unwrap().0, 0.0, "a length is never less than nothing");
        close(bias.interval.unwrap().1, 5.0 + width);
        let small = Metric::Bias.of(&kept(&[(2.99, 4.0), (3.01, 4.0)])).unwrap();
        close(small.interval.unwrap().0, 5.0 - 0.6 * 0.01 * t);
        // No bias: the half-widths of both.
        let none = Metric::Bias.of(&kept(&[(-0.3, 0.4), (0.3, -0.4)])).unwrap();
        close(none.interval.unwrap().1, 0.5 * t);
        assert_eq!(Metric::Bias.of(&kept(&[(3.0, 4.0)])), Some(Estimate { value: 5.0, interval: None }));
    }

    /// The same errors: squares 16.25 and 36.25, mean 26.25, half 10 t; scatter sqrt(26.25 - 25), width 10 t + 2 * 3 * t + 2 * 4 * t / 2.
    #[test]
    fn the_interval_of_a_scatter_adds_those_of_three_means() {
        let t: f64 = 12.706_204_736;
        let scatter = Metric::Scatter.of(&kept(&[(2.0, 3.5), (4.0, 4.5)])).unwrap();
        close(scatter.value, 1.25_f64.sqrt());
        assert_eq!(scatter.interval.unwrap().0, 0.0);
        close(scatter.interval.unwrap().1, (1.25 + 20.0 * t).sqrt());
        assert_eq!(Metric::Scatter.of(&kept(&[(3.0, 4.0)])), Some(Estimate { value: 0.0, interval: None }));
        // Without a bias and of equal squares nothing is left but the widths of both means, which count for nothing.
        let even = Metric::Scatter.of(&kept(&[(0.3, 0.4), (-0.3, -0.4)])).unwrap();
        close(even.value, 0.5);
        close(even.interval.unwrap().0, 0.5);
    }

    #[test]
    fn every_figure_is_that_of_its_points() {
        let (mut whole, mut to_bound, mut to_predicted) = (Errors::default(), Pooled::default(), Pooled::default());
        whole.add(&[(0.5, 0.0), (2.5, 0.0)]);
        to_bound.add(&[4.0, 8.5]);
        to_predicted.add(&[0.25]);
        let score = Score {
            measured: 5,
            lost: 1,
            rejected: [("border", 3), ("flat", 1)].into(),
            whole,
            to_bound,
            to_predicted,
            ..kept(&[(0.3, 0.4)])
        };
        let of = |metric: Metric| metric.of(&score).unwrap().value;
        for (metric, expected) in [
            (Metric::Rmse, 0.5),
            (Metric::Bias, 0.5),
            (Metric::MeanX, 1.5),
            (Metric::Scatter, 0.0),
            (Metric::Ratio, 2.5),
            (Metric::Predicted, 0.5),
            (Metric::Lost, 10.0),
            (Metric::Rejected, 40.0),
            (Metric::Failed, 50.0),
        ] {
            close(of(metric), expected);
            assert_eq!(metric.reference(), matches!(metric, Metric::Ratio | Metric::Predicted).then_some(1.0));
        }
        let names: std::collections::BTreeSet<_> = Metric::ALL.iter().map(|metric| metric.name().0).collect();
        let titles: std::collections::BTreeSet<_> = Metric::ALL.iter().flat_map(|metric| [metric.title(), metric.meaning()]).collect();
        assert_eq!((names.len(), titles.len()), (9, 18));
        for metric in Metric::ALL {
            let unit = metric.name().1;
            assert!(unit.is_empty() || metric.title().ends_with(unit) && metric.meaning().ends_with(unit), "{metric:?}");
        }
    }

    /// Wilson's ends are where the share is z standard deviations of theirs away: (p - e)^2 = z^2 e (1 - e) / n.
    #[test]
    fn wilsons_ends_solve_his_equation() {
        for (count, of) in [(1, 10), (3, 17), (9, 10)] {
            let found = share(count, of).unwrap();
            let (part, n) = (count as f64 / of as f64, of as f64);
            close(found.value, 100.0 * part);
            let (low, high) = found.interval.unwrap();
            assert!(low < 100.0 * part && 100.0 * part < high);
            for end in [low / 100.0, high / 100.0] {
                close((part - end).powi(2), Z * Z * end * (1.0 - end) / n);
            }
        }
        assert_eq!((share(0, 10).unwrap().interval.unwrap().0, share(10, 10).unwrap().interval.unwrap().1), (0.0, 100.0));
    }
}
