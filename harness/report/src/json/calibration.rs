//! A calibration as JSON.

use calibench_adjust::{Significance, Use};
use calibench_calibrate::{Calibration, Checked, Finding, Suspected, Verdict};
use calibench_exchange::station_numbers;
use calibench_model::NamedCamera;
use schemars::JsonSchema;
use serde::Serialize;

use super::board::{Board, board};
use super::compared::Set;
use super::doubted::Doubted;
use super::lengths::{Length, lengths};
use super::next::NextAnswer;
use super::own_numbers::{OwnNumber, own_numbers};
use super::{Answer, CameraAnswer};
use crate::calibration::{CORRELATED, images_of, points_by_image, warnings};

/// A calibration and its quality.
#[derive(Serialize, JsonSchema)]
pub struct CalibrationAnswer {
    /// Why the calibration is in doubt, and the exit code 3; empty where no doubt was found.
    doubts: Vec<String>,
    /// The same doubts for programs, but for those about photographs that others had before.
    doubted: Vec<Doubted>,
    /// What the inputs may be in truth, first what explains them best; empty where nothing is in doubt, or nothing explains it.
    suspected: Vec<Suspect>,
    /// What was not looked for, and why: no doubt was found there because none could be.
    untested: Vec<String>,
    /// What is to be known and is no doubt.
    warnings: Vec<String>,
    /// What fixes the object's frame, in words.
    datum: String,
    /// The bookkeeping.
    counts: Counts,
    /// A-priori standard deviation of an image coordinate, px.
    sigma_px: f64,
    /// Whether that was assumed, and not given.
    sigma_is_assumed: bool,
    /// Estimated over a-priori standard deviation of unit weight, a number; null without redundancy.
    sigma0: Option<f64>,
    /// Root mean square of the residuals in use (2D), px.
    rms_px: f64,
    /// The cameras.
    cameras: Vec<CalibratedCamera>,
    /// Distances that were measured, then lengths that were asked for.
    lengths: Vec<Length>,
    /// What each image has for itself; empty where nothing was asked for.
    per_image: Vec<OwnNumber>,
    /// Pairs of parameters whose correlation is beyond 0.9.
    correlated: Vec<Correlated>,
    /// What was looked for in the residuals.
    checks: Vec<Check>,
    /// Cameras that fit as well, as far as the noise tells.
    rivals: Vec<Rival>,
    /// The shape of a planar testfield.
    board: Board,
    /// What of the object's coordinates takes no part in the standard deviations, since nobody stated how exact it is, in words.
    taken_as_exact: Vec<String>,
    /// The images, with their exterior orientations.
    images: Vec<Image>,
    /// Image points that Baarda's test rejected.
    rejected: Vec<Rejected>,
    /// The sets of parameters that were compared.
    sets: Vec<Set>,
}

impl Answer for CalibrationAnswer {
    const COMMAND: &'static str = "calibrate";
    const SCHEMA: u32 = 1;
}

/// What an input may be in truth.
#[derive(Serialize, JsonSchema)]
struct Suspect {
    /// `lens` (a fisheye), `raster` (columns and rows of the board), `axes` (x and y of image points), `up` (y upwards), `origin` (of
    /// the pixels), `spacing` (of the tags of a board), `stretch` (of a board), `scale` (of a board among control) or `size` (of the images, cropped ones too).
    kind: &'static str,
    /// In words, with the estimate where there is one.
    what: String,
    /// What is left of the points then, px RMS; null where another sign tells.
    rms_px: Option<f64>,
}

#[derive(Serialize, JsonSchema)]
struct Counts {
    /// Images that were oriented.
    images: usize,
    /// Image points that were adjusted.
    image_points: usize,
    /// Image points that were left out or have less weight: rejected by Baarda's test or weighted by Huber.
    not_in_full: usize,
    /// Image points that take no part, being of targets that are no control and cannot be intersected.
    left_out: usize,
    /// Targets that were looked for and not measured.
    unmeasured: usize,
    /// Targets.
    targets: usize,
    /// Those of them that are control points.
    control_points: usize,
    /// Observations.
    observations: usize,
    /// Constraints of the datum.
    constraints: usize,
    /// Unknowns.
    unknowns: usize,
    /// Observations and constraints less unknowns.
    redundancy: i64,
}

#[derive(Serialize, JsonSchema)]
struct CalibratedCamera {
    /// Its name; of a single camera as well.
    name: String,
    /// Where its interior orientation started, in words.
    start: String,
    /// How many of the images are its own.
    images: usize,
    /// The camera, with the covariance of what was solved for.
    camera: CameraAnswer,
    /// How well it is known over its frame; null where it was not adjusted.
    over_frame: Option<OverFrame>,
    /// The parameters that were solved for.
    solved: Vec<Solved>,
    /// What to photograph next; null where nothing is proposed, for the reason that `why_no_next` tells.
    next: Option<NextAnswer>,
    /// Why nothing is proposed, in words; null where something is.
    why_no_next: Option<String>,
}

/// The standard deviation (2D) of the image of a point far away, root mean square over the whole frame after the best rotation.
#[derive(Serialize, JsonSchema)]
#[expect(clippy::struct_field_names, reason = "a key says its unit")]
struct OverFrame {
    /// As the covariance of the adjustment has it, px; null where that cannot be said.
    formal_px: Option<f64>,
    /// From leaving groups of images out (the jackknife), px; null where that could not be done.
    by_images_px: Option<f64>,
    /// If the larger of the two is beyond this, the camera is in doubt, px.
    limit_px: f64,
}

#[derive(Serialize, JsonSchema)]
struct Solved {
    /// The parameter.
    parameter: String,
    /// Standard deviation, in its unit.
    sigma: f64,
    /// The same from leaving groups of images out (the jackknife); null where that could not be done.
    sigma_by_images: Option<f64>,
    /// Its value over its standard deviation; null where it was not tested.
    t: Option<f64>,
    /// Probability of as large a value by chance, if it is zero.
    p: Option<f64>,
    /// Coefficients that the images do not determine are held near zero by a prior that nobody asked for.
    held: bool,
}

#[derive(Serialize, JsonSchema)]
struct Correlated {
    /// One parameter; with its camera's name, if there are several.
    a: String,
    /// The other one.
    b: String,
    /// Their correlation, -1 to 1.
    rho: f64,
}

#[derive(Serialize, JsonSchema)]
struct Check {
    /// What was looked for.
    what: String,
    /// `sound`, `slight` (a structure that does not matter), `doubt` or `untested`.
    verdict: &'static str,
    /// Probability of residuals as uneven by chance.
    p: Option<f64>,
    /// By how many of its standard deviations over the frame the camera moves when the structure is allowed for.
    moves: Option<f64>,
    /// The most likely cause, or why it was not tested.
    cause: Option<String>,
}

#[derive(Serialize, JsonSchema)]
struct Rival {
    /// The name of the calibrated camera.
    camera: String,
    /// The other minimum.
    other: CameraAnswer,
    /// How far it is from the one found over the frame after the best rotation, px RMS; null where they cannot be compared.
    distance_px: Option<f64>,
    /// Where it was reached from, in words.
    origin: String,
}

#[derive(Serialize, JsonSchema)]
struct Image {
    /// Its name.
    name: String,
    /// The name of its camera.
    camera: String,
    /// Image points that were adjusted.
    points: usize,
    /// Root mean square of its residuals (2D), px; null without any in use.
    rms_px: Option<f64>,
    /// X0, Y0, Z0: the projection centre, object units.
    centre: [f64; 3],
    /// Their standard deviations.
    centre_sigma: [f64; 3],
    /// omega, phi, kappa, degrees.
    angles_deg: [f64; 3],
}

#[derive(Serialize, JsonSchema)]
struct Rejected {
    /// Name of the image.
    image: String,
    /// Name of the target.
    target: String,
    /// Normalised residual.
    w: f64,
    /// Beyond which one is rejected.
    critical: f64,
    /// Whether it was left out; if not, the network needs it, or too many were left out.
    left_out: bool,
}

impl CalibrationAnswer {
    /// Of a calibration, with doubts about its photographs that others had before, and what its inputs are suspected to be.
    ///
    /// # Errors
    /// A covariance that is none, in words.
    pub fn new(calibration: &Calibration<'_>, before: &[String], suspected: &[Suspected]) -> Result<Self, String> {
        let (prepared, solution) = (calibration.prepared, &calibration.solution);
        let found = calibration.doubts();
        let doubts: Vec<String> = before.iter().cloned().chain(found.iter().map(ToString::to_string)).collect();
        let name = |index: usize| calibration.parameter_name(&calibration.covariances.parameters[index]);
        let pairs = calibration.covariances.correlated(CORRELATED);
        let tests = calibration.significance();
        Ok(Self {
            doubts,
            doubted: found.iter().map(|doubt| Doubted::new(calibration, doubt)).collect(),
            suspected: suspected.iter().map(|one| Suspect { kind: one.kind, what: one.what.clone(), rms_px: one.rms_px }).collect(),
            untested: calibration.checked.iter().filter_map(Checked::untested).collect(),
            warnings: warnings(calibration),
            datum: prepared.settings.datum.words(),
            counts: counts(calibration),
            sigma_px: prepared.settings.sigma(),
            sigma_is_assumed: prepared.settings.sigma_px.is_none(),
            sigma0: solution.sigma0(),
            rms_px: calibration.rms_px(),
            cameras: (0..calibration.cameras()).map(|index| camera(calibration, index, &tests)).collect::<Result<_, _>>()?,
            lengths: lengths(calibration)?,
            per_image: own_numbers(calibration),
            correlated: pairs.iter().map(|found| Correlated { a: name(found.pair[0]), b: name(found.pair[1]), rho: found.rho }).collect(),
            checks: calibration.checked.iter().map(check).collect(),
            rivals: prepared.rivals.iter().map(|rival| self::rival(calibration, rival)).collect(),
            board: board(calibration),
            taken_as_exact: calibration.taken_as_exact(),
            images: images(calibration),
            rejected: rejected(calibration),
            sets: calibration.compared.iter().flat_map(|compared| &compared.sets).map(Set::new).collect(),
        })
    }
}

fn counts(calibration: &Calibration<'_>) -> Counts {
    let (prepared, solution) = (calibration.prepared, &calibration.solution);
    let counts = solution.counts();
    Counts {
        images: solution.poses().len(),
        image_points: prepared.network.observations.len(),
        not_in_full: solution.each_residual().filter(|residual| residual.used != Use::Full).count(),
        left_out: prepared.left_out.len(),
        unmeasured: prepared.unmeasured.len(),
        targets: prepared.network.points.len(),
        control_points: prepared.survey.control_points(),
        observations: counts.observations() - counts.constraints,
        constraints: counts.constraints,
        unknowns: counts.unknowns,
        redundancy: counts.redundancy(),
    }
}

fn camera(calibration: &Calibration<'_>, index: usize, tests: &[Significance]) -> Result<CalibratedCamera, String> {
    let prepared = calibration.prepared;
    let (names, covariance) = calibration.covariances.of_camera(index);
    let by_images = calibration.resampled.as_ref().and_then(|found| found.as_ref().ok());
    let solved = |(place, name): (usize, &&'static str)| {
        let test = tests.iter().find(|test| test.camera == index && test.parameter == *name);
        let row = calibration.covariances.parameters.iter().position(|known| *known == (index, *name));
        Solved {
            parameter: (*name).to_owned(),
            sigma: covariance[(place, place)].sqrt(),
            sigma_by_images: by_images.zip(row).map(|(found, row)| found.sigmas[row]),
            t: test.map(|test| test.t),
            p: test.map(|test| test.p),
            held: prepared.held.contains(&calibration.parameter_name(&(index, name))),
        }
    };
    let (next, why_no_next) = match calibration.next(index) {
        Ok(next) => (Some(NextAnswer::new(&next)), None),
        Err(why) => (None, Some(why)),
    };
    Ok(CalibratedCamera {
        name: calibration.name_of(index).to_owned(),
        start: prepared.origins.get(index).cloned().unwrap_or_default(),
        images: images_of(calibration, index).count(),
        over_frame: calibration.over_frame.get(index).copied().flatten().map(|known| OverFrame {
            formal_px: Some(known.formal_px).filter(|px| px.is_finite()),
            by_images_px: known.by_images_px.filter(|px| px.is_finite()),
            limit_px: known.limit_px,
        }),
        camera: CameraAnswer::new(&calibration.named_camera(index)?),
        solved: names.iter().enumerate().map(solved).collect(),
        next,
        why_no_next,
    })
}

fn check(checked: &Checked) -> Check {
    let (verdict, finding, cause): (_, Option<&Finding>, _) = match &checked.verdict {
        Verdict::Untested(why) => ("untested", None, Some(why)),
        Verdict::Sound(finding) => ("sound", Some(finding), None),
        Verdict::Slight(finding, cause) => ("slight", Some(finding), Some(cause)),
        Verdict::Doubt(finding, cause) => ("doubt", Some(finding), Some(cause)),
    };
    Check {
        what: checked.subject.what().to_owned(),
        verdict,
        p: finding.map(|finding| finding.p),
        moves: finding.and_then(|finding| finding.moves),
        cause: cause.cloned(),
    }
}

fn rival(calibration: &Calibration<'_>, rival: &calibench_calibrate::Rival) -> Rival {
    Rival {
        camera: calibration.name_of(rival.camera).to_owned(),
        other: CameraAnswer::new(&NamedCamera::new("", rival.other)),
        distance_px: rival.distance_px,
        origin: rival.origin.clone(),
    }
}

fn images(calibration: &Calibration<'_>) -> Vec<Image> {
    let (points, rms) = (points_by_image(calibration), calibration.solution.rms_by_image());
    let image = |(index, name): (usize, &String)| {
        let [x, y, z, omega, phi, kappa] = station_numbers(&calibration.solution.poses()[index]);
        let covariance = &calibration.covariances.poses[index];
        Image {
            name: name.clone(),
            camera: calibration.name_of(calibration.owner(index)).to_owned(),
            points: points[index],
            rms_px: rms[index],
            centre: [x, y, z],
            centre_sigma: [0, 1, 2].map(|i| covariance[(i, i)].max(0.0).sqrt()),
            angles_deg: [omega, phi, kappa],
        }
    };
    calibration.prepared.survey.images.iter().enumerate().map(image).collect()
}

fn rejected(calibration: &Calibration<'_>) -> Vec<Rejected> {
    let prepared = calibration.prepared;
    let one = |found: &calibench_adjust::Found| {
        let sight = prepared.survey.sight(prepared.sights[found.observation] as usize);
        Rejected {
            image: prepared.survey.images[sight.image].clone(),
            target: prepared.survey.target(sight.target).to_owned(),
            w: found.w,
            critical: found.critical,
            left_out: found.left_out,
        }
    };
    calibration.found.iter().map(one).collect()
}
