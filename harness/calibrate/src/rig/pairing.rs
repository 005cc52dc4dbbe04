//! Which images were taken at one moment.

use std::collections::BTreeMap;

use calibench_model::upper_median;
use glob::Pattern;

use crate::{CalibrationError, few};

/// How images of one moment are told. They are never paired by their order.
#[derive(Clone, Debug)]
pub enum Pairing {
    /// By their names: of each camera the patterns of its images, each with one `*`; images of one moment have the same text there.
    Names(Vec<Vec<Pattern>>),
    /// By the times at which they were taken.
    Times {
        /// Of the images; times of others are no matter.
        times: Vec<TimedImage>,
        /// How far apart images of one moment are, s, at most; `None` for half of the usual time between two images of a camera.
        tolerance_s: Option<f64>,
    },
}

/// An image and when it was taken.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedImage {
    /// Its name.
    pub image: String,
    /// When, s.
    pub time_s: f64,
}

/// Sets of images that were taken at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Moments {
    /// Of each set, its name.
    pub names: Vec<String>,
    /// Of each image, its set.
    pub of_image: Vec<usize>,
    /// How far apart images of a set were taken, where that is known.
    pub spread: Option<Spread>,
}

/// How far apart the images of sets were taken, and how far apart they may be, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The median of the sets.
    pub median_s: f64,
    /// The largest.
    pub largest_s: f64,
    /// What was allowed.
    pub tolerance_s: f64,
}

impl Moments {
    /// The sets of `images`, whose cameras are `owners`.
    ///
    /// # Errors
    /// A pattern without one `*`, an image without a time, in words.
    pub fn of(images: &[String], owners: &[usize], pairing: &Pairing) -> Result<Self, CalibrationError> {
        match pairing {
            Pairing::Names(patterns) => by_names(images, owners, patterns),
            Pairing::Times { times, tolerance_s } => by_times(images, owners, times, *tolerance_s),
        }
    }

    /// Images whose set has no other.
    pub fn alone(&self) -> Vec<usize> {
        let mut members = vec![0; self.names.len()];
        self.of_image.iter().for_each(|&set| members[set] += 1);
        (0..self.of_image.len()).filter(|&image| members[self.of_image[image]] == 1).collect()
    }
}

fn refused(words: String) -> CalibrationError {
    CalibrationError::Pairing(words)
}

fn by_names(images: &[String], owners: &[usize], patterns: &[Vec<Pattern>]) -> Result<Moments, CalibrationError> {
    for pattern in patterns.iter().flatten().map(Pattern::as_str) {
        if pattern.matches('*').count() != 1 || pattern.contains(['[', ']']) {
            return Err(refused(format!(
                "`{pattern}` does not say which images belong together: expected one `*`, whose text is the same of images of one moment, or --times"
            )));
        }
    }
    let mut sets: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    let mut strangers = Vec::new();
    for (index, (image, &owner)) in images.iter().zip(owners).enumerate() {
        match patterns[owner].iter().find_map(|pattern| stood_for(pattern.as_str(), image)) {
            Some(text) => sets.entry(text).or_default().push(index),
            None => strangers.push(image.clone()),
        }
    }
    if !strangers.is_empty() {
        return Err(refused(format!("no pattern of its camera names {}: expected one for all its images", few(&strangers))));
    }
    let mut of_image = vec![0; images.len()];
    let names = sets.keys().map(|text| (*text).to_owned()).collect();
    sets.values().enumerate().for_each(|(set, members)| members.iter().for_each(|&image| of_image[image] = set));
    Ok(Moments { names, of_image, spread: None })
}

/// What the one `*` of a pattern stands for in a name; `?` is any character.
fn stood_for<'n>(pattern: &str, name: &'n str) -> Option<&'n str> {
    let (before, after) = pattern.split_once('*')?;
    let ends: Vec<usize> = name.char_indices().map(|(at, _)| at).chain([name.len()]).collect();
    let (first, last) = (before.chars().count(), after.chars().count());
    let characters = ends.len() - 1;
    if first + last > characters {
        return None;
    }
    let (start, end) = (ends[first], ends[characters - last]);
    let same = |pattern: &str, text: &str| pattern.chars().zip(text.chars()).all(|(p, c)| p == '?' || p == c);
    (same(before, &name[..start]) && same(after, &name[end..])).then(|| &name[start..end])
}

fn by_times(images: &[String], owners: &[usize], times: &[TimedImage], tolerance_s: Option<f64>) -> Result<Moments, CalibrationError> {
    let known: BTreeMap<&str, f64> = times.iter().map(|row| (row.image.as_str(), row.time_s)).collect();
    let lost: Vec<String> = images.iter().filter(|image| !known.contains_key(image.as_str())).cloned().collect();
    if !lost.is_empty() {
        return Err(refused(format!("no time is known of {}: expected a row for each image", few(&lost))));
    }
    let times: Vec<f64> = images.iter().map(|image| known[image.as_str()]).collect();
    let Some(tolerance) = tolerance_s.or_else(|| half_a_period(owners, &times)) else {
        return Err(refused("the times do not say how far apart images of one moment are: give --tolerance S".into()));
    };
    let mut order: Vec<usize> = (0..images.len()).collect();
    order.sort_by(|&a, &b| times[a].total_cmp(&times[b]).then(a.cmp(&b)));
    let mut near: Vec<(f64, usize, usize)> = Vec::new();
    for (place, &a) in order.iter().enumerate() {
        let later = order[place + 1..].iter().take_while(|&&b| times[b] - times[a] <= tolerance);
        near.extend(later.filter(|&&b| owners[b] != owners[a]).map(|&b| (times[b] - times[a], a, b)));
    }
    // What is nearest in time belongs together first.
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut set: Vec<usize> = (0..images.len()).collect();
    let mut members: Vec<Vec<usize>> = (0..images.len()).map(|image| vec![image]).collect();
    for (_, a, b) in near {
        let (into, from) = (set[a].min(set[b]), set[a].max(set[b]));
        let both = || members[into].iter().chain(&members[from]);
        let twice = members[into].iter().any(|&a| members[from].iter().any(|&b| owners[a] == owners[b]));
        let [first, last] = [f64::min, f64::max].map(|of| both().map(|&image| times[image]).reduce(of).unwrap_or_default());
        if into == from || twice || last - first > tolerance {
            continue;
        }
        let moved = std::mem::take(&mut members[from]);
        moved.iter().for_each(|&image| set[image] = into);
        members[into].extend(moved);
    }
    let mut found: Vec<Vec<usize>> = members.into_iter().filter(|members| !members.is_empty()).collect();
    found.iter_mut().for_each(|members| members.sort_by_key(|&image| (owners[image], image)));
    found.sort_by(|a, b| times[a[0]].total_cmp(&times[b[0]]).then(a[0].cmp(&b[0])));
    let mut of_image = vec![0; images.len()];
    found.iter().enumerate().for_each(|(place, members)| members.iter().for_each(|&image| of_image[image] = place));
    let names = found.iter().map(|members| images[members[0]].clone()).collect();
    Ok(Moments { names, of_image, spread: Some(spread(&found, &times, tolerance)) })
}

fn spread(sets: &[Vec<usize>], times: &[f64], tolerance_s: f64) -> Spread {
    let of = |members: &Vec<usize>| {
        let [first, last] = [f64::min, f64::max].map(|of| members.iter().map(|&image| times[image]).reduce(of).unwrap_or_default());
        last - first
    };
    let all: Vec<f64> = sets.iter().filter(|members| members.len() > 1).map(of).collect();
    let largest_s = all.iter().copied().fold(0.0, f64::max);
    Spread { median_s: upper_median(all).unwrap_or_default(), largest_s, tolerance_s }
}

/// Half of the median time between an image and the next of its camera, s.
fn half_a_period(owners: &[usize], times: &[f64]) -> Option<f64> {
    let mut of_camera: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    owners.iter().zip(times).for_each(|(&owner, &time)| of_camera.entry(owner).or_default().push(time));
    let steps = of_camera.values_mut().flat_map(|times| {
        times.sort_by(f64::total_cmp);
        times.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>()
    });
    upper_median(steps).filter(|median| *median > 0.0).map(|median| 0.5 * median)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(images: &[&str]) -> Vec<String> {
        images.iter().map(|name| (*name).to_owned()).collect()
    }

    fn patterns(all: &[&str]) -> Pairing {
        Pairing::Names(all.iter().map(|text| vec![Pattern::new(text).unwrap()]).collect())
    }

    #[test]
    fn names_pair_where_the_star_stands_for_the_same() {
        let images = names(&["left01.png", "right02.png", "right01.png", "left10.png", "left02.png"]);
        let found = Moments::of(&images, &[0, 1, 1, 0, 0], &patterns(&["left*.png", "right*.p?g"])).unwrap();
        assert_eq!((found.names, found.of_image), (names(&["01", "02", "10"]), vec![0, 1, 0, 2, 1]));
        let alone = Moments::of(&images, &[0, 1, 1, 0, 0], &patterns(&["left*.png", "right*.png"])).unwrap().alone();
        assert_eq!(alone, [3]);
        assert_eq!(stood_for("a*ab", "aab"), Some(""));
        assert_eq!(stood_for("aa*ab", "aab"), None);
        for wrong in ["left*-*.png", "left.png", "left[0-9]*.png"] {
            assert!(Moments::of(&images, &[0, 1, 1, 0, 0], &patterns(&[wrong, "right*.png"])).is_err(), "{wrong}");
        }
        let stranger = Moments::of(&images, &[1, 1, 1, 0, 0], &patterns(&["left*.png", "right*.png"])).unwrap_err().to_string();
        assert!(stranger.contains("left01.png"), "{stranger}");
    }

    #[test]
    fn times_pair_what_is_nearest() {
        // The second image of the second camera is nearer to the first camera's third than to its second.
        let (images, owners) = (names(&["a0", "a1", "a2", "b0", "b1", "c0"]), [0, 0, 0, 1, 1, 2]);
        let times = |all: &[f64]| images.iter().zip(all).map(|(image, &time_s)| TimedImage { image: image.clone(), time_s }).collect();
        let at = [0.0, 0.1, 0.2, 0.01, 0.17, 0.16];
        let found = Moments::of(&images, &owners, &Pairing::Times { times: times(&at), tolerance_s: None }).unwrap();
        assert_eq!(found.of_image, [0, 1, 2, 0, 2, 2]);
        let spread = found.spread.unwrap();
        assert!((spread.tolerance_s - 0.05).abs() < 1e-9 && (spread.largest_s - 0.04).abs() < 1e-9, "{spread:?}");
        let tight = Moments::of(&images, &owners, &Pairing::Times { times: times(&at), tolerance_s: Some(0.02) }).unwrap();
        assert_eq!(tight.of_image, [0, 1, 3, 0, 2, 2]);
        let lost = Moments::of(&images, &owners, &Pairing::Times { times: times(&at[..4]), tolerance_s: None }).unwrap_err().to_string();
        assert!(lost.contains("b1, c0"), "{lost}");
    }
}
