//! The curve from light to grey value: linear, then a shoulder towards white.

/// The brightest grey value whose light is told.
const BRIGHTEST: f64 = 0.985;

/// A curve: grey is light up to 1 - `shoulder`, and beyond it ever less, towards 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tone {
    /// Length of the shoulder, grey value below 1; 0: none.
    pub shoulder: f64,
}

/// Shorter shoulders are none.
const SHORTEST: f64 = 0.02;
/// The longest shoulder.
pub const LONGEST: f64 = 0.7;

impl Tone {
    /// Whether there is a shoulder.
    pub fn is_bent(self) -> bool {
        self.shoulder >= SHORTEST
    }

    /// The light of a grey value.
    pub fn light(self, grey: f64) -> f64 {
        let start = 1.0 - self.shoulder;
        if !self.is_bent() || grey <= start {
            return grey;
        }
        start - self.shoulder * (-(grey.min(BRIGHTEST.max(start)) - start) / self.shoulder).ln_1p()
    }

    /// The slope of grey against light at a grey value.
    pub fn slope(self, grey: f64) -> f64 {
        let start = 1.0 - self.shoulder;
        if !self.is_bent() || grey <= start { 1.0 } else { (1.0 - (grey.min(BRIGHTEST) - start) / self.shoulder).max(1e-3) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_and_slope_are_those_of_the_curve() {
        let tone = Tone { shoulder: 0.3 };
        let grey = |light: f64| if light <= 0.7 { light } else { 0.7 - 0.3 * ((0.7 - light) / 0.3).exp_m1() };
        for light in [0.1, 0.6, 0.8, 1.2, 1.5] {
            assert!((tone.light(grey(light)) - light).abs() < 1e-9);
            let slope = (grey(light + 1e-6) - grey(light - 1e-6)) / 2e-6;
            assert!((tone.slope(grey(light)) - slope).abs() < 1e-5, "{light}");
        }
        assert_eq!(Tone::default().light(0.9), 0.9);
    }
}
