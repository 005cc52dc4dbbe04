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

/// A share in %, with the interval of Wilson (1927): it takes points as independent of each other.
fn share(count: u64, of: u64) -> Option<Estimate> {
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
}
