//! The uncertainty budget after GUM (JCGM 100:2008), of the image of a point far away over the frame.

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::answer::{Answer, OverFrame, Scale};
use crate::digits::{three, with_uncertainty};
use crate::record::Record;

/// The part of all errors that an expanded uncertainty holds: that of two standard deviations of a normal distribution.
const COVERED: f64 = 0.9545;

/// What a source contributes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contribution {
    /// So much, px.
    Px(f64),
    /// Nothing, whatever its value.
    None,
    /// It is part of another row.
    Within,
    /// Nobody knows: it is not in the sum.
    NotEvaluated,
}

/// A row of the budget.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// What the uncertainty comes of.
    pub name: String,
    /// Its standard uncertainty, in words.
    pub value: String,
    /// Type A or B, distribution, and degrees of freedom.
    pub distribution: String,
    /// How much of it passes on.
    pub sensitivity: String,
    /// What it contributes.
    pub contribution: Contribution,
}

/// The budget.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// Its rows.
    pub sources: Vec<Source>,
    /// Combined standard uncertainty, px.
    pub combined_px: Option<f64>,
    /// Effective degrees of freedom; infinite where none are limited.
    pub freedom: f64,
    /// The factor of the expanded uncertainty.
    pub k: f64,
    /// By how much uncertainties at places exceed those of the adjustment.
    pub beyond: f64,
}

impl Budget {
    /// Of a camera of a record.
    pub fn of(record: &Record, answer: &Answer, camera: usize) -> Self {
        let over = answer.cameras.get(camera).and_then(|camera| camera.over_frame);
        let formal = over.and_then(|over| over.formal_px);
        let excess = over.and_then(|over| excess(&over));
        let redundancy = answer.counts.redundancy as f64;
        let mut sources = vec![measured(answer, formal), by_images(record, excess, over)];
        sources.extend(board(record, answer));
        sources.push(later());
        let parts: Vec<(f64, f64)> = formal
            .map(|px| (px, if redundancy > 0.0 { redundancy } else { f64::INFINITY }))
            .into_iter()
            .chain(excess.zip(record.groups).map(|(px, groups)| (px, groups as f64 - 1.0)))
            .collect();
        let combined = formal.map(|_| parts.iter().map(|(px, _)| px * px).sum::<f64>().sqrt());
        let freedom = effective(&parts);
        let beyond = formal.zip(combined).filter(|(formal, _)| *formal > 0.0).map_or(1.0, |(formal, combined)| combined / formal);
        Self { sources, combined_px: combined, freedom, k: coverage(freedom), beyond }
    }

    /// The expanded uncertainty, px.
    pub fn expanded_px(&self) -> Option<f64> {
        Some(self.k * self.combined_px?)
    }
}

/// What images show beyond the adjustment's own standard deviation, px.
fn excess(over: &OverFrame) -> Option<f64> {
    let (formal, by_images) = (over.formal_px?, over.by_images_px?);
    Some((by_images * by_images - formal * formal).max(0.0).sqrt())
}

/// Source: Welch-Satterthwaite, JCGM 100:2008, G.2b.
fn effective(parts: &[(f64, f64)]) -> f64 {
    let variance: f64 = parts.iter().map(|(px, _)| px * px).sum();
    let limited: f64 = parts.iter().map(|(px, freedom)| px.powi(4) / freedom).sum();
    if limited > 0.0 { variance * variance / limited } else { f64::INFINITY }
}

/// Student's t for whole degrees of freedom, rounded down; 2 without a limit. Source: JCGM 100:2008, G.4.1.
fn coverage(freedom: f64) -> f64 {
    let whole = freedom.floor().max(1.0);
    if whole > 1e6 {
        return 2.0;
    }
    StudentsT::new(0.0, 1.0, whole).map_or(2.0, |t| t.inverse_cdf(0.5 + 0.5 * COVERED))
}

fn measured(answer: &Answer, formal: Option<f64>) -> Source {
    let estimated = answer.sigma0.filter(|_| answer.counts.redundancy > 0);
    let px = estimated.unwrap_or(1.0) * answer.sigma_px;
    let distribution = match estimated {
        Some(_) => format!("A, normal, \u{3bd} = {}", answer.counts.redundancy),
        None if answer.sigma_is_assumed => "B, normal, assumed".into(),
        None => "B, normal, stated".into(),
    };
    Source {
        name: format!("Image coordinates ({} points)", answer.counts.image_points),
        value: format!("{} px", three(px)),
        distribution,
        sensitivity: formal.filter(|_| px > 0.0).map_or("-".into(), |formal| format!("{} px/px", three(formal / px))),
        contribution: formal.map_or(Contribution::NotEvaluated, Contribution::Px),
    }
}

fn by_images(record: &Record, excess: Option<f64>, over: Option<OverFrame>) -> Source {
    let groups = record.groups.map_or("B, none".into(), |groups| format!("A, t, \u{3bd} = {}", groups.saturating_sub(1)));
    let total = over.and_then(|over| over.by_images_px);
    Source {
        name: "Differences between images beyond that".into(),
        value: total.map_or("not known".into(), |px| format!("{} px in all", three(px))),
        distribution: if excess.is_some() { groups } else { "-".into() },
        sensitivity: if excess.is_some() { "1 px/px".into() } else { "-".into() },
        contribution: excess.map_or(Contribution::NotEvaluated, Contribution::Px),
    }
}

/// Of the board, or of the control in its place.
fn board(record: &Record, answer: &Answer) -> Vec<Source> {
    let row = |name: &str, value: String, distribution: &str, sensitivity: &str, contribution: Contribution| Source {
        name: name.into(),
        value,
        distribution: distribution.into(),
        sensitivity: sensitivity.into(),
        contribution,
    };
    let flatness = |name: &str| shape(answer).map(|(value, contribution)| row(name, value, "-", "-", contribution));
    if record.board.is_none() {
        let value = if answer.counts.control_points == 0 { "no control".into() } else { "as its file states".into() };
        let control = row("Control points", value, "within the adjustment", "-", Contribution::Within);
        return [control].into_iter().chain(flatness("Shape of the control")).collect();
    }
    // A board that is larger in all directions is farther away: the camera is the same.
    let scale = match answer.board.scale {
        Some(Scale { value, sigma }) => {
            let (value, sigma) = with_uncertainty(value, sigma);
            row("Board: scale of the print", format!("{value} \u{b1} {sigma}, stated"), "B, normal", "0", Contribution::None)
        }
        None => row("Board: scale of the print", "taken as exact".into(), "-", "0", Contribution::None),
    };
    let places = match answer.board.print_noise {
        Some(sigma) => {
            row("Board: places of its points", format!("{} object units, stated", three(sigma)), "B, normal", "-", Contribution::Within)
        }
        None => row("Board: places of its points", "taken as exact".into(), "-", "-", Contribution::NotEvaluated),
    };
    [scale, places].into_iter().chain(flatness("Board: flatness")).collect()
}

/// What was made of the shape of a board.
fn shape(answer: &Answer) -> Option<(String, Contribution)> {
    match answer.board.shape.as_str() {
        "bent" => Some(("bend adjusted".into(), Contribution::Within)),
        "flat" => Some(("tested, taken as flat".into(), Contribution::NotEvaluated)),
        "untested" => Some(("not tested, taken as flat".into(), Contribution::NotEvaluated)),
        _ => None,
    }
}

fn later() -> Source {
    Source {
        name: "Focus, temperature, handling later on".into(),
        value: "not stated".into(),
        distribution: "-".into(),
        sensitivity: "-".into(),
        contribution: Contribution::NotEvaluated,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: JCGM 100:2008, table G.2.
    #[test]
    fn coverage_factors_are_those_of_the_guide() {
        for (freedom, k) in [(1.0, 13.97), (4.0, 2.87), (10.9, 2.28), (20.0, 2.13), (50.0, 2.05), (f64::INFINITY, 2.0)] {
            assert!((coverage(freedom) - k).abs() < 0.005, "{freedom}: {}", coverage(freedom));
        }
    }

    /// Source: JCGM 100:2008, H.1.6: 25, 9.7, 2.9, 16.6 nm with 18, 25.6, 50, 2 degrees of freedom give 16.
    #[test]
    fn effective_degrees_of_freedom_are_those_of_the_guide() {
        let found = effective(&[(25.0, 18.0), (9.7, 25.6), (2.9, 50.0), (16.6, 2.0)]);
        assert!((found - 16.7).abs() < 0.5, "{found}");
        assert_eq!(effective(&[(1.0, f64::INFINITY)]), f64::INFINITY);
    }

    #[test]
    fn what_images_show_beyond_is_never_negative() {
        let over = |by_images| OverFrame { formal_px: Some(3.0), by_images_px: Some(by_images), limit_px: 5.0 };
        assert_eq!([excess(&over(5.0)), excess(&over(2.0))], [Some(4.0), Some(0.0)]);
    }
}
