//! Why a calibrated rig is in doubt.

use calibench_adjust::Mount;
use nalgebra::DMatrix;

use super::calibration::RigCalibration;
use super::doubted::{RigDoubt, RigSubject};

/// Probability of a finding by chance, below which it is none.
const ALPHA: f64 = 1e-4;
/// Share of the variance that the images set free explain, from which it matters.
const EXPLAINS: f64 = 0.1;
/// Standard deviations by leaving sets out, as many times the formal ones, that are no chance.
const TIMES: f64 = 3.0;
/// Standard deviation of the place of a camera, as a share of its distance from the origin, beyond which it is hardly known.
const SHARE: f64 = 0.01;
/// How many times smaller it would be with the interiors known, for these to be the reason.
const BY_INTERIORS: f64 = 2.0;
/// Share of the image points that may be left out.
const LEFT_OUT: f64 = 0.4;

/// All doubts about a calibration.
pub(super) fn doubts(calibration: &RigCalibration<'_>) -> Vec<RigDoubt> {
    let cameras = 0..calibration.solution.mounts().len();
    let mut found: Vec<RigDoubt> = one_rig(calibration).into_iter().collect();
    found.extend(gross(calibration));
    found.extend(files(calibration));
    for camera in cameras {
        found.extend(over_frame(calibration, camera));
        found.extend(mount(calibration, camera));
        found.extend(together(calibration, camera));
    }
    found
}

fn one_rig(calibration: &RigCalibration<'_>) -> Option<RigDoubt> {
    let test = calibration.one_rig.as_ref().ok()?;
    if test.p >= ALPHA || test.explains < EXPLAINS || test.sigma0[0] < 1e-5 {
        return None;
    }
    let worst: Vec<String> = test.worst.iter().map(|(name, [rig, own])| format!("{name} ({rig:.2} px, alone {own:.2})")).collect();
    let words = format!(
        "the cameras are not one rig that images of one moment see at once: with a pose of its own each image fits better than chance allows (F {:.2}, p {:.1e}; sigma0 {:.3} in place of {:.3}), most of all {}. A camera moved, images are not of one moment, or the cameras are not as adjusted",
        test.f,
        test.p,
        test.sigma0[1],
        test.sigma0[0],
        worst.join(", ")
    );
    Some(RigDoubt { subject: RigSubject::OneRig, camera: None, words })
}

fn gross(calibration: &RigCalibration<'_>) -> Option<RigDoubt> {
    let (left_out, all) =
        (calibration.found.iter().filter(|found| found.left_out).count(), calibration.prepared.rig.network.observations.len());
    (left_out as f64 > LEFT_OUT * all as f64).then(|| {
        let words = format!("gross errors: {left_out} of {all} image points were left out, and what is left need not be the right part");
        RigDoubt { subject: RigSubject::GrossErrors, camera: None, words }
    })
}

fn files(calibration: &RigCalibration<'_>) -> Option<RigDoubt> {
    let held = calibration.held.as_ref()?;
    let sigma = |camera: usize| worst_sigma(calibration, camera);
    let far = (0..held.moves.len())
        .filter(|&camera| held.moves[camera] > TIMES * sigma(camera))
        .max_by(|&a, &b| held.moves[a].total_cmp(&held.moves[b]))?;
    (held.p < ALPHA).then(|| {
        let words = format!(
            "with the cameras held as their files say {} sits {} away from here, {:.1} standard deviations, and that fits worse than chance allows (p {:.1e}): the files are not of these images, or the interiors are hardly determined here",
            calibration.name_of(far),
            number(held.moves[far]),
            held.moves[far] / sigma(far).max(f64::MIN_POSITIVE),
            held.p
        );
        RigDoubt { subject: RigSubject::Files, camera: Some(far), words }
    })
}

fn over_frame(calibration: &RigCalibration<'_>, camera: usize) -> Option<RigDoubt> {
    let known = calibration.over_frame[camera].filter(|known| !known.is_within())?;
    let words = format!(
        "{} is known to {} px over the frame (standard deviation, RMS), beyond the limit of {} px: more images with points near its borders, fewer parameters (--solve), or its own calibration (--start and --solve none)",
        calibration.name_of(camera),
        number(known.px()),
        number(known.limit_px)
    );
    Some(RigDoubt { subject: RigSubject::OverFrame, camera: Some(camera), words })
}

/// Where a camera sits is hardly known: by which unknowns.
fn mount(calibration: &RigCalibration<'_>, camera: usize) -> Option<RigDoubt> {
    let mount = calibration.covariances.mount(camera);
    let (distance, sigma) = (mount.distance().0, worst_sigma(calibration, camera));
    if distance == 0.0 || sigma <= SHARE * distance {
        return None;
    }
    let known = with_known_interiors(calibration, camera)?;
    let [formal, held] = [largest(&mount), largest(&Mount { covariance: known, ..mount })];
    let why = if formal > BY_INTERIORS * held {
        format!(
            "with known interiors it would be {}: give the cameras' own calibrations (--start and --solve none, or --prior)",
            number(held * sigma / formal)
        )
    } else {
        "more moments at which both see the points, from other directions, would tell".to_owned()
    };
    let words = format!(
        "the place of {} is known to {} (standard deviation of its worst coordinate), {:.1} % of its distance of {} from {}; {why}",
        calibration.name_of(camera),
        number(sigma),
        100.0 * sigma / distance,
        number(distance),
        calibration.origin()
    );
    Some(RigDoubt { subject: RigSubject::Mount, camera: Some(camera), words })
}

fn together(calibration: &RigCalibration<'_>, camera: usize) -> Option<RigDoubt> {
    let sets = calibration.by_sets.as_ref().ok()?;
    let formal = largest(&calibration.covariances.mount(camera));
    let times = largest(&sets.cameras[camera].mount) / formal;
    (formal > 0.0 && times > TIMES).then(|| {
        let words = format!(
            "leaving sets out moves {} {times:.1} times as much as its standard deviations say: errors of a set belong together, as where images are not of one moment, the rig bends or the board is not flat",
            calibration.name_of(camera)
        );
        RigDoubt { subject: RigSubject::Together, camera: Some(camera), words }
    })
}

/// The largest standard deviation of a coordinate of its place.
fn largest(mount: &Mount) -> f64 {
    mount.centre_sigmas().into_iter().fold(0.0, f64::max)
}

/// The larger of the formal one and that by leaving sets out.
fn worst_sigma(calibration: &RigCalibration<'_>, camera: usize) -> f64 {
    let own = largest(&calibration.covariances.mount(camera));
    calibration.by_sets.as_ref().map_or(own, |sets| own.max(largest(&sets.cameras[camera].mount)))
}

/// The covariance of a mount if all interiors were known.
fn with_known_interiors(calibration: &RigCalibration<'_>, camera: usize) -> Option<nalgebra::Matrix6<f64>> {
    let covariances = &calibration.covariances;
    let width = covariances.parameters.len();
    let first = covariances.first_of_mount(camera)?;
    let all = covariances.kept.fixed_view::<6, 6>(first, first).into_owned();
    if width == 0 {
        return Some(all);
    }
    let scale: Vec<f64> = (0..width).map(|k| covariances.kept[(k, k)].max(f64::MIN_POSITIVE).sqrt()).collect();
    let interior = DMatrix::from_fn(width, width, |i, j| covariances.kept[(i, j)] / (scale[i] * scale[j]));
    let cross = DMatrix::from_fn(width, 6, |i, j| covariances.kept[(i, first + j)] / scale[i]);
    let solved = interior.cholesky()?.solve(&cross);
    let taken = cross.tr_mul(&solved);
    Some(nalgebra::Matrix6::from_fn(|i, j| all[(i, j)] - taken[(i, j)]))
}

/// A number to two or three digits.
fn number(value: f64) -> String {
    if !value.is_finite() {
        return "nothing that could be said".into();
    }
    let digits = if value == 0.0 { 0.0 } else { (1.0 - value.abs().log10().floor()).clamp(0.0, 9.0) };
    format!("{value:.*}", digits as usize)
}
