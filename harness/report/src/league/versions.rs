//! Which configurations and versions of one system differ.

use super::cells::League;

/// Two calibrators of one system, and the classes in which their numbers differ.
pub struct Pair {
    /// Their places.
    pub places: [usize; 2],
    /// Classes that both were asked.
    pub classes: usize,
    /// Those in which any trial differs, with the ratio of errors.
    pub differing: Vec<(usize, Option<Ratio>)>,
}

/// A geometric mean and its 95 % interval.
pub type Ratio = (f64, [f64; 2]);

/// A number to the digits of the tables is the same within this, relatively.
const SAME: f64 = 2e-3;

/// All pairs of calibrators of one system in different versions.
pub fn pairs(league: &League) -> Vec<Pair> {
    let mut found = Vec::new();
    for one in 0..league.calibrators.len() {
        for other in one + 1..league.calibrators.len() {
            let [a, b] = [&league.calibrators[one], &league.calibrators[other]];
            if a.system == b.system && a.version != b.version && configuration(&a.name) == configuration(&b.name) {
                found.push(pair(league, [one, other]));
            }
        }
    }
    found
}

/// A name without the digits that say a version, the first there are: calibrators of one configuration in several versions are called alike but for these.
fn configuration(name: &str) -> String {
    let mut parts: Vec<&str> = name.split('_').collect();
    if let Some(version) = parts.iter().position(|part| part.chars().all(|c| c.is_ascii_digit())) {
        parts.remove(version);
    }
    parts.join("_")
}

fn pair(league: &League, places: [usize; 2]) -> Pair {
    let mut pair = Pair { places, classes: 0, differing: Vec::new() };
    for class in 0..league.classes.len() {
        let cells = places.map(|place| league.cell(class, place).filter(|cell| cell.trials > 0));
        let [Some(one), Some(other)] = cells else { continue };
        pair.classes += 1;
        let differs = one.ended != other.ended || one.frames.iter().zip(&other.frames).any(|(a, b)| !is_same(*a, *b));
        if differs {
            pair.differing.push((class, league.ratio(class, [places[1], places[0]])));
        }
    }
    pair
}

fn is_same(a: Option<f64>, b: Option<f64>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= SAME * a.abs().max(b.abs()),
        (a, b) => a.is_none() && b.is_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_no_part_of_a_configuration() {
        assert_eq!(configuration("opencv_413_ro"), configuration("opencv_50_ro"));
        assert_ne!(configuration("opencv_413_300"), configuration("opencv_414"));
        assert!(is_same(Some(1.0), Some(1.001)) && !is_same(Some(1.0), Some(1.01)) && !is_same(None, Some(1.0)) && is_same(None, None));
    }
}
