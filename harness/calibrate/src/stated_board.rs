//! What is stated of a board beside its nominal coordinates: the scale of its print, and how far its corners are from their places.

use std::borrow::Cow;
use std::str::FromStr;

use calibench_adjust::Covariances;
use calibench_model::{ControlDisc, ControlRow};
use nalgebra::Point3;
use thiserror::Error;

/// The scale of a print: true over nominal length, a number, with its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardScale {
    /// True over nominal length.
    pub value: f64,
    /// Its standard deviation, a number.
    pub sigma: f64,
}

/// What is stated of a board; nothing as a rule.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedBoard {
    /// The scale of the print; `None` where it is taken as exact.
    pub scale: Option<BoardScale>,
    /// The standard deviation of X, Y and Z of each corner whose control gives none, object units; `None` where corners are taken as exact.
    pub noise: Option<f64>,
    /// Every corner is to be measured: [`crate::Calibration::measured_board`].
    pub is_measured: bool,
}

/// Text that is no scale of a board.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "`{0}` is no scale of a board: expected true over nominal length and its standard deviation, between 0.5 and 2 and below 0.1, as in 1.0003:2e-4"
)]
pub struct NoBoardScale(String);

impl FromStr for BoardScale {
    type Err = NoBoardScale;

    fn from_str(text: &str) -> Result<Self, NoBoardScale> {
        let parts = || {
            let (value, sigma) = text.split_once(':').or_else(|| text.split_once('\u{b1}'))?;
            let number = |text: &str| text.trim().parse::<f64>().ok();
            Some(Self { value: number(value)?, sigma: number(sigma)? })
        };
        let can_be = |scale: &Self| (0.5..=2.0).contains(&scale.value) && scale.sigma > 0.0 && scale.sigma < 0.1;
        parts().filter(can_be).ok_or_else(|| NoBoardScale(text.to_owned()))
    }
}

impl StatedBoard {
    /// Control as it is stated to be: in the scale of the print, with standard deviations.
    pub fn applied<'c>(&self, control: &'c [ControlRow]) -> Cow<'c, [ControlRow]> {
        if self.scale.is_none() && self.noise.is_none() {
            return control.into();
        }
        let scale = self.scale.map_or(1.0, |scale| scale.value);
        let row = |row: &ControlRow| ControlRow {
            position: row.position.map(|at| at * scale),
            sigmas: row.sigmas.map(|sigmas| sigmas.map(|sigma| sigma * scale)).or_else(|| self.noise.map(|sigma| [sigma; 3])),
            disc: row.disc.as_deref().map(|disc| Box::new(ControlDisc { radius: disc.radius * scale, ..*disc })),
            ..row.clone()
        };
        control.iter().map(row).collect::<Vec<_>>().into()
    }
}

impl BoardScale {
    /// Standard deviation over value: of every length, a share.
    pub fn share(&self) -> f64 {
        self.sigma / self.value
    }

    /// Adds the part of the scale to the covariances of poses and points: all lengths together are wrong by one factor, about the origin of the object's frame. No
    /// interior orientation depends on it.
    pub(crate) fn add_to(&self, covariances: &mut Covariances, centres: impl Iterator<Item = Point3<f64>>, points: &[Point3<f64>]) {
        let variance = self.share().powi(2);
        for (block, centre) in covariances.poses.iter_mut().zip(centres) {
            let mut place = block.fixed_view_mut::<3, 3>(0, 0);
            place += centre.coords * centre.coords.transpose() * variance;
        }
        for (block, point) in covariances.points.iter_mut().zip(points) {
            *block += point.coords * point.coords.transpose() * variance;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_is_a_word() {
        assert_eq!("1.0003:2e-4".parse(), Ok(BoardScale { value: 1.0003, sigma: 2e-4 }));
        assert_eq!(" 0.999 \u{b1} 1e-3".parse(), Ok(BoardScale { value: 0.999, sigma: 1e-3 }));
        for wrong in ["", "1", "1:", "1:0", "1:-1e-4", "1:0.1", "3:1e-4", "0.1:1e-4", "NaN:1e-4", "1:NaN", "1.0003+2e-4"] {
            let error = wrong.parse::<BoardScale>().unwrap_err().to_string();
            assert!(error.contains("as in 1.0003:2e-4"), "{wrong}: {error}");
        }
    }

    #[test]
    fn control_is_scaled_and_has_the_stated_sigma_where_it_has_none() {
        let own = ControlRow { sigmas: Some([0.1, 0.2, 0.3]), ..ControlRow::new("b", [2.0, 4.0, 0.0]) };
        let control = [ControlRow::new("a", [1.0, 0.0, -3.0]), own];
        assert!(matches!(StatedBoard::default().applied(&control), Cow::Borrowed(_)));
        let stated = StatedBoard { scale: Some(BoardScale { value: 2.0, sigma: 1e-3 }), noise: Some(0.05), is_measured: false };
        let applied = stated.applied(&control);
        assert_eq!((applied[0].position, applied[0].sigmas), ([2.0, 0.0, -6.0], Some([0.05; 3])));
        assert_eq!((applied[1].position, applied[1].sigmas), ([4.0, 8.0, 0.0], Some([0.2, 0.4, 0.6])));
    }
}
