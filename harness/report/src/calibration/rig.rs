//! A calibrated rig as a summary for a terminal.

use std::fmt::Write;

use calibench_calibrate::few;
use calibench_calibrate::rig::RigCalibration;
use calibench_model::camera::CameraModel;

use nalgebra::{Rotation3, UnitQuaternion};

use super::digits::rounded;
use crate::markdown::{MarkdownTable, plain};

/// The summary of a rig: the bookkeeping, residuals by camera, where each camera sits, the interiors, and what is in doubt.
pub fn rig_summary(found: &RigCalibration<'_>) -> String {
    let mut text: String = found.doubts.iter().map(|doubt| format!("in doubt: {}\n", doubt.words)).collect();
    if !text.is_empty() {
        text.push('\n');
    }
    facts(found).iter().for_each(|line| {
        let _ = writeln!(text, "{line}");
    });
    let _ = write!(
        text,
        "\n{}\nmounts: the projection centre in the axes of {} (x right, y down, z forward), units of the control; rotations about each camera's own axes, degrees; standard deviations {}\n{}",
        cameras(found).render(),
        found.origin(),
        sigmas(found),
        mounts(found).render()
    );
    for camera in 0..found.solution.cameras().len() {
        if !found.covariances.of_camera(camera).0.is_empty() {
            let _ = write!(text, "\ninterior orientation of {}\n{}", found.name_of(camera), parameters(found, camera).render());
        }
    }
    text
}

fn sigmas(found: &RigCalibration<'_>) -> String {
    match &found.by_sets {
        Ok(sets) => {
            format!("with the estimated variance factor, `by sets` from leaving out each of {} groups of moments (jackknife)", sets.groups)
        }
        Err(why) => format!("with the estimated variance factor, none from leaving moments out: {why}"),
    }
}

fn facts(found: &RigCalibration<'_>) -> Vec<String> {
    let (prepared, solution) = (found.prepared, &found.solution);
    let (network, counts) = (&prepared.rig.network, solution.counts());
    let names: Vec<String> = prepared.alone().into_iter().map(str::to_owned).collect();
    let mut lines = vec![format!(
        "a rig of {} cameras at {} moments, {} images, {} image points; its frame is that of {}",
        network.cameras.len(),
        prepared.rig.stations.len(),
        network.images.len(),
        network.observations.len(),
        found.origin()
    )];
    if let Some(spread) = prepared.moments.spread {
        lines.push(format!(
            "images of a moment were taken within {} s (median; largest {}, allowed {})",
            plain(spread.median_s),
            plain(spread.largest_s),
            plain(spread.tolerance_s)
        ));
    }
    if !names.is_empty() {
        lines.push(format!("without a partner: {} ({})", few(&names), names.len()));
    }
    lines.extend(prepared.left_out_words());
    let left_out = found.found.iter().filter(|found| found.left_out).count();
    if left_out > 0 {
        lines.push(format!("gross errors: {left_out} image points were left out"));
    }
    lines.extend(prepared.origins.iter().enumerate().map(|(camera, origin)| format!("start of {}: {origin}", found.name_of(camera))));
    let sigma0 = solution.sigma0().map_or_else(|| "none".into(), plain);
    lines.push(format!(
        "{} unknowns, redundancy {}, cost {}, sigma0 {sigma0}",
        counts.unknowns,
        counts.redundancy(),
        cost(solution.cost())
    ));
    lines.push(format!("residuals {} px RMS", plain(found.rms_px())));
    lines.push(match &found.one_rig {
        Ok(test) => format!(
            "one rig: against images with poses of their own F({}, {}) = {:.3}, p {:.2e}; sigma0 {} in place of {} ({:.1} % of the variance)",
            test.freedom[0],
            test.freedom[1],
            test.f,
            test.p,
            plain(test.sigma0[1]),
            plain(test.sigma0[0]),
            100.0 * test.explains
        ),
        Err(why) => format!("one rig: not tested, {why}"),
    });
    if let Some(held) = &found.held {
        let far = held.moves.iter().copied().fold(0.0, f64::max);
        lines.push(format!(
            "with the cameras held as their files say: cost {}, p {:.2e}; a camera sits up to {} away",
            cost(held.cost),
            held.p,
            plain(far)
        ));
    }
    lines
}

/// A sum of squares as far as others may print it.
fn cost(value: f64) -> String {
    if value < 1.0 { plain(value) } else { format!("{value:.4}") }
}

fn cameras(found: &RigCalibration<'_>) -> MarkdownTable {
    let mut table = MarkdownTable::new(&["camera", "model", "images", "points", "RMS px", "over frame px", "by sets px"]);
    for (camera, own) in found.by_camera().iter().enumerate() {
        let known = found.over_frame.get(camera).copied().flatten();
        let px = |px: Option<f64>| px.map_or_else(String::new, plain);
        table.row([
            found.name_of(camera).to_owned(),
            found.solution.cameras()[camera].convention().name.to_owned(),
            own.images.to_string(),
            own.points.to_string(),
            plain(own.rms_px),
            known.map_or_else(|| "fixed".into(), |known| plain(known.formal_px)),
            px(known.and_then(|known| known.by_images_px)),
        ]);
    }
    table
}

fn mounts(found: &RigCalibration<'_>) -> MarkdownTable {
    let mut table = MarkdownTable::new(&["camera", "what", "value", "sigma", "by sets"]);
    let (origin, sign) = (found.prepared.rig.origin, [1.0, -1.0, -1.0]);
    for camera in (0..found.solution.cameras().len()).filter(|&camera| camera != origin) {
        let mount = found.covariances.mount(camera);
        let sets = found.by_sets.as_ref().ok().map(|sets| &sets.cameras[camera].mount);
        let mut row = |what: &str, value: f64, sigma: f64, own: Option<f64>| {
            let (value, sigma) = rounded(value, sigma);
            table.row([
                found.name_of(camera).to_owned(),
                what.to_owned(),
                value,
                sigma,
                own.map_or_else(String::new, |own| rounded(0.0, own).1),
            ]);
        };
        for (axis, what) in ["X", "Y", "Z"].into_iter().enumerate() {
            row(what, sign[axis] * mount.pose.centre[axis], mount.centre_sigmas()[axis], sets.map(|sets| sets.centre_sigmas()[axis]));
        }
        let (distance, sigma) = mount.distance();
        row("distance", distance, sigma, sets.map(|sets| sets.distance().1));
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(mount.pose.rotation)).scaled_axis();
        for (axis, what) in ["rotation x", "rotation y", "rotation z"].into_iter().enumerate() {
            let own = sets.map(|sets| sets.rotation_sigmas()[axis].to_degrees());
            row(what, (sign[axis] * turn[axis]).to_degrees(), mount.rotation_sigmas()[axis].to_degrees(), own);
        }
    }
    table
}

fn parameters(found: &RigCalibration<'_>, camera: usize) -> MarkdownTable {
    let (names, covariance) = found.covariances.of_camera(camera);
    let mut table = MarkdownTable::new(&["parameter", "value", "sigma", "by sets", "unit"]);
    for parameter in found.solution.cameras()[camera].parameters() {
        let solved = names.iter().position(|name| *name == parameter.name);
        let (value, sigma) = match solved {
            Some(i) => rounded(parameter.value, covariance[(i, i)].sqrt()),
            None => (parameter.value.to_string(), "fixed".into()),
        };
        let row = found.covariances.parameters.iter().position(|known| *known == (camera, parameter.name));
        let sets = row.zip(found.by_sets.as_ref().ok()).map(|(row, sets)| rounded(0.0, sets.parameters[(row, row)].sqrt()).1);
        table.row([parameter.name.to_owned(), value, sigma, sets.unwrap_or_default(), parameter.unit.to_owned()]);
    }
    table
}
