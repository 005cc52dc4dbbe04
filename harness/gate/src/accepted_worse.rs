//! What a new blessing would accept for the worse.

use std::collections::BTreeMap;

use calibench_records::statistics::paired::mean;

use super::ceilings::CeilingMetric;
use super::point_entry::Coordinates;
use super::table::{MethodTable, Table};
use super::{TOLERANCE, missing};

/// A line for each statistic that gets worse when `new` replaces `old`: points that disappear; per method the root mean square,
/// the largest error, the shares of lost and rejected points; per target the magnitude of the mean error (px). Not a test:
/// with another seed about half of the statistics are a little worse by chance.
pub fn worse_than(old: &Table, new: &Table) -> Vec<String> {
    let gone = missing::completeness(old, new).into_iter().filter(super::Finding::fails);
    let mut lines: Vec<String> =
        gone.map(|f| [Some(f.method), f.target, Some(f.message)].into_iter().flatten().collect::<Vec<_>>().join(": ")).collect();
    for (label, base) in old.methods() {
        let Some(now) = new.method(label).filter(|now| now.unavailable.is_none()) else { continue };
        lines.extend(grown(label, &figures(old, base), &figures(new, now)));
        if old.coordinates == Coordinates::Positions {
            lines.extend(moved(label, base, now));
        }
    }
    lines
}

type Figures = BTreeMap<String, f64>;

fn grown(label: &str, old: &Figures, new: &Figures) -> Vec<String> {
    let both = old.iter().filter_map(|(name, a)| Some((name, *a, *new.get(name)?)));
    both.filter(|(_, a, b)| b - a > TOLERANCE).map(|(name, a, b)| format!("{label}: {name} {a:.6} -> {b:.6} (+{:.6})", b - a)).collect()
}

fn figures(table: &Table, method: &MethodTable) -> Figures {
    use CeilingMetric::{LostShare, MaxError, RejectedShare, RmseXy};
    let of = |metric: CeilingMetric| Some((metric.name().to_owned(), metric.figure(table.coordinates, method)?));
    let mut figures: Figures = [RmseXy, MaxError, LostShare, RejectedShare].into_iter().filter_map(of).collect();
    if table.coordinates == Coordinates::Errors {
        figures.extend(mean_errors(method));
    }
    figures
}

/// The magnitude of each target's mean error, px, over the points that are not lost.
fn mean_errors(method: &MethodTable) -> Figures {
    let mut targets: BTreeMap<String, Vec<[f64; 2]>> = BTreeMap::new();
    for (place, entry) in &method.points {
        if let Some(error) = entry.kept() {
            targets.entry(format!("{}/{}: |mean error|", place.view, place.target)).or_default().push(error);
        }
    }
    let axis = |errors: &[[f64; 2]], axis: usize| mean(&errors.iter().map(|error| error[axis]).collect::<Vec<f64>>());
    targets.into_iter().map(|(name, errors)| (name, axis(&errors, 0).hypot(axis(&errors, 1)))).collect()
}

fn moved(label: &str, base: &MethodTable, now: &MethodTable) -> Option<String> {
    let distance = |place, [x, y]: [f64; 2]| now.points.get(place)?.kept().map(|[u, v]| (u - x).hypot(v - y));
    let distances = base.points.iter().filter_map(|(place, entry)| distance(place, entry.kept()?));
    let moved: Vec<f64> = distances.filter(|distance| *distance > TOLERANCE).collect();
    let most = moved.iter().copied().fold(0.0, f64::max);
    (!moved.is_empty()).then(|| format!("{label}: {} points moved, by up to {most:.6} px", moved.len()))
}
