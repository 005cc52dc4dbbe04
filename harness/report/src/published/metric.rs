//! Our figures that can stand behind a printed cell.

use schemars::JsonSchema;
use serde::Deserialize;

/// A figure of ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Metric {
    /// Measured x of one target.
    X,
    /// Measured y of one target.
    Y,
    /// Error in x of one target.
    Dx,
    /// Error in y of one target.
    Dy,
    /// Distance of one target from its true position.
    Distance,
    /// Mean error in x.
    MeanDx,
    /// Mean error in y.
    MeanDy,
    /// Root mean square error in x.
    RmseX,
    /// Root mean square error in y.
    RmseY,
    /// Mean distance from the truth.
    MeanDistance,
    /// Root mean square distance from the truth.
    RmseXy,
    /// None of ours: what is printed stands alone.
    Unscored,
    /// Of an adjustment: a parameter of the interior orientation.
    IopValue,
    /// Of an adjustment: its reported standard deviation.
    IopSigma,
    /// The same, in pixels.
    IopSigmaPx,
    /// Its reported standard deviation over that of the reference method.
    SigmaRatio,
    /// The mean of these over all parameters.
    MeanSigmaRatio,
    /// Planimetric RMSE of check points over their mean distance.
    RelativeXy,
    /// Altimetric RMSE of check points over their mean distance.
    RelativeZ,
    /// Planimetric RMSE over that of the reference method.
    RelativeXyRatio,
    /// Altimetric RMSE over that of the reference method.
    RelativeZRatio,
    /// Of an adjustment: the figure `of` of the group `group` in the set or block `set`.
    Figure,
    /// The same over the figure that `over` names.
    FigureRatio,
}

impl Metric {
    /// Whether it is a figure of one target.
    pub fn is_of_one_target(self) -> bool {
        matches!(self, Self::X | Self::Y | Self::Dx | Self::Dy | Self::Distance)
    }

    /// Whether it is a figure of adjustments.
    pub fn is_of_adjustment(self) -> bool {
        use Metric::{
            Figure, FigureRatio, IopSigma, IopSigmaPx, IopValue, MeanSigmaRatio, RelativeXy, RelativeXyRatio, RelativeZ, RelativeZRatio,
            SigmaRatio,
        };
        matches!(
            self,
            IopValue
                | IopSigma
                | IopSigmaPx
                | SigmaRatio
                | MeanSigmaRatio
                | RelativeXy
                | RelativeZ
                | RelativeXyRatio
                | RelativeZRatio
                | Figure
                | FigureRatio
        )
    }

    /// By how many units of the last digit ours may differ: a coordinate is rounded once; what is computed from rounded figures, once more.
    pub fn units(self) -> f64 {
        if matches!(self, Self::X | Self::Y) { 0.5 } else { 1.0 }
    }
}
