//! Otsu's threshold, exactly and without sorting all values.

/// Bins between the least and the largest value.
const BINS: usize = 256;
/// What rounding may take from a bound.
const ROUNDING: f64 = 1e-9;

/// The values of one bin.
#[derive(Clone, Copy)]
struct Bin {
    count: usize,
    sum: f64,
    least: f64,
}

const EMPTY: Bin = Bin { count: 0, sum: 0.0, least: f64::INFINITY };

/// How the values are told apart.
struct Scale {
    least: f64,
    per_unit: f64,
}

impl Scale {
    /// Ascends with the value.
    #[inline(always)]
    fn bin(&self, value: f64) -> usize {
        (((value - self.least) * self.per_unit) as usize).min(BINS - 1)
    }
}

/// Number and sum of all values.
#[derive(Clone, Copy)]
struct Whole {
    n: f64,
    total: f64,
}

impl Whole {
    /// The variance between the classes when `below` values of that sum are the lower one, times n^2.
    fn between(self, below: f64, sum: f64) -> f64 {
        let above = self.n - below;
        let difference = sum / below - (self.total - sum) / above;
        below * above * difference * difference
    }

    /// What [`Self::between`] does not exceed where the lower class ends within `bin`, which holds none of the values around the mean: the lower class's sum
    /// less as many means is farthest from zero at an end of the bin, and so is the product of the numbers smallest.
    fn most(self, (before, sum): (usize, f64), bin: &Bin) -> f64 {
        let from_mean = |count: usize, sum: f64| (sum - count as f64 * self.total / self.n).abs();
        let farthest = from_mean(before, sum).max(from_mean(before + bin.count, sum + bin.sum));
        let product = |below: usize| below as f64 * (self.n - below as f64);
        let least = product(before + 1).min(product((before + bin.count).min(self.n as usize - 1)));
        (self.n * farthest).powi(2) / least
    }
}

/// Otsu's threshold: midway between the two neighbours in order whose separation makes the variance between the classes largest, the lowest of several; `None` if
/// all values are equal. Values are finite.
///
/// Only the bins in which the largest may lie are sorted.
///
/// Source: Otsu 1979.
pub(crate) fn otsu(values: &[f64]) -> Option<f64> {
    let (least, largest) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (v.min(low), v.max(high)));
    if least >= largest {
        return None;
    }
    let scale = Scale { least, per_unit: BINS as f64 / (largest - least) };
    let mut bins = [EMPTY; BINS];
    for &value in values {
        let bin = &mut bins[scale.bin(value)];
        *bin = Bin { count: bin.count + 1, sum: bin.sum + value, least: bin.least.min(value) };
    }
    let whole = Whole { n: values.len() as f64, total: bins.iter().map(|bin| bin.sum).sum() };
    let wanted = candidates(&bins, whole, scale.bin(whole.total / whole.n));
    let mut sorted: Vec<f64> = values.iter().copied().filter(|&value| wanted[scale.bin(value)]).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    search(&bins, whole, &wanted, &sorted)
}

/// The bins in which the best threshold may lie.
fn candidates(bins: &[Bin; BINS], whole: Whole, of_mean: usize) -> [bool; BINS] {
    let ends = || {
        bins.iter().scan((0, 0.0), |below, bin| {
            let before = *below;
            *below = (below.0 + bin.count, below.1 + bin.sum);
            Some((before, *below))
        })
    };
    let at_ends = ends().filter(|(_, (below, _))| *below > 0 && *below < whole.n as usize);
    let best = at_ends.map(|(_, (below, sum))| whole.between(below as f64, sum)).fold(0.0, f64::max);
    let mut wanted = [false; BINS];
    for (index, ((before, _), bin)) in ends().zip(bins).enumerate() {
        let may_win = || whole.most(before, bin) >= best * (1.0 - ROUNDING);
        wanted[index] = bin.count > 0 && (index.abs_diff(of_mean) <= 1 || may_win());
    }
    wanted
}

/// The best of the separations that follow a value of the wanted bins.
fn search(bins: &[Bin; BINS], whole: Whole, wanted: &[bool; BINS], mut sorted: &[f64]) -> Option<f64> {
    let (mut before, mut sum_before) = (0, 0.0);
    let (mut best, mut threshold) = (0.0, None);
    for (index, bin) in bins.iter().enumerate() {
        if wanted[index] {
            let (mine, others) = sorted.split_at(bin.count);
            sorted = others;
            let next = bins[index + 1..].iter().find(|bin| bin.count > 0).map(|bin| bin.least);
            let mut sum = sum_before;
            for (place, &value) in mine.iter().enumerate() {
                sum += value;
                let Some(after) = mine.get(place + 1).copied().or(next) else { break };
                let between = whole.between((before + place + 1) as f64, sum);
                if after > value && between > best {
                    (best, threshold) = (between, Some((value + after) / 2.0));
                }
            }
        }
        (before, sum_before) = (before + bin.count, sum_before + bin.sum);
    }
    threshold
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All values sorted, each separation tried.
    fn by_sorting(values: &[f64]) -> Option<f64> {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let whole = Whole { n: sorted.len() as f64, total: sorted.iter().sum() };
        let (mut sum, mut best, mut threshold) = (0.0, 0.0, None);
        for (index, pair) in sorted.windows(2).enumerate() {
            sum += pair[0];
            let between = whole.between(index as f64 + 1.0, sum);
            if pair[1] > pair[0] && between > best {
                (best, threshold) = (between, Some((pair[0] + pair[1]) / 2.0));
            }
        }
        threshold
    }

    #[test]
    fn two_heaps_are_separated() {
        let values: Vec<f64> = (0..20).map(|i| 0.1 + 0.001 * f64::from(i)).chain((0..5).map(|i| 0.8 + 0.001 * f64::from(i))).collect();
        assert!((otsu(&values).unwrap() - (0.119 + 0.8) / 2.0).abs() < 1e-12);
        assert_eq!(otsu(&[0.4; 9]), None);
        assert_eq!(otsu(&[0.4]), None);
        assert_eq!(otsu(&[]), None);
        assert_eq!(otsu(&[1.0, 1.0 + 1e-6, 1.0]), Some(1.0 + 5e-7));
        // A step of a bin below all numbers.
        assert_eq!(otsu(&[0.0, 1e-310, 0.0]), by_sorting(&[0.0, 1e-310, 0.0]));
    }

    /// Heaps of values, of few levels as in 8 bit, or of any.
    fn heaps(mut draw: impl FnMut() -> f64) -> Vec<f64> {
        let levels = if draw() < 0.5 { 0.0 } else { (300.0 * draw()).ceil() };
        let mut values = Vec::new();
        for _ in 0..=(4.0 * draw()) as usize {
            let (middle, width, count) = (5.0 * draw() - 2.0, 0.6 * draw(), 1 + (120.0 * draw()) as usize);
            values.extend((0..count).map(|_| middle + width * (draw() + draw())));
        }
        values.into_iter().map(|v| if levels > 0.0 { (v * levels).round() / levels } else { v }).collect()
    }

    #[test]
    fn it_is_that_of_all_values_sorted() {
        let mut state = 22_u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as f64 / f64::from(1_u32 << 31)
        };
        let mut equal = 0;
        for _ in 0..4000 {
            let values = heaps(&mut draw);
            let (found, sorted) = (otsu(&values), by_sorting(&values));
            assert_eq!(found.is_some(), sorted.is_some(), "{values:?}");
            equal += usize::from(found == sorted);
            // The others are as good but for rounding.
            let whole = Whole { n: values.len() as f64, total: values.iter().sum() };
            let [a, b] = [found, sorted].map(|threshold| {
                let below = values.iter().filter(|v| threshold.is_some_and(|threshold| **v < threshold));
                whole.between(below.clone().count().max(1) as f64, below.sum())
            });
            assert!(found.is_none() || (a - b).abs() <= 1e-12 * b, "{a} {b}");
        }
        assert!(equal > 3990, "{equal}");
    }
}
