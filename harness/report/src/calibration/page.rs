//! The page about a calibration, and its summary for a terminal.

use std::fmt::Write;
use std::io;

use calibench_adjust::Precision;
use calibench_calibrate::Calibration;
use calibench_files::NewFolder;
use calibench_model::camera::CameraModel;
use calibench_model::escape;

use super::digits::rounded;
use super::html;
use super::next::NextSection;
use super::uncertainty::{self, UncertaintyMap};
use super::warnings::warnings;
use super::{board, checks, discs, figures, images_of, known, lengths, measured_board, own_numbers, sets_page, tables};
use crate::canvas::write_pictures;
use crate::corners::Pictured;
use crate::html::Figures;
use crate::markdown::MarkdownTable;
use crate::plot::Figure;
use crate::{Canvas, plain};

/// Images and rejected points that a page names one by one.
const MOST: usize = 200;

/// Writes the page, its pictures, its tables and the page as one file into `folder`. Of `photos` the parts where residuals are longest are enlarged there;
/// `doubts` are what is in doubt of where a board was found in them.
///
/// # Errors
/// What the file system refuses.
pub fn write_report(calibration: &Calibration<'_>, photos: &[Pictured<'_>], doubts: &[String], folder: &NewFolder) -> io::Result<()> {
    let maps: Vec<Vec<UncertaintyMap>> = (0..calibration.cameras()).map(|camera| uncertainty::maps(calibration, camera)).collect();
    tables::write(calibration, &maps, folder)?;
    known::write(calibration, doubts, folder)?;
    let headline = checks::headline(calibration).map_or_else(String::new, |headline| format!("**{}**\n\n", escape::markdown(&headline)));
    let before: String = doubts.iter().map(|doubt| format!("**In doubt**: {}.\n\n", escape::markdown(doubt))).collect();
    let warnings: String = warnings(calibration).iter().map(|warning| format!("\n**{}**\n", escape::markdown(warning))).collect();
    let corners = figures::corners(calibration);
    let drawn = figures::figures(calibration, &maps, &corners);
    let next = NextSection::of(calibration);
    let mut pictures: Vec<(String, Canvas)> = drawn.all().chain(&next.figures).map(|figure| (figure.file(), figure.picture())).collect();
    let mut in_place: Figures = drawn.all().chain(&next.figures).map(|figure| (figure.file(), figure.html())).collect();
    let mut shown: Vec<(String, String)> = drawn.first.iter().map(|figure| (figure.caption.clone(), figure.file())).collect();
    for camera in 0..calibration.cameras() {
        for (file, caption, canvas) in figures::panels(calibration, camera, &corners) {
            // In the page it is the figure of all images that shows one of them.
            in_place.insert(file.clone(), String::new());
            shown.push((caption, file.clone()));
            pictures.push((file, canvas));
        }
    }
    write_pictures(folder, &pictures)?;
    let (head, rest) = (facts_and_parameters(calibration), rest(calibration, (&shown, &drawn.distortion), &next.text));
    let text = format!("# Calibration\n\n{before}{headline}{head}{warnings}{rest}");
    folder.write("README.md", |file| file.write_all(text.as_bytes()))?;
    // Doubts and warnings are at its head.
    let page = html::page(calibration, (&format!("{head}{rest}"), in_place), &corners, (photos, doubts));
    folder.write("report.html", |file| file.write_all(page.as_bytes()))
}

fn facts_and_parameters(calibration: &Calibration<'_>) -> String {
    let mut text = format!("{}\n", facts(calibration));
    for camera in 0..calibration.cameras() {
        let _ = write!(text, "{}## Interior orientation{}\n\n", if camera > 0 { "\n" } else { "" }, calibration.of(camera));
        text.push_str(&parameters(calibration, camera).render());
    }
    text + &format!("\nStandard deviations {}; {}.\n", scaled(calibration), by_images(calibration))
}

/// What comes below the warnings.
fn rest(calibration: &Calibration<'_>, (pictures, distortion): (&[(String, String)], &[Option<Figure>]), next: &str) -> String {
    let mut text = lengths::section(calibration) + &checks::section(calibration);
    if let Some(compared) = &calibration.compared {
        let _ = write!(text, "\n## Sets of parameters\n\n{}", sets_page::section(compared));
    }
    text.push_str("\n## Residuals, correlations, uncertainty\n");
    for (caption, file) in pictures {
        let _ = write!(text, "\n![{caption}]({file})\n\n{caption}\n");
    }
    for (camera, figure) in distortion.iter().enumerate() {
        if let Some(figure) = figure {
            let (of, caption, file) = (calibration.of(camera), &figure.caption, figure.file());
            let _ = write!(text, "\n## Distortion{of}\n\n![{caption}]({file})\n\n{caption}\n");
        }
    }
    text.push_str(next);
    text.push_str(&images(calibration));
    text.push_str(&own_numbers::section(calibration));
    text.push_str(&rejected(calibration));
    text.push_str(
        "\n## Tables\n\n`residuals.csv` (every image point given, with redundancy numbers, normalised residuals and minimal detectable biases; \
         targets that a method rejected included), `parameters.csv`, `correlations.csv`, `stations.csv` (poses), `points.csv` (object points), of a \
         board `board.csv` (its bend) and, where it was measured, `board-corners.csv`, of lengths `distances.csv`, of what images have for themselves `per-image.csv`; `uncertainty.csv` (the maps' numbers, px); `cameras.json` (the cameras with \
         their covariances, for `calibench task`).\n",
    );
    text
}

/// What a user reads first: the parameters with their standard deviations and what is wrong with them.
pub fn summary(calibration: &Calibration<'_>) -> String {
    let headline = checks::headline(calibration).map_or_else(String::new, |headline| format!("{headline}\n\n"));
    let mut text = headline + &facts(calibration).replace("- ", "");
    for camera in 0..calibration.cameras() {
        let name = calibration.of(camera);
        let _ = write!(
            text,
            "\n{}{}",
            if name.is_empty() { String::new() } else { format!("interior orientation{name}\n") },
            parameters(calibration, camera).render()
        );
    }
    text.push_str(&lengths::section(calibration).replace("## Lengths", "lengths"));
    text.push_str(&warnings(calibration).iter().map(|warning| format!("warning: {warning}\n")).collect::<String>());
    if let Some(compared) = &calibration.compared {
        let _ = write!(text, "\n{}", sets_page::section(compared));
    }
    text
}

fn scaled(calibration: &Calibration<'_>) -> &'static str {
    if calibration.solution.counts().redundancy() > 0 {
        "with the estimated variance factor"
    } else {
        "with the a-priori variance factor: there is no redundancy"
    }
}

/// What the column of standard deviations by images is.
fn by_images(calibration: &Calibration<'_>) -> String {
    match &calibration.resampled {
        Some(Ok(found)) => format!("`by images` from leaving out each of {} groups of images (jackknife)", found.groups),
        Some(Err(why)) => format!("none from leaving images out: {why}"),
        None => "none from leaving images out".into(),
    }
}

/// The bookkeeping, a line each.
fn facts(calibration: &Calibration<'_>) -> String {
    let (prepared, solution) = (calibration.prepared, &calibration.solution);
    let settings = &prepared.settings;
    let counts = solution.counts();
    let control = prepared.survey.control_points().min(prepared.network.points.len());
    let models = (0..calibration.cameras()).map(|camera| {
        let (name, model) = (calibration.of(camera), calibration.camera(camera).convention().name);
        let images = if name.is_empty() { String::new() } else { format!(", {} images", images_of(calibration, camera).count()) };
        format!("camera model{name}: {model}{images}")
    });
    let mut lines: Vec<String> = (0..calibration.cameras()).filter_map(|camera| over_frame(calibration, camera)).chain(models).collect();
    lines.extend([
        format!(
            "{} images, {} image points, {control} of {} targets {}",
            solution.poses().len(),
            prepared.network.observations.len(),
            prepared.network.points.len(),
            if settings.datum.is_minimal() { "start from coordinates, none is held" } else { "are control points" }
        ),
        format!("datum: {}", settings.datum.words()),
    ]);
    lines.extend(prepared.origins.iter().enumerate().map(|(camera, origin)| format!("start{}: {origin}", calibration.of(camera))));
    lines.extend([
        format!(
            "{} observations, {} constraints, {} unknowns, redundancy {}",
            counts.observations() - counts.constraints,
            counts.constraints,
            counts.unknowns,
            counts.redundancy()
        ),
        format!("residuals {} px RMS", plain(calibration.rms_px())),
    ]);
    lines.extend(board::fact(calibration));
    lines.extend(measured_board::facts(calibration));
    lines.extend(discs::fact(calibration));
    lines.extend(observed(calibration));
    lines.extend(own_numbers::facts(calibration));
    if let Some(sigma0) = solution.sigma0() {
        lines.push(unit_weight(calibration, sigma0));
    }
    lines.extend(checks::fact(calibration));
    lines.iter().map(|line| format!("- {line}\n")).collect()
}

/// How well a camera is known, which is what decides whether it may be used.
fn over_frame(calibration: &Calibration<'_>, camera: usize) -> Option<String> {
    let known = calibration.over_frame.get(camera).copied().flatten()?;
    let by_images = known.by_images_px.map_or_else(String::new, |px| format!(", by leaving images out {} px", plain(px)));
    Some(format!(
        "known{} to {} px over the frame (standard deviation, RMS{by_images}; in doubt beyond {} px)",
        calibration.of(camera),
        plain(known.formal_px),
        plain(known.limit_px)
    ))
}

/// What sigma0 says of the precision of image coordinates.
fn unit_weight(calibration: &Calibration<'_>, sigma0: f64) -> String {
    let settings = &calibration.prepared.settings;
    let sigma = settings.sigma();
    let known = if settings.sigma_px.is_some() { "given" } else { "assumed" };
    let observations = &calibration.prepared.network.observations;
    let own = observations.iter().filter(|o| matches!(o.precision, Precision::Covariance(_))).count();
    if own > 0 {
        let rest = observations.len() - own;
        let rest = if rest > 0 { format!(", and for {sigma} px ({known}) of the {rest} others") } else { String::new() };
        return format!(
            "sigma0 {0} for the covariances of {own} image points{rest}: they are {0} times as imprecise as stated",
            plain(sigma0)
        );
    }
    format!(
        "sigma0 {} for a standard deviation of {sigma} px ({known}): {} px for an image coordinate",
        plain(sigma0),
        plain(sigma0 * sigma)
    )
}

/// What was observed beside image points and control.
fn observed(calibration: &Calibration<'_>) -> Option<String> {
    let settings = &calibration.prepared.settings;
    let prior = |(camera, prior): (usize, &calibench_calibrate::Prior)| {
        format!("{}{} = {} \u{b1} {}", prior.parameter, calibration.of(camera), prior.value, prior.sigma)
    };
    let parameters = settings.cameras.iter().enumerate().flat_map(|(camera, optics)| optics.priors.iter().map(move |one| (camera, one)));
    let parameters = parameters.map(prior);
    let (centres, rotations) = settings
        .stations
        .iter()
        .fold((0, 0), |(c, r), row| (c + usize::from(row.centre.is_some()), r + usize::from(row.rotation.is_some())));
    let counted = [(centres, "projection centres"), (rotations, "rotations")];
    let poses = counted.into_iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}"));
    let all: Vec<String> = parameters.chain(poses).collect();
    (!all.is_empty()).then(|| format!("observed as well: {}", all.join(", ")))
}

fn parameters(calibration: &Calibration<'_>, camera: usize) -> MarkdownTable {
    let (names, covariance) = calibration.covariances.of_camera(camera);
    let tests = calibration.significance();
    let resampled = calibration.resampled.as_ref().and_then(|resampled| resampled.as_ref().ok());
    let mut table = MarkdownTable::new(&["parameter", "value", "sigma", "by images", "unit", "t", "p"]);
    for parameter in calibration.camera(camera).parameters() {
        let solved = names.iter().position(|name| *name == parameter.name);
        let (value, sigma) = match solved {
            Some(i) => rounded(parameter.value, covariance[(i, i)].sqrt()),
            None => (parameter.value.to_string(), "fixed".into()),
        };
        let test = tests.iter().find(|test| test.camera == camera && test.parameter == parameter.name);
        let test = test.map_or_else(|| [String::new(), String::new()], |test| [format!("{:.1}", test.t), format!("{:.3}", test.p)]);
        let [t, p] = test;
        let row = calibration.covariances.parameters.iter().position(|known| *known == (camera, parameter.name));
        let by_images = row.and_then(|row| resampled?.sigmas.get(row)).map_or(String::new(), |own| rounded(0.0, *own).1);
        table.row([parameter.name.to_owned(), value, sigma, by_images, parameter.unit.to_owned(), t, p]);
    }
    table
}

fn images(calibration: &Calibration<'_>) -> String {
    let several = calibration.cameras() > 1;
    let columns = ["image", "camera", "points", "RMS px", "X0", "Y0", "Z0", "omega", "phi", "kappa"];
    let shown = |index: usize| several || index != 1;
    let columns: Vec<&str> = columns.into_iter().enumerate().filter(|(index, _)| shown(*index)).map(|(_, name)| name).collect();
    let mut table = MarkdownTable::new(&columns);
    let rms = calibration.solution.rms_by_image();
    let (names, counts) = (&calibration.prepared.survey.images, super::points_by_image(calibration));
    for (index, name) in names.iter().enumerate().take(MOST) {
        let points = counts[index];
        let numbers = calibench_exchange::station_numbers(&calibration.solution.poses()[index]);
        let [sx, sy, sz] = [0, 1, 2].map(|i| calibration.covariances.poses[index][(i, i)].max(0.0).sqrt());
        let centre = [(numbers[0], sx), (numbers[1], sy), (numbers[2], sz)].map(|(value, sigma)| {
            let (value, sigma) = rounded(value, sigma);
            format!("{value} \u{b1} {sigma}")
        });
        let angles = numbers[3..].iter().map(|angle| format!("{angle:.4}\u{b0}"));
        let camera = several.then(|| escape::markdown(calibration.name_of(calibration.owner(index))).into_owned());
        let row = [points.to_string(), rms[index].map_or(String::new(), plain)];
        table.row([escape::markdown(name).into_owned()].into_iter().chain(camera).chain(row).chain(centre).chain(angles));
    }
    let more = if names.len() > MOST { format!("\nThe first {MOST} of {} images.\n", names.len()) } else { String::new() };
    format!("\n## Images\n\n{}{more}", table.render())
}

fn rejected(calibration: &Calibration<'_>) -> String {
    if calibration.found.is_empty() {
        return String::new();
    }
    let prepared = calibration.prepared;
    let mut table = MarkdownTable::new(&["image", "target", "normalised residual", "critical", "left out"]);
    for found in calibration.found.iter().take(MOST) {
        let sight = prepared.survey.sight(prepared.sights[found.observation] as usize);
        let names = [&prepared.survey.images[sight.image], prepared.survey.target(sight.target)];
        let names = names.map(|name| escape::markdown(name).into_owned());
        let verdict = if found.left_out { "yes" } else { "no" };
        table.row(names.into_iter().chain([format!("{:.2}", found.w), format!("{:.2}", found.critical), verdict.to_owned()]));
    }
    format!("\n## Rejected image points\n\n{}", table.render())
}
