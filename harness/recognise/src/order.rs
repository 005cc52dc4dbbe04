//! Which line of a grid a line is.

use crate::hough::Line;

/// How far from a whole number a line's place in the sequence may be.
const OFF: f64 = 0.1;
/// How fast the distance of lines may change, by the projective term of one step.
const CHANGE: f64 = 0.12;
/// Lines nearer than this are one, px.
const SAME: f64 = 4.0;
/// Lines of a direction that are looked at: the best supported.
const MOST: usize = 14;
/// What a line that should be there and is not takes away, in lines.
const MISSING: f64 = 0.6;

/// A line and its number.
#[derive(Clone, Debug)]
pub(crate) struct Numbered {
    pub line: Line,
    pub number: i64,
}

/// The lines that are a perspective view of parallel lines at equal distances, numbered from 0, by where they cross the line through the middle of the image
/// along `across`; `None` if there are not two. Its second part tells how many support it.
pub(crate) fn numbered(lines: &[&Line], across: [f64; 2]) -> Option<(Vec<Numbered>, f64)> {
    let mut placed: Vec<(f64, &Line)> = Vec::new();
    for &line in lines {
        let cosine = line.normal[0] * across[0] + line.normal[1] * across[1];
        let s = line.r / cosine;
        // Lines come with the best supported first.
        if placed.len() < MOST && placed.iter().all(|(other, _)| (other - s).abs() > SAME) {
            placed.push((s, line));
        }
    }
    placed.sort_by(|a, b| a.0.total_cmp(&b.0));
    let most = placed.iter().map(|(_, line)| line.points).max()? as f64;
    let weights: Vec<f64> = placed.iter().map(|(_, line)| (line.points as f64 / most).sqrt()).collect();
    let places: Vec<f64> = placed.iter().map(|(s, _)| *s).collect();
    let (numbers, score) = best(&places, &weights)?;
    let first = numbers.iter().flatten().min()?;
    let of = |(number, (_, line)): (&Option<i64>, &(f64, &Line))| number.map(|n| Numbered { line: (*line).clone(), number: n - first });
    Some((numbers.iter().zip(&placed).filter_map(of).collect(), score))
}

type Numbers = Vec<Option<i64>>;

fn best(places: &[f64], weights: &[f64]) -> Option<(Numbers, f64)> {
    let n = places.len();
    if n < 3 {
        return (n == 2).then(|| (vec![Some(0), Some(1)], weights.iter().sum()));
    }
    let mut best: Option<(Numbers, f64)> = None;
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                for (d, e) in [(1, 1), (1, 2), (2, 1), (1, 3), (3, 1), (2, 3), (3, 2)] {
                    let Some(sequence) = Sequence::through([places[i], places[j], places[k]], f64::from(d), f64::from(d + e)) else {
                        continue;
                    };
                    let found = sequence.numbers(places, weights);
                    if best.as_ref().is_none_or(|best| found.1 > best.1 + 1e-9) {
                        best = Some(found);
                    }
                }
            }
        }
    }
    best
}

/// Places s(k) = (s0 + a k) / (1 + c k).
struct Sequence {
    s0: f64,
    a: f64,
    c: f64,
}

impl Sequence {
    fn through([s0, s1, s2]: [f64; 3], k1: f64, k2: f64) -> Option<Self> {
        // a k - c k s = s - s0, twice.
        let det = k1 * k2 * (s1 - s2);
        let a = ((s1 - s0) * -k2 * s2 + (s2 - s0) * k1 * s1) / det;
        let c = (k1 * (s2 - s0) - k2 * (s1 - s0)) / det;
        (c.abs() <= CHANGE && a.is_finite()).then_some(Self { s0, a, c })
    }

    fn numbers(&self, places: &[f64], weights: &[f64]) -> (Numbers, f64) {
        let mut numbers: Numbers = Vec::with_capacity(places.len());
        let mut score = 0.0;
        for (s, weight) in places.iter().zip(weights) {
            let k = (s - self.s0) / (self.a - self.c * s);
            let on = (k - k.round()).abs() < OFF && k.abs() < 100.0 && 1.0 + self.c * k > 0.1;
            let number = on.then(|| k.round() as i64).filter(|number| !numbers.contains(&Some(*number)));
            score += if number.is_some() { weight - ((k - k.round()) / OFF).powi(2) * 0.2 } else { 0.0 };
            numbers.push(number);
        }
        let seen: Vec<i64> = numbers.iter().flatten().copied().collect();
        let range = seen.iter().max().unwrap_or(&0) - seen.iter().min().unwrap_or(&0) + 1;
        (numbers, score - MISSING * (range - seen.len() as i64) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_perspective_sequence_is_numbered_among_false_lines_and_with_gaps() {
        let at = |k: f64| (-100.0 + 30.0 * k) / (1.0 + 0.05 * k);
        let places = [at(0.0), at(1.0), -58.0, at(2.0), at(4.0), at(5.0), 41.0];
        let mut sorted = places;
        sorted.sort_by(f64::total_cmp);
        let (numbers, _) = best(&sorted, &[1.0; 7]).unwrap();
        let of = |place: f64| numbers[sorted.iter().position(|&s| s == place).unwrap()];
        let first = of(at(0.0)).unwrap();
        for (k, expected) in [(1.0, 1), (2.0, 2), (4.0, 4), (5.0, 5)] {
            assert_eq!(of(at(k)).map(|n| n - first), Some(expected));
        }
        assert_eq!((of(-58.0), of(41.0)), (None, None));
    }

    #[test]
    fn two_lines_are_a_square_and_one_is_none() {
        assert_eq!(best(&[0.0, 50.0], &[1.0, 0.5]).unwrap().0, [Some(0), Some(1)]);
        assert!(best(&[0.0], &[1.0]).is_none());
    }

    #[test]
    fn equal_distances_are_single_steps() {
        let (numbers, score) = best(&[-60.0, 0.0, 60.0], &[1.0; 3]).unwrap();
        assert_eq!(numbers, [Some(0), Some(1), Some(2)]);
        assert!((score - 3.0).abs() < 1e-9);
    }
}
