//! The curve between light and grey value.

use super::{SensorError, check};

/// A curve from 0 to 0 and 1 to 1, but for a shoulder's upper end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gamma {
    /// Light to the power of 1 / this.
    Power(f64),
    /// The curve of sRGB: linear near black, then nearly the power of 1 / 2.2. Source: IEC 61966-2-1.
    Srgb,
    /// A shoulder as of films: `gain` times light as it is up to `start`, and beyond it ever less, towards 1: start + (1 - start) (1 - exp(-(x - start) / (1 - start))).
    Shoulder {
        /// Grey value at which it begins, below 1.
        start: f64,
        /// Slope of the curve at its beginning.
        gain: f64,
    },
}

impl Gamma {
    pub(super) fn check(self) -> Result<(), SensorError> {
        match self {
            Gamma::Power(gamma) => check("gamma", gamma, 0.1, 10.0),
            Gamma::Srgb => Ok(()),
            Gamma::Shoulder { start, gain } => {
                check("the shoulder's start", start, 0.0, 0.99)?;
                check("the shoulder's gain", gain, 1.0, 64.0)
            }
        }
    }

    /// The grey value of `light`; both from 0 to 1.
    pub fn encode(self, light: f64) -> f64 {
        match self {
            Gamma::Power(gamma) => light.powf(gamma.recip()),
            Gamma::Srgb if light <= 0.003_130_8 => 12.92 * light,
            Gamma::Srgb => 1.055 * light.powf(1.0 / 2.4) - 0.055,
            Gamma::Shoulder { start, gain } if gain * light <= start => gain * light,
            Gamma::Shoulder { start, gain } => start - (1.0 - start) * ((start - gain * light) / (1.0 - start)).exp_m1(),
        }
    }

    /// The light of grey value `grey`; both from 0 to 1. The inverse of [`Gamma::encode`].
    pub fn decode(self, grey: f64) -> f64 {
        match self {
            Gamma::Power(gamma) => grey.powf(gamma),
            Gamma::Srgb if grey <= 12.92 * 0.003_130_8 => grey / 12.92,
            Gamma::Srgb => ((grey + 0.055) / 1.055).powf(2.4),
            Gamma::Shoulder { start, gain } if grey <= start => grey / gain,
            Gamma::Shoulder { start, gain } => (start - (1.0 - start) * (-(grey - start) / (1.0 - start)).ln_1p()) / gain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shoulder_is_smooth_goes_both_ways_and_never_reaches_one() {
        let curve = Gamma::Shoulder { start: 0.7, gain: 4.0 };
        for light in [0.0, 0.1, 0.175, 0.2, 0.3, 0.5, 1.0] {
            let grey = curve.encode(light);
            assert!(grey < 1.0 && (curve.decode(grey) - light).abs() < 1e-9, "{light} {grey}");
        }
        let slope = |at: f64| (curve.encode(at + 1e-6) - curve.encode(at - 1e-6)) / 2e-6;
        assert!(
            (slope(0.1) - 4.0).abs() < 1e-6 && (slope(0.175) - 4.0).abs() < 1e-4 && (slope(0.25) / 4.0 - (-1.0_f64).exp()).abs() < 1e-4
        );
        for bad in [Gamma::Shoulder { start: 1.0, gain: 4.0 }, Gamma::Shoulder { start: 0.5, gain: 0.5 }] {
            assert!(bad.check().is_err());
        }
    }
}
