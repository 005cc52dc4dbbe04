//! Where 95 % of some figures lie.

/// The share of figures on either side of a range.
const TAIL: f64 = 0.025;

/// Where figures lie: by their quantiles, whatever their distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Half of them are below.
    pub median: f64,
    /// 2.5 % are below.
    pub low: f64,
    /// 2.5 % are above.
    pub high: f64,
}

impl Range {
    /// That of `values`, in any order; `None` where there are none. One more of the same kind lies in it with a probability of 95 %, where there are 39 or more; of fewer the
    /// range is that of all.
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        let at = |share: f64| {
            let place = (share * (last + 2) as f64 - 1.0).clamp(0.0, last as f64);
            let (below, part) = (place.floor() as usize, place.fract());
            sorted[below] + part * (sorted[(below + 1).min(last)] - sorted[below])
        };
        Some(Self { median: at(0.5), low: at(TAIL), high: at(1.0 - TAIL) })
    }

    /// In a unit that is `factor` times as small.
    pub fn scaled(self, factor: f64) -> Self {
        Self { median: self.median * factor, low: self.low * factor, high: self.high * factor }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 79 figures part the line into 80 intervals, of which 2.5 % are two.
    #[test]
    fn ranges_are_those_counted_by_hand() {
        let values: Vec<f64> = (0..79).map(|i| f64::from((i * 17) % 79)).collect();
        assert_eq!(Range::of(&values), Some(Range { median: 39.0, low: 1.0, high: 77.0 }));
        assert_eq!(Range::of(&[2.0, 1.0, 4.0]), Some(Range { median: 2.0, low: 1.0, high: 4.0 }), "of few, all");
        assert_eq!(Range::of(&[1.0, 2.0]).unwrap().median, 1.5, "between two");
        assert_eq!(Range::of(&[]), None);
        assert_eq!(Range::of(&[1.0, 3.0]).unwrap().scaled(2.0), Range { median: 4.0, low: 2.0, high: 6.0 });
    }

    /// Counts that are mostly 0: mean 1, deviation 3.2, so that two deviations below the mean is -5.
    #[test]
    fn a_range_holds_no_figure_that_cannot_be() {
        let counts: Vec<f64> = (0..100).map(|i| if i < 90 { 0.0 } else { 10.0 }).collect();
        assert_eq!(Range::of(&counts), Some(Range { median: 0.0, low: 0.0, high: 10.0 }));
    }
}
