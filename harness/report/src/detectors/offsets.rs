//! Where most of the errors lie, whatever the others do.

/// The width of a class, px.
const CLASS: f64 = 0.002;
/// Errors up to this, px, have a class of their own; others count at its ends.
const REACH: f64 = 4.0;
/// From the median absolute deviation to the standard deviation of normal errors.
const NORMAL: f64 = 1.482_602_218_505_602;

/// Errors along one axis in classes: its size does not grow with their number.
#[derive(Clone, Debug)]
pub struct Offsets {
    counts: Vec<u32>,
    all: u64,
}

impl Default for Offsets {
    fn default() -> Self {
        Self { counts: vec![0; 2 * (REACH / CLASS) as usize], all: 0 }
    }
}

impl Offsets {
    /// Adds an error, px.
    pub fn add(&mut self, error: f64) {
        let class = ((error + REACH) / CLASS).clamp(0.0, (self.counts.len() - 1) as f64) as usize;
        self.counts[class] += 1;
        self.all += 1;
    }

    /// The median, px, to the width of a class; `None` of nothing.
    pub fn median(&self) -> Option<f64> {
        let half = 0.5 * self.all as f64;
        let mut below = 0.0;
        for (class, &count) in self.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let next = below + f64::from(count);
            if next >= half {
                // As if a class's errors were spread evenly.
                return Some((class as f64 + (half - below) / f64::from(count)) * CLASS - REACH);
            }
            below = next;
        }
        None
    }

    /// The standard deviation by the median absolute deviation from the median, px.
    pub fn scatter(&self) -> Option<f64> {
        let middle = self.median()?;
        let mut away = Self::default();
        for (class, &count) in self.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let off = ((class as f64 + 0.5) * CLASS - REACH - middle).abs();
            let to = ((off + REACH) / CLASS).clamp(0.0, (away.counts.len() - 1) as f64) as usize;
            away.counts[to] += count;
            away.all += u64::from(count);
        }
        away.median().map(|deviation| NORMAL * deviation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantiles of a normal distribution, shifted, and a fifth of gross errors.
    #[test]
    fn gross_errors_move_neither_much() {
        use statrs::distribution::{ContinuousCDF, Normal};
        let normal = Normal::new(0.5, 0.03).unwrap();
        let mut offsets = Offsets::default();
        for i in 0..2000 {
            offsets.add(normal.inverse_cdf((f64::from(i) + 0.5) / 2000.0));
        }
        let [median, scatter] = [offsets.median(), offsets.scatter()].map(Option::unwrap);
        assert!((median - 0.5).abs() < 1e-3 && (scatter - 0.03).abs() < 1e-3, "{median} {scatter}");
        for i in 0..100 {
            offsets.add(f64::from(i % 2) * 200.0 - 100.0);
        }
        let [median, scatter] = [offsets.median(), offsets.scatter()].map(Option::unwrap);
        assert!((median - 0.5).abs() < 1e-3 && (scatter - 0.032).abs() < 2e-3, "{median} {scatter}");
        assert_eq!((offsets.all, Offsets::default().median(), Offsets::default().scatter()), (2100, None, None));
    }
}
