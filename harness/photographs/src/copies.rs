//! Photographs that are the same one: nothing new is known from a copy.

use std::collections::HashMap;

use calibench_model::PixelPoint;

/// Two photographs whose points lie so near to each other, px RMS, are one, or were taken from the very same place: between two that a hand took, points move by
/// many times as much; a copy that was compressed anew moves them by hundredths.
const SAME: f64 = 0.1;
/// They share this part of their points at least.
const SHARED: f64 = 0.8;

/// A photograph and those that are the same.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Copies {
    /// Its place.
    pub of: usize,
    /// The places of the others.
    pub others: Vec<usize>,
    /// How far their points are from its own at most, px RMS.
    pub apart: f64,
}

impl Copies {
    /// In words, by the names of photographs.
    pub fn said(&self, names: &[String]) -> String {
        let all: Vec<&str> = self.others.iter().map(|copy| names[*copy].as_str()).collect();
        let (show, shows) = if all.len() == 1 { ("shows", "is") } else { ("show", "are") };
        format!(
            "{} {show} the board where {} does, to {:.2} px, and {shows} counted once with it: the same photograph, or one from the same place, tells nothing new",
            all.join(", "),
            names[self.of],
            self.apart
        )
    }
}

/// The photographs that are the same, by the points in them, each with its name.
pub(crate) fn copies(photos: &[Vec<(&str, PixelPoint)>]) -> Vec<Copies> {
    let by_name: Vec<HashMap<&str, PixelPoint>> = photos.iter().map(|points| points.iter().copied().collect()).collect();
    let mut found: Vec<Copies> = Vec::new();
    let mut taken = vec![false; photos.len()];
    for of in 0..photos.len() {
        if taken[of] || photos[of].is_empty() {
            continue;
        }
        let mut one = Copies { of, others: Vec::new(), apart: 0.0 };
        for other in of + 1..photos.len() {
            if let Some(apart) = apart(&photos[of], &by_name[other]).filter(|_| !taken[other]) {
                taken[other] = true;
                one.others.push(other);
                one.apart = one.apart.max(apart);
            }
        }
        if !one.others.is_empty() {
            found.push(one);
        }
    }
    found
}

/// How far the points of two photographs are apart, px RMS, if they are the same. The first point far off settles it.
fn apart(one: &[(&str, PixelPoint)], other: &HashMap<&str, PixelPoint>) -> Option<f64> {
    let most = one.len().max(other.len()) as f64;
    let (mut squares, mut shared) = (0.0, 0.0);
    for (name, at) in one {
        let Some(there) = other.get(name) else { continue };
        squares += at.distance(*there).powi(2);
        shared += 1.0;
        if squares > SAME * SAME * most {
            return None;
        }
    }
    let rms = (squares / shared).sqrt();
    (shared >= SHARED * most && rms <= SAME).then_some(rms)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_are_those_whose_points_are_where_they_were() {
        let names: Vec<String> = (0..60).map(|k| k.to_string()).collect();
        let photo = |by: f64, noise: f64, count: usize| -> Vec<(&str, PixelPoint)> {
            let at = |k: usize| PixelPoint::new(20.0 * (k % 10) as f64 + by + noise * (k as f64).sin(), 20.0 * (k / 10) as f64);
            names.iter().take(count).enumerate().map(|(k, name)| (name.as_str(), at(k))).collect()
        };
        // The same, compressed anew, half a pixel off, the same with most points, with few, none.
        let photos = [
            photo(0.0, 0.0, 60),
            photo(0.0, 0.05, 60),
            photo(0.5, 0.0, 60),
            photo(0.0, 0.0, 55),
            photo(0.0, 0.0, 20),
            Vec::new(),
            photo(0.5, 0.0, 60),
            Vec::new(),
        ];
        let found = copies(&photos);
        assert_eq!(found.iter().map(|one| (one.of, one.others.clone())).collect::<Vec<_>>(), [(0, vec![1, 3]), (2, vec![6])]);
        assert!(found[0].apart > 0.0 && found[0].apart < 0.05 && found[1].apart == 0.0);
        assert_eq!(
            found[1].said(&names),
            "6 shows the board where 2 does, to 0.00 px, and is counted once with it: the same photograph, or one from the same place, tells nothing new"
        );
    }
}
