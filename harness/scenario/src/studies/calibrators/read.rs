//! Reading `[calibrators]` and `[[calibrator]]`.

use calibench_calibrate::MODELS;
use calibench_diagnostics::Problem;
use calibench_measure::Configured;

use super::wire::{CalibratorWire, CalibratorsWire, FaultsWire};
use super::{Calibrators, Faults};
use crate::section::Section;

/// Reads the tables; `methods` are those of the scenario.
pub fn read(
    mut section: Section<'_>,
    listed: Vec<Section<'_>>,
    methods: &[Configured],
    problems: &mut Vec<Problem>,
) -> Option<Calibrators> {
    let (before, span) = (problems.len(), section.span.clone());
    let faults = section.take_table("faults", "[calibrators.faults]", problems);
    let wire: Option<CalibratorsWire> = section.read(&["faults"], problems);
    let faults = faults.map_or_else(|| Some(Faults::default()), |section| read_faults(section, problems));
    if listed.is_empty() {
        problems.push(Problem::new(span, "[calibrators] without a [[calibrator]]: expected at least one".to_owned()));
    }
    let mut names: Vec<String> = Vec::new();
    for section in listed {
        let Some(CalibratorWire { name }) = section.read(&[], problems) else { continue };
        if names.contains(name.get_ref()) {
            problems.push(Problem::new(name.span(), format!("the calibrator `{}` is listed twice: expected each once", name.get_ref())));
        }
        names.push(name.into_inner());
    }
    let (wire, faults) = (wire?, faults?);
    let model = wire.model.get_ref();
    if !MODELS.contains(&model.as_str()) {
        let message = format!("`{model}` is no camera model: expected one of {}", MODELS.join(", "));
        problems.push(Problem::new(wire.model.span(), message).nearest(model, MODELS));
    }
    // Of a rendered image the true pose of its rows and a second camera would have to be rendered too.
    if wire.noise_px.is_none() && (faults.shutter != 0.0 || faults.other_c != 1.0) {
        let message = "`shutter` and `other_c` of [calibrators.faults] are for coordinates that are drawn: expected `noise_px`";
        problems.push(Problem::new(wire.model.span(), message.to_owned()));
    }
    let noise = wire.noise_px.map(|noise| noise.0);
    let drawn = noise.map(|noise| methods.iter().map(|method| (method.label.clone(), Some(noise))).collect());
    (problems.len() == before).then(|| Calibrators {
        model: wire.model.into_inner(),
        sigma_px: wire.sigma_px.map(|sigma| sigma.0),
        drawn,
        start_f: wire.start_f.0,
        distance: wire.distance.0,
        faults,
        names,
    })
}

fn read_faults(section: Section<'_>, problems: &mut Vec<Problem>) -> Option<Faults> {
    let span = section.span.clone();
    let wire: FaultsWire = section.read(&[], problems)?;
    let usual = Faults::default();
    let gross_px = wire.gross_px.map_or(usual.gross_px, |[from, to]| [from.0, to.0]);
    if gross_px[0] > gross_px[1] {
        problems
            .push(Problem::new(span, format!("`gross_px` goes from {} to {}: expected the smaller one first", gross_px[0], gross_px[1])));
        return None;
    }
    Some(Faults {
        gross: wire.gross.map_or(usual.gross, |share| share.0),
        gross_px,
        exchanged: wire.exchanged.map_or(usual.exchanged, |share| share.0),
        told_scale: wire.told_scale.map_or(usual.told_scale, |factor| factor.0),
        shutter: wire.shutter.map_or(usual.shutter, |length| length.0),
        other_c: wire.other_c.map_or(usual.other_c, |factor| factor.0),
    })
}
