//! Adjustments as the gate compares them: as if they were points, one pair of figures each, trial by trial; and figure by figure.

use std::collections::BTreeMap;
use std::sync::Arc;

use calibench_model::Rejection;
use calibench_records::adjustments as recorded;
use calibench_records::figures::{FigureName, Group, Kind, Quantity};
use calibench_records::results::{Calibrated, Figure, find};

use super::point_entry::{Entry, Found, rounded};

/// Value, standard deviation and error of a figure of an adjustment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers {
    /// The value, in the figure's unit.
    pub value: f64,
    /// Its reported standard deviation, in the same unit.
    pub sigma: Option<f64>,
    /// Value less truth, in the same unit.
    pub error: Option<f64>,
}

/// Which figure of the adjustments of a method: the set of parameters (from 0), and the figure.
pub type FigureKey = (usize, FigureName);

/// The errors of check points that are compared as points are, in the object unit.
pub(super) const CHECKED: [Quantity; 2] = [Quantity::RmseXy, Quantity::RmseZ];

/// The view under which they stand.
pub(super) const VIEW: &str = "adjustment";

/// The camera over the frame and, where there is a second step, the check points, of the first set of parameters; of a free network its sigma0, of every set;
/// of a recognition what was not labelled and what was labelled wrongly, as shares. An adjustment that failed is a rejected one.
pub(super) fn entries(adjusted: &Calibrated) -> Vec<(Arc<str>, Entry)> {
    let failed = Entry::Rejected(Rejection::NotConverged);
    let first = adjusted.set == 0;
    let Ok(figures) = &adjusted.outcome else {
        return if first { vec![("camera".into(), failed), ("check points".into(), failed)] } else { Vec::new() };
    };
    let measured = |x: f64, y: f64| Entry::Measured(Found::bare([rounded(x), rounded(y)]));
    let value = |figure: &Figure| recorded::recorded(figure).value;
    let Some(frame) = find(figures, Quantity::OverFrame) else {
        let sigma0 = find(figures, Quantity::Sigma0).filter(|_| adjusted.kind() == Some(Kind::FreeNetwork));
        let sigma0 = sigma0.map(|figure| (format!("sigma0 {}", adjusted.set).into(), measured(value(figure), 0.0)));
        let recognised = recognised(figures).into_iter().map(|(name, [lost, wrong])| (name, measured(lost, wrong)));
        let found: Vec<(Arc<str>, Entry)> = sigma0.into_iter().chain(recognised).collect();
        // Figures without any of a camera are no adjustment of one: what is printed, and what follows from it.
        let camera = first && figures.iter().any(|figure| figure.name.group() == Group::Iop);
        return if found.is_empty() && camera { vec![("camera".into(), failed)] } else { found };
    };
    if !first {
        return Vec::new();
    }
    let mm =
        |quantity: Quantity| find(figures, quantity).map(|figure| if figure.unit == "m" { 1e3 * value(figure) } else { value(figure) });
    let check = match CHECKED.map(mm) {
        [Some(xy), Some(z)] => Some(measured(xy, z)),
        _ => adjusted.check_failed.as_ref().map(|_| failed),
    };
    let camera = ("camera".into(), measured(value(frame), 0.0));
    [camera].into_iter().chain(check.map(|entry| ("check points".into(), entry))).collect()
}

/// What is counted of a classifier's targets and labels, over all images.
#[derive(Default)]
struct Counts {
    targets: Option<f64>,
    labelled: Option<f64>,
    labels: Option<f64>,
    wrong: Option<f64>,
}

/// Which of the counts a figure belongs to.
type Which = fn(&mut Counts) -> &mut Option<f64>;

/// Whose count a figure is, and which; finders of boards go by the name of `board`.
fn counted(name: &FigureName) -> Option<(&str, Which)> {
    let classifier = || name.parts().first().copied().unwrap_or_default();
    Some(match name.quantity() {
        Quantity::SeenTargets => (classifier(), |counts| &mut counts.targets),
        Quantity::Labelled => (classifier(), |counts| &mut counts.labelled),
        Quantity::Labels => (classifier(), |counts| &mut counts.labels),
        Quantity::WrongLabels => (classifier(), |counts| &mut counts.wrong),
        Quantity::BoardTargets => ("board", |counts| &mut counts.targets),
        Quantity::BoardLabelled => ("board", |counts| &mut counts.labelled),
        Quantity::BoardLabels => ("board", |counts| &mut counts.labels),
        Quantity::BoardWrongLabels => ("board", |counts| &mut counts.wrong),
        _ => return None,
    })
}

/// Of each classifier the share of the targets without a right label, and of the labels that are wrong.
fn recognised(figures: &[Figure]) -> Vec<(Arc<str>, [f64; 2])> {
    let mut counts: BTreeMap<&str, Counts> = BTreeMap::new();
    for figure in figures {
        let Some((whose, count)) = counted(&figure.name) else { continue };
        let counts = counts.entry(whose).or_default();
        *count(counts).get_or_insert(0.0) += figure.value;
    }
    let shares = |(classifier, counts): (&str, Counts)| {
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 1.0 };
        let (targets, labelled) = (counts.targets?, counts.labelled?);
        let wrong = share(counts.wrong.unwrap_or(0.0), counts.labels.unwrap_or(0.0).max(1.0));
        Some((format!("recognition {classifier}").into(), [share(targets - labelled, targets), wrong]))
    };
    counts.into_iter().filter_map(shares).collect()
}

/// Every figure but the residuals of single points, each in its unit, with the digits of records: a run and its records are alike.
pub(super) fn figures(adjusted: &Calibrated) -> Vec<(FigureKey, Numbers)> {
    let figures = adjusted.outcome.iter().flatten().filter(|figure| !matches!(figure.name.group(), Group::Point | Group::Object));
    figures
        .map(|figure| {
            let recorded::Numbers { value, sigma, error } = recorded::recorded(figure);
            ((adjusted.set, figure.name.clone()), Numbers { value, sigma, error })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn calibrated(set: usize, figures: &[(Group, &str, f64)]) -> Calibrated {
        let figures =
            figures.iter().map(|(group, name, value)| Figure::plain(FigureName::parse(*group, name).unwrap(), *value, "")).collect();
        Calibrated { method: 0, set, outcome: Ok(figures), check_failed: None }
    }

    fn found(adjusted: &Calibrated) -> Vec<(String, Entry)> {
        entries(adjusted).into_iter().map(|(name, entry)| (name.to_string(), entry)).collect()
    }

    #[test]
    fn a_free_network_is_judged_by_its_sigma0_in_every_set() {
        let measured = |x: f64, y: f64| Entry::Measured(Found::bare([x, y]));
        let block = |set| calibrated(set, &[(Group::Network, "sigma0", 0.25), (Group::Network, "of them held", 7.0)]);
        assert_eq!(found(&block(0)), [("sigma0 0".to_owned(), measured(0.25, 0.0))]);
        assert_eq!(found(&block(3)), [("sigma0 3".to_owned(), measured(0.25, 0.0))]);
        let camera = |set| calibrated(set, &[(Group::Frame, "rms", 0.5), (Group::Network, "sigma0", 0.25)]);
        assert_eq!(found(&camera(0)), [("camera".to_owned(), measured(0.5, 0.0))]);
        assert!(found(&camera(1)).is_empty(), "of cameras the first set alone");
        assert!(
            found(&calibrated(1, &[(Group::Network, "sigma0", 0.25)])).is_empty(),
            "a set of which no camera is compared over the frame"
        );
    }

    #[test]
    fn a_camera_that_is_not_compared_is_a_failed_one_and_what_is_no_camera_is_none() {
        assert_eq!(found(&calibrated(0, &[(Group::Iop, "c", 18.0)])), [("camera".to_owned(), Entry::Rejected(Rejection::NotConverged))]);
        assert_eq!(found(&calibrated(0, &[(Group::Network, "from the width of 22 mm, um", 5.38)])), []);
    }

    #[test]
    fn a_recognition_is_judged_by_what_it_missed_and_mistook() {
        let n = Group::Network;
        let of = |classifier: &str, images: &str, [targets, labelled, labels, wrong]: [f64; 4]| {
            [("targets", targets), ("labelled", labelled), ("labels", labels), ("wrong labels", wrong)]
                .map(|(what, value)| (n, format!("{classifier}/{what}/{images}"), value))
        };
        let all =
            [of("modern", "a", [100.0, 90.0, 95.0, 5.0]), of("modern", "b", [100.0, 100.0, 105.0, 5.0]), of("contours", "a", [0.0; 4])];
        let figures: Vec<(Group, &str, f64)> = all.iter().flatten().map(|(group, name, value)| (*group, name.as_str(), *value)).collect();
        let measured = |x: f64, y: f64| Entry::Measured(Found::bare([x, y]));
        let expected = [("recognition contours".to_owned(), measured(1.0, 0.0)), ("recognition modern".to_owned(), measured(0.05, 0.05))];
        assert_eq!(found(&calibrated(4, &figures)), expected);
    }
}
