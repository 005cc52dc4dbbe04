//! What the network does not determine, in names.

use std::fmt;

/// Unknowns that the observations leave undetermined.
#[derive(Clone, Debug, PartialEq)]
pub enum Defect {
    /// Nothing fixes (all of) the frame of the object.
    Datum {
        /// What is free: origin, rotations, scale.
        free: Vec<&'static str>,
        /// What of the geometry explains it.
        reasons: Vec<Reason>,
    },
    /// Points of which there are too few rays, by name, with the images that see them.
    Points {
        /// Name and number of images.
        points: Vec<(String, usize)>,
    },
    /// Images in which too few points were measured, by name, with their number.
    Images {
        /// Name and number of points.
        images: Vec<(String, usize)>,
    },
    /// Cameras of a rig that share no station with each other.
    Unconnected {
        /// Names of the cameras of each set that is connected in itself.
        sets: Vec<Vec<String>>,
    },
    /// Fewer observations than unknowns, or parameters of a camera without an image.
    Count {
        /// In words.
        missing: String,
    },
    /// Combinations of unknowns that change no observation, or none that could be told from noise.
    Directions {
        /// Each in names.
        directions: Vec<Direction>,
        /// What of the geometry explains it.
        reasons: Vec<Reason>,
    },
}

/// A combination of unknowns that the observations do not determine.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// The unknowns that change together, as in "c of camera", "Z0 of all images".
    pub unknowns: Vec<String>,
    /// The smaller, the less determined: an eigenvalue of the normal equations scaled to ones on the diagonal, a number.
    pub eigenvalue: f64,
}

/// A property of the network that makes it weak.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// There is but one image.
    OneImage,
    /// The object points lie in a plane.
    NoDepth,
    /// The object points lie on a line.
    OnALine,
    /// The camera's axes are nearly parallel.
    NoConvergence,
    /// No image is rolled against the others.
    NoRoll,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OneImage => "one image",
            Self::NoDepth => "no depth",
            Self::OnALine => "all points on a line",
            Self::NoConvergence => "no convergence",
            Self::NoRoll => "no roll",
        })
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.unknowns.split_last() {
            Some((last, [])) => f.write_str(last),
            Some((last, others)) => write!(f, "{} and {last}", others.join(", ")),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counted = |all: &[(String, usize)], what: &str, of: &str| {
            let shown = all.iter().take(10).map(|(name, count)| format!("{what} {name} ({count} {of})")).collect::<Vec<_>>().join(", ");
            if all.len() > 10 { format!("{shown} and {} more", all.len() - 10) } else { shown }
        };
        match self {
            Self::Datum { free, reasons } => {
                write!(f, "nothing fixes the frame of the object: {}", free.join(", "))?;
                because(f, reasons)
            }
            Self::Points { points } => write!(f, "too few rays: {}", counted(points, "point", "images")),
            Self::Images { images } => write!(f, "too few points: {}", counted(images, "image", "points")),
            Self::Unconnected { sets } => {
                let sets: Vec<String> = sets.iter().map(|set| some(set)).collect();
                write!(f, "the cameras are not one rig: no station joins {}", sets.join(" with "))
            }
            Self::Count { missing } => f.write_str(missing),
            Self::Directions { directions, reasons } => {
                let directions = directions.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
                write!(f, "not determined: {directions}")?;
                because(f, reasons)
            }
        }
    }
}

fn because(f: &mut fmt::Formatter<'_>, reasons: &[Reason]) -> fmt::Result {
    if reasons.is_empty() {
        return Ok(());
    }
    write!(f, ": {}", reasons.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "))
}

/// Some names, and how many more there are.
fn some(names: &[String]) -> String {
    let shown = names.iter().take(5).cloned().collect::<Vec<_>>().join(", ");
    let all = if names.len() > 5 { format!("{shown} and {} more", names.len() - 5) } else { shown };
    if names.len() > 1 { format!("({all})") } else { all }
}
