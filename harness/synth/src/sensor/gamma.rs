//! The curve between light and grey value.

use super::{SensorError, check};

/// A curve from 0 to 0 and 1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gamma {
    /// Light to the power of 1 / this.
    Power(f64),
    /// The curve of sRGB: linear near black, then nearly the power of 1 / 2.2. Source: IEC 61966-2-1.
    Srgb,
}

impl Gamma {
    pub(super) fn check(self) -> Result<(), SensorError> {
        match self {
            Gamma::Power(gamma) => check("gamma", gamma, 0.1, 10.0),
            Gamma::Srgb => Ok(()),
        }
    }

    /// The grey value of `light`; both from 0 to 1.
    pub fn encode(self, light: f64) -> f64 {
        match self {
            Gamma::Power(gamma) => light.powf(gamma.recip()),
            Gamma::Srgb if light <= 0.003_130_8 => 12.92 * light,
            Gamma::Srgb => 1.055 * light.powf(1.0 / 2.4) - 0.055,
        }
    }

    /// The light of grey value `grey`; both from 0 to 1. The inverse of [`Gamma::encode`].
    pub fn decode(self, grey: f64) -> f64 {
        match self {
            Gamma::Power(gamma) => grey.powf(gamma),
            Gamma::Srgb if grey <= 12.92 * 0.003_130_8 => grey / 12.92,
            Gamma::Srgb => ((grey + 0.055) / 1.055).powf(2.4),
        }
    }
}
