//! The first page: what was calibrated, how, and the parameters.

use super::table::{self, Column, Side};
use super::{DOUBT, LEFT, NOTE, PALE, RIGHT, RULE, SMALL, TEXT, TITLE, Told, board, bounded, fact, number, paragraph, section, title};
use crate::answer::{Calibrated, Parameter};
use crate::digits::{three, with_uncertainty};
use crate::document::{GREY, Paper, SIZE, Style};
use crate::record::{Equipment, Role};

/// Where the fields to be signed begin.
const SIGNED: f64 = SIZE[1] - 140.0;
/// Height of a row of parameters at least, points.
const LEAST_ROW: f64 = 9.4;
/// Parameters that are listed at most, and doubts.
const MOST_PARAMETERS: usize = 24;
const MOST_DOUBTS: usize = 3;

pub(super) fn write(paper: &mut Paper, told: &Told<'_>) {
    let in_doubt = !told.doubts.is_empty();
    let colour = if in_doubt { DOUBT } else { TITLE };
    paper.fill([LEFT, 44.0], [4.0, 36.0], colour);
    paper.write([LEFT + 13.0, 62.0], Style::bold(19.0).coloured(colour), title(in_doubt));
    paper.write([LEFT + 13.0, 76.0], Style::grey(8.5), "Interior orientation of a camera with its uncertainty");
    paper.write_before([RIGHT, 58.0], NOTE, "number");
    paper.write_before([RIGHT, 71.0], Style::bold(9.5), &number(told.digest));
    let y = if in_doubt { doubts(paper, told.doubts) } else { 106.0 };
    let Some(calibrated) = told.answer.cameras.get(told.certificate.camera) else { return };
    let y = section(paper, y, 1, "What was calibrated");
    let y = what(paper, y, told, calibrated);
    let y = section(paper, y + 10.0, 2, "How");
    let y = how(paper, y, told);
    let y = section(paper, y + 10.0, 3, "Parameters");
    let y = parameters(paper, y, told, calibrated);
    let y = section(paper, y + 10.0, 4, "Board and control");
    board::write(paper, y, told);
    signed(paper, told);
}

/// A box that cannot be overlooked.
fn doubts(paper: &mut Paper, doubts: &[String]) -> f64 {
    let style = Style::plain(8.0);
    let width = RIGHT - LEFT - 20.0;
    let shown: Vec<&String> = doubts.iter().take(MOST_DOUBTS).collect();
    let lines: usize = shown.iter().map(|doubt| paper.lines(doubt, style, width).len().min(2)).sum();
    let more = doubts.len() - shown.len();
    let height = 19.0 + 10.5 * (lines + usize::from(more > 0)) as f64;
    paper.fill([LEFT, 90.0], [RIGHT - LEFT, height], PALE);
    paper.fill([LEFT, 90.0], [2.0, height], DOUBT);
    paper.write(
        [LEFT + 10.0, 102.0],
        Style::bold(8.5).coloured(DOUBT),
        "This calibration is in doubt. Do not rely on it before the cause is known.",
    );
    let mut y = 113.0;
    for doubt in shown {
        y = bounded(paper, [LEFT + 10.0, y], (style, width, 10.5), doubt, 2);
    }
    if more > 0 {
        paper.write([LEFT + 10.0, y], style, &format!("and {more} more: section 8"));
    }
    90.0 + height + 20.0
}

fn what(paper: &mut Paper, y: f64, told: &Told<'_>, calibrated: &Calibrated) -> f64 {
    let (fields, record) = (&told.certificate.fields, &told.certificate.record);
    let equipment = record.cameras.get(told.certificate.camera).map_or(&[][..], |camera| &camera.equipment);
    let name = if told.answer.cameras.len() > 1 { format!("{} \u{2014} ", calibrated.name) } else { String::new() };
    let camera = said(fields.camera.as_deref(), equipment, |one| with_serial(one.camera.as_deref(), one.serial.as_deref()));
    let mut y = fact(paper, y, "Camera", &format!("{name}{camera}"));
    y = fact(
        paper,
        y,
        "Lens",
        &said(fields.lens.as_deref(), equipment, |one| with_serial(one.lens.as_deref(), one.lens_serial.as_deref())),
    );
    let setting = |one: &Equipment| {
        let focal = one.focal_mm.map(|mm| format!("{mm} mm"));
        let aperture = one.f_number.map(|number| format!("f/{number}"));
        let all: Vec<String> = focal.into_iter().chain(aperture).collect();
        (!all.is_empty()).then(|| all.join(", "))
    };
    y = fact(paper, y, "Focal length, aperture", &said(None, equipment, setting));
    let size = &calibrated.camera.size;
    let pitch = calibrated.camera.pitch_um.map_or("pixel pitch not stated".into(), |um| format!("pixel pitch {um} \u{b5}m"));
    y = fact(paper, y, "Images", &format!("{} \u{d7} {} px, {pitch}", size.width, size.height));
    let first = equipment.iter().filter_map(|one| one.first.as_deref()).min();
    let last = equipment.iter().filter_map(|one| one.last.as_deref()).max();
    let dates = first.zip(last).map_or("not stated in the photographs".to_owned(), |(first, last)| format!("{first} to {last} (EXIF)"));
    fact(paper, y, "Photographed", &dates)
}

fn with_serial(name: Option<&str>, serial: Option<&str>) -> Option<String> {
    let serial = serial.map(|serial| format!("serial number {serial}"));
    let all: Vec<String> = name.map(str::to_owned).into_iter().chain(serial).collect();
    (!all.is_empty()).then(|| all.join(", "))
}

/// What the user says, and what the photographs say.
fn said(user: Option<&str>, equipment: &[Equipment], of: impl Fn(&Equipment) -> Option<String>) -> String {
    let mut found: Vec<(String, usize)> = Vec::new();
    for one in equipment {
        let Some(words) = of(one) else { continue };
        match found.iter_mut().find(|(known, _)| *known == words) {
            Some((_, count)) => *count += one.photographs,
            None => found.push((words, one.photographs)),
        }
    }
    let alone = found.len() == 1;
    let exif: Vec<String> = found
        .iter()
        .map(|(words, count)| if alone { format!("{words} (EXIF)") } else { format!("{words} (EXIF of {count} photographs)") })
        .collect();
    let user = user.map(|user| format!("{user} (as stated)"));
    let all: Vec<String> = user.into_iter().chain(exif).collect();
    if all.is_empty() { "not stated".into() } else { all.join("; ") }
}

fn how(paper: &mut Paper, y: f64, told: &Told<'_>) -> f64 {
    let (record, answer) = (&told.certificate.record, told.answer);
    let counts = &answer.counts;
    let object = match &record.board {
        Some(board) => format!("board {board}"),
        None => format!("{} targets, {} of them control points", counts.targets, counts.control_points),
    };
    let mut y = fact(paper, y, "Object", &object);
    let photographs = record.files.iter().filter(|file| file.role == Role::Photograph).count();
    let given = if photographs > 0 {
        format!("{photographs} photographs given, {} used", counts.images)
    } else {
        format!("{} images", counts.images)
    };
    let method = record.method.as_ref().map_or(String::new(), |method| format!(", measured by {method}"));
    y = fact(paper, y, "Image points", &format!("{} in {given}{method}; {} not in full", counts.image_points, counts.not_in_full));
    let redundancy = format!("{} observations, {} unknowns, redundancy {}", counts.observations, counts.unknowns, counts.redundancy);
    y = fact(paper, y, "Adjustment", &format!("bundle adjustment; {redundancy}; {}", answer.datum));
    let known = if answer.sigma_is_assumed { "assumed" } else { "given" };
    let unit = answer.sigma0.map_or("no redundancy".to_owned(), |sigma0| {
        let px = three(sigma0 * answer.sigma_px);
        format!("\u{3c3}0 {} for {} px ({known}): {px} px for an image coordinate", three(sigma0), answer.sigma_px)
    });
    fact(paper, y, "Fit", &format!("residuals {} px RMS; {unit}", three(answer.rms_px)))
}

fn parameters(paper: &mut Paper, y: f64, told: &Told<'_>, calibrated: &Calibrated) -> f64 {
    let k = told.budget.k;
    let expanded = format!("U (k = {k:.2})");
    let columns: [Column<'_>; 7] = [
        ("parameter", Side::Left, LEFT, 62.0),
        ("value", Side::Right, LEFT + 150.0, 84.0),
        ("u", Side::Right, LEFT + 208.0, 54.0),
        ("u by images", Side::Right, LEFT + 270.0, 54.0),
        (&expanded, Side::Right, LEFT + 336.0, 60.0),
        ("unit", Side::Left, LEFT + 348.0, 40.0),
        ("most correlated with", Side::Left, LEFT + 396.0, RIGHT - LEFT - 396.0),
    ];
    paper.write([LEFT, y], TEXT, &format!("Model {}", calibrated.camera.convention));
    let begin = y + 14.0;
    let all = &calibrated.camera.parameters;
    // What was adjusted comes before what is fixed, where there is not room for all.
    let space = SIGNED - 118.0 - begin;
    let room = MOST_PARAMETERS.min((space / LEAST_ROW).max(1.0) as usize);
    let shown: Vec<&Parameter> =
        if all.len() > room { all.iter().filter(|one| one.sigma.is_some()).take(room).collect() } else { all.iter().collect() };
    let height = (space / shown.len().max(1) as f64).clamp(LEAST_ROW, 12.0);
    let style = if height < 11.0 { SMALL } else { Style::plain(8.0) };
    let mut y = table::head(paper, begin, &columns, ([LEFT, RIGHT], height));
    for parameter in &shown {
        y = table::row(paper, y, &columns, (style, height), &cells(calibrated, parameter, k));
    }
    if shown.len() < all.len() {
        let left = all.len() - shown.len();
        y = paragraph(paper, y, NOTE, &format!("and {left} more, of which each stands in the attached record"), 1);
    }
    paper.line([LEFT, y - height + 3.0], [RIGHT, y - height + 3.0], (0.5, RULE));
    let note = "u: standard uncertainty of the adjustment; by images: as leaving groups of images out shows it; U: expanded uncertainty, k times the larger \
                of the two. All correlations stand in the attached record.";
    y = paragraph(paper, y + 2.0, NOTE, note, 2);
    paragraph(paper, y + 4.0, TEXT, &over_frame(calibrated), 2)
}

fn cells(calibrated: &Calibrated, parameter: &Parameter, k: f64) -> [String; 7] {
    let own = calibrated.solved.iter().find(|solved| solved.parameter == parameter.name);
    let Some(sigma) = parameter.sigma.filter(|_| own.is_some()) else {
        let [name, value, unit] = [parameter.name.clone(), parameter.value.to_string(), parameter.unit.clone()];
        return [name, value, "fixed".into(), String::new(), String::new(), unit, String::new()];
    };
    let by_images = own.and_then(|own| own.sigma_by_images);
    let (value, u) = with_uncertainty(parameter.value, sigma);
    let shown = by_images.map_or("-".into(), |sigma| with_uncertainty(0.0, sigma).1);
    let expanded = with_uncertainty(0.0, k * by_images.map_or(sigma, |own| own.max(sigma))).1;
    let most = calibrated.camera.covariance.as_ref().and_then(|covariance| covariance.most(&parameter.name));
    let most = most.map_or(String::new(), |(other, rho)| format!("{other}: {rho:+.3}"));
    [parameter.name.clone(), value, u, shown, expanded, parameter.unit.clone(), most]
}

fn over_frame(calibrated: &Calibrated) -> String {
    let Some(over) = calibrated.over_frame else { return "The interior orientation was not adjusted.".into() };
    let formal = over.formal_px.map_or("not known".into(), |px| format!("{} px", three(px)));
    let by_images = over.by_images_px.map_or("not known".into(), |px| format!("{} px", three(px)));
    format!(
        "Over the frame the image of a point far away is known to {formal} (standard uncertainty, RMS), by leaving images out: {by_images}. Beyond {} px a calibration is in \
         doubt.",
        three(over.limit_px)
    )
}

/// What a person fills in.
fn signed(paper: &mut Paper, told: &Told<'_>) {
    let fields = &told.certificate.fields;
    let width = (RIGHT - LEFT - 36.0) / 4.0;
    let all = [("Issued by", &fields.by), ("Place", &fields.place), ("Date", &fields.date), ("Signature", &None)];
    for (index, (name, value)) in all.into_iter().enumerate() {
        let x = LEFT + index as f64 * (width + 12.0);
        if let Some(value) = value {
            let style = Style::plain(9.0);
            let lines = paper.lines(value, style, width);
            let y = SIGNED + 24.0 - 11.0 * (lines.len().min(2) - 1) as f64;
            bounded(paper, [x, y], (style, width, 11.0), value, 2);
        }
        paper.line([x, SIGNED + 28.0], [x + width, SIGNED + 28.0], (0.6, GREY));
        paper.write([x, SIGNED + 37.0], NOTE, name);
    }
}
