//! Reading `[free_network]` and `[rig]`.

use calibench_diagnostics::Problem;
use calibench_measure::Configured;
use calibench_model::Pose;
use nalgebra::Point3;

use super::wire::{DistanceWire, FreeNetworkWire, MountWire, RigWire};
use super::{Bar, Kind, Mount, Networks};
use crate::section::Section;
use crate::studies::acceptance::read_lengths;
use crate::studies::{Seen, check_model, places};

/// Lengths that are looked at if the scenario does not say how many.
const LENGTHS: usize = 10;

/// Reads a free network of `views`, whose methods are `methods`: its table, its distances, what it must keep.
pub fn read_free(
    (section, listed, acceptance): (Section<'_>, Vec<Section<'_>>, Option<Section<'_>>),
    views: &Seen<'_>,
    methods: &[Configured],
    problems: &mut Vec<Problem>,
) -> Option<Networks> {
    let (before, span) = (problems.len(), section.span.clone());
    let targets: Vec<&str> = views.field.targets.iter().map(|target| target.id.as_str()).collect();
    let distances: Vec<Bar> = listed.into_iter().filter_map(|section| distance(section, &targets, problems)).collect();
    let needs_scale = acceptance.as_ref().filter(|_| distances.is_empty()).map(|section| section.span.clone());
    problems
        .extend(needs_scale.map(|span| Problem::new(span, "[acceptance] without a [[distance]]: nothing tells the scale of its lengths")));
    let acceptance = acceptance.and_then(|section| read_lengths(section, views.field, problems));
    let wire: FreeNetworkWire = section.read(&[], problems)?;
    check_model(&wire.model, problems);
    let count = wire.lengths.map(|count| count.0);
    if distances.is_empty() && count.is_some_and(|count| count > 0) {
        problems.push(Problem::new(span, "`lengths` without a [[distance]]: nothing tells the scale, expected 0 or a [[distance]]"));
    }
    let count = if distances.is_empty() { 0 } else { count.unwrap_or(LENGTHS) };
    (problems.len() == before).then(|| Networks {
        model: wire.model.into_inner(),
        sigma_px: wire.sigma_px.map_or(wire.noise_px.0, |sigma| sigma.0),
        drawn: drawn(methods, wire.noise_px.0),
        kind: Kind::Free { lengths: lengths(count, targets.len(), &distances), distances, acceptance },
    })
}

/// Reads a rig.
pub fn read_rig(section: Section<'_>, listed: Vec<Section<'_>>, methods: &[Configured], problems: &mut Vec<Problem>) -> Option<Networks> {
    let (before, span) = (problems.len(), section.span.clone());
    let mut mounts: Vec<Mount> = Vec::new();
    for section in listed {
        mounts.extend(mount(section, &mounts, problems));
    }
    let wire: RigWire = section.read(&[], problems)?;
    check_model(&wire.model, problems);
    if problems.len() == before && mounts.len() < 2 {
        problems.push(Problem::new(span, format!("[rig] with {} [[mount]]: expected two at least", mounts.len())));
    }
    (problems.len() == before).then(|| Networks {
        model: wire.model.into_inner(),
        sigma_px: wire.sigma_px.map_or(wire.noise_px.0, |sigma| sigma.0),
        drawn: drawn(methods, wire.noise_px.0),
        kind: Kind::Rig(mounts),
    })
}

fn drawn(methods: &[Configured], noise_px: f64) -> Vec<(String, Option<f64>)> {
    methods.iter().map(|method| (method.label.clone(), Some(noise_px))).collect()
}

fn distance(section: Section<'_>, targets: &[&str], problems: &mut Vec<Problem>) -> Option<Bar> {
    let before = problems.len();
    let wire: DistanceWire = section.read(&[], problems)?;
    let found = places("target", wire.between.get_ref(), targets, problems);
    if problems.len() > before {
        return None;
    }
    let count = found.len();
    let two = found.try_into().map(|between| Bar { between, sigma: wire.sigma.0 });
    two.map_err(|_| problems.push(Problem::new(wire.between.span(), format!("`between` is a list of {count}: expected two targets")))).ok()
}

fn mount(section: Section<'_>, earlier: &[Mount], problems: &mut Vec<Problem>) -> Option<Mount> {
    let before = problems.len();
    let wire: MountWire = section.read(&[], problems)?;
    let name = wire.name.get_ref();
    // The names of images begin with it.
    if name.is_empty() || !name.chars().all(|c| c.is_alphanumeric() || c == '_') {
        problems.push(Problem::new(wire.name.span(), format!("`{name}` is no name of a mount: expected letters, digits and _")));
    }
    if earlier.iter().any(|other| other.name == *name) {
        problems.push(Problem::new(wire.name.span(), format!("the mount `{name}` is listed twice: expected each once")));
    }
    let zero = || [0.0; 3];
    let (at, angles) = (wire.at.map_or_else(zero, |at| at.0), wire.angles.map_or_else(zero, |angles| angles.0.map(f64::to_radians)));
    (problems.len() == before).then(|| Mount { name: wire.name.into_inner(), pose: Pose::from_angles(Point3::from(at), angles) })
}

/// Pairs of targets that lie far from each other in the list, and are not measured.
fn lengths(count: usize, targets: usize, distances: &[Bar]) -> Vec<[usize; 2]> {
    let far = |i: usize| [i, (i + targets / 2) % targets];
    let is_measured = |pair: &[usize; 2]| distances.iter().any(|bar| bar.between == *pair || bar.between == [pair[1], pair[0]]);
    (0..targets / 2).map(far).filter(|pair| !is_measured(pair)).take(count).collect()
}
