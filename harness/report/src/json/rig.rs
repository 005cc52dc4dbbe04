//! A calibrated rig as JSON.

use calibench_adjust::Mount;
use calibench_calibrate::rig::RigCalibration;
use calibench_model::named_camera::PoseFrame;
use nalgebra::{Matrix3, Matrix6};
use schemars::JsonSchema;
use serde::Serialize;

use super::{Answer, CameraAnswer};

/// Cameras that are mounted rigidly to each other. Axes of cameras are x right, y down, z forward; lengths are in the units of the control.
#[derive(Serialize, JsonSchema)]
pub struct RigAnswer {
    /// Why the result is in doubt, and the exit code 3; empty where no doubt was found.
    doubts: Vec<String>,
    /// The same doubts for programs.
    doubted: Vec<RigDoubted>,
    /// The camera whose frame is that of the rig.
    origin: String,
    /// Moments at which the rig took images.
    moments: usize,
    /// How far apart the images of a moment were taken; null where they were paired by name.
    spread: Option<TimeSpread>,
    /// Images that no other camera took with them.
    alone: Vec<String>,
    /// Images that take no part, with the reason.
    left_out: Vec<LeftOutImage>,
    /// Images that take part.
    images: usize,
    /// Image points of them.
    image_points: usize,
    /// Image points that were rejected: image, target, by how many standard deviations, and whether they were left out.
    rejected: Vec<RejectedPoint>,
    /// Unknowns of the adjustment.
    unknowns: usize,
    /// Observations less unknowns.
    redundancy: i64,
    /// A-priori standard deviation of an image coordinate, px.
    sigma_px: f64,
    /// Estimated over a-priori standard deviation of unit weight, a number; null without redundancy.
    sigma0: Option<f64>,
    /// Weighted sum of squared residuals, a number.
    cost: f64,
    /// Root mean square of the residuals in use (2D), px.
    rms_px: f64,
    /// The cameras, in the order of the rig.
    cameras: Vec<RigCamera>,
    /// Whether they are one rig: the test against the images set free; null where it could not be made.
    one_rig: Option<OneRigAnswer>,
    /// Why it could not be made; null where it was.
    one_rig_untested: Option<String>,
    /// The same with the cameras held as their files say; null where none were given or none was adjusted.
    held: Option<HeldAnswer>,
    /// Where the rig stood at each moment.
    stations: Vec<StationAnswer>,
}

impl Answer for RigAnswer {
    const COMMAND: &'static str = "calibrate-rig";
    const SCHEMA: u32 = 1;
}

#[derive(Serialize, JsonSchema)]
struct RigDoubted {
    /// `one-rig`, `over-frame`, `mount`, `together`, `files` or `gross-errors`.
    subject: &'static str,
    /// The camera; null where it is about all.
    camera: Option<String>,
    /// In words.
    words: String,
}

#[derive(Serialize, JsonSchema)]
#[expect(clippy::struct_field_names, reason = "a key says its unit")]
struct TimeSpread {
    /// The median of the moments, s.
    median_s: f64,
    /// The largest, s.
    largest_s: f64,
    /// What was allowed, s.
    tolerance_s: f64,
}

#[derive(Serialize, JsonSchema)]
struct LeftOutImage {
    /// Its name.
    image: String,
    /// The reason.
    why: String,
}

#[derive(Serialize, JsonSchema)]
struct RejectedPoint {
    /// The image.
    image: String,
    /// The target.
    target: String,
    /// Its normalised residual, a number.
    w: f64,
    /// Whether it was left out.
    left_out: bool,
}

#[derive(Serialize, JsonSchema)]
struct RigCamera {
    /// Its name.
    name: String,
    /// Where its interior orientation started, in words.
    start: String,
    /// Its images that take part.
    images: usize,
    /// Its image points in use.
    image_points: usize,
    /// Root mean square of their residuals (2D), px.
    rms_px: f64,
    /// The camera, with the covariance of what was solved for.
    camera: CameraAnswer,
    /// The standard deviation (2D) of the image of a point far away, RMS over the frame, px; null where it is not adjusted or cannot be said.
    over_frame_px: Option<f64>,
    /// The same by leaving sets out, px; null where it is not adjusted or that could not be done.
    over_frame_by_sets_px: Option<f64>,
    /// Where it sits.
    mount: MountAnswer,
}

#[derive(Serialize, JsonSchema)]
struct MountAnswer {
    /// From the axes of the origin's camera to its own, 3 x 3, row by row.
    rotation: [[f64; 3]; 3],
    /// Of a point in the axes of the origin's camera, in its own: X' = rotation X + translation.
    translation: [f64; 3],
    /// Its projection centre in the axes of the origin's camera.
    position: [f64; 3],
    /// Of the position.
    sigma_position: [f64; 3],
    /// Of the translation.
    sigma_translation: [f64; 3],
    /// About its own axes, degrees.
    sigma_rotation_deg: [f64; 3],
    /// From the origin's projection centre.
    distance: f64,
    /// Of the distance.
    sigma_distance: f64,
    /// Covariance of a small rotation about its own axes, radians, and of the position: 6 x 6, row by row.
    covariance: Vec<[f64; 6]>,
    /// The standard deviations by leaving sets out; null where that could not be done.
    by_sets: Option<BySetsAnswer>,
}

#[derive(Serialize, JsonSchema)]
struct BySetsAnswer {
    /// Groups of sets, each of which was left out once.
    groups: usize,
    /// Of the position.
    sigma_position: [f64; 3],
    /// About its own axes, degrees.
    sigma_rotation_deg: [f64; 3],
    /// Of the distance.
    sigma_distance: f64,
}

#[derive(Serialize, JsonSchema)]
struct OneRigAnswer {
    /// Fisher's F, a number.
    f: f64,
    /// Its degrees of freedom.
    freedom: [usize; 2],
    /// Probability of one as large by chance.
    p: f64,
    /// Standard deviation of unit weight of the rig, and of the images set free, numbers.
    sigma0: [f64; 2],
    /// Share of the variance of unit weight that goes when the images are set free, 0 to 1.
    explains: f64,
    /// Images without points enough for a pose of their own, which were left out of both.
    too_few: usize,
    /// The images that the rig fits least against their own pose.
    worst: Vec<WorstImage>,
}

#[derive(Serialize, JsonSchema)]
struct WorstImage {
    /// Its name.
    image: String,
    /// RMS of its residuals (2D) with the rig, px.
    rms_px: f64,
    /// The same with a pose of its own, px.
    rms_alone_px: f64,
}

#[derive(Serialize, JsonSchema)]
struct HeldAnswer {
    /// Weighted sum of squared residuals, a number.
    cost: f64,
    /// Probability of so much more where the files are right.
    p: f64,
    /// Of each camera, how far from its place on the adjusted rig.
    moves: Vec<f64>,
}

#[derive(Serialize, JsonSchema)]
struct StationAnswer {
    /// Its name.
    name: String,
    /// From the axes of the control to those of the origin's camera, 3 x 3, row by row.
    rotation: [[f64; 3]; 3],
    /// Its projection centre among the control.
    position: [f64; 3],
}

/// y and z are reversed.
const SIGN: [f64; 3] = [1.0, -1.0, -1.0];

fn rows(rotation: &Matrix3<f64>, right: [f64; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| SIGN[i] * rotation[(i, j)] * right[j]))
}

fn of(mount: &Mount, by_sets: Option<BySetsAnswer>) -> MountAnswer {
    let pose = &mount.pose;
    let t = -(pose.rotation * pose.centre.coords);
    let (distance, sigma_distance) = mount.distance();
    let flip = Matrix3::from_diagonal(&SIGN.into());
    let mut by = Matrix6::zeros();
    by.fixed_view_mut::<3, 3>(0, 0).copy_from(&flip);
    by.fixed_view_mut::<3, 3>(3, 3).copy_from(&(-flip * pose.rotation.transpose()));
    let covariance = by * mount.covariance * by.transpose();
    MountAnswer {
        rotation: rows(&pose.rotation, SIGN),
        translation: [0, 1, 2].map(|i| SIGN[i] * t[i]),
        position: [0, 1, 2].map(|i| SIGN[i] * pose.centre[i]),
        sigma_position: mount.centre_sigmas(),
        sigma_translation: mount.translation_sigmas(),
        sigma_rotation_deg: mount.rotation_sigmas().map(f64::to_degrees),
        distance,
        sigma_distance,
        covariance: (0..6).map(|i| std::array::from_fn(|j| covariance[(i, j)])).collect(),
        by_sets,
    }
}

impl RigAnswer {
    /// Of a calibrated rig, with doubts that were had before.
    ///
    /// # Errors
    /// A covariance that is not one, in words.
    pub fn new(found: &RigCalibration<'_>, before: &[String]) -> Result<Self, String> {
        let (prepared, solution) = (found.prepared, &found.solution);
        let network = &prepared.rig.network;
        let (named, by_camera) = (found.named_cameras()?, found.by_camera());
        let finite = |px: f64| px.is_finite().then_some(px);
        let camera = |index: usize| {
            let mut own = named[index].clone();
            // The mount says it.
            (own.pose, own.pose_frame) = (None, PoseFrame::World);
            let by_sets = found.by_sets.as_ref().ok().map(|sets| {
                let mount = &sets.cameras[index].mount;
                BySetsAnswer {
                    groups: sets.groups,
                    sigma_position: mount.centre_sigmas(),
                    sigma_rotation_deg: mount.rotation_sigmas().map(f64::to_degrees),
                    sigma_distance: mount.distance().1,
                }
            });
            let known = found.over_frame.get(index).copied().flatten();
            RigCamera {
                name: found.name_of(index).to_owned(),
                start: prepared.origins[index].clone(),
                images: by_camera[index].images,
                image_points: by_camera[index].points,
                rms_px: by_camera[index].rms_px,
                camera: CameraAnswer::new(&own),
                over_frame_px: known.and_then(|known| finite(known.formal_px)),
                over_frame_by_sets_px: known.and_then(|known| finite(known.by_images_px?)),
                mount: of(&found.covariances.relative(prepared.rig.origin, index), by_sets),
            }
        };
        let rejected = found.found.iter().map(|one| {
            let o = &network.observations[one.observation];
            let (image, target) = (network.images[o.image].name.clone(), network.points[o.point].name.clone());
            RejectedPoint { image, target, w: one.w, left_out: one.left_out }
        });
        let station = |(station, pose): (&calibench_adjust::Station, &calibench_model::Pose)| StationAnswer {
            name: station.name.clone(),
            rotation: rows(&pose.rotation, [1.0; 3]),
            position: pose.centre.into(),
        };
        let doubted = found.doubts.iter().map(|doubt| RigDoubted {
            subject: doubt.subject.name(),
            camera: doubt.camera.map(|camera| found.name_of(camera).to_owned()),
            words: doubt.words.clone(),
        });
        Ok(Self {
            doubts: before.iter().cloned().chain(found.doubts.iter().map(|doubt| doubt.words.clone())).collect(),
            doubted: doubted.collect(),
            origin: found.origin().to_owned(),
            moments: prepared.rig.stations.len(),
            spread: prepared.moments.spread.map(|spread| TimeSpread {
                median_s: spread.median_s,
                largest_s: spread.largest_s,
                tolerance_s: spread.tolerance_s,
            }),
            alone: prepared.alone().into_iter().map(str::to_owned).collect(),
            left_out: prepared.left_out.iter().map(|(image, why)| LeftOutImage { image: image.clone(), why: why.clone() }).collect(),
            images: network.images.len(),
            image_points: network.observations.len(),
            rejected: rejected.collect(),
            unknowns: solution.counts().unknowns,
            redundancy: solution.counts().redundancy(),
            sigma_px: prepared.asked.settings.sigma(),
            sigma0: solution.sigma0(),
            cost: solution.cost(),
            rms_px: found.rms_px(),
            cameras: (0..named.len()).map(camera).collect(),
            one_rig: found.one_rig.as_ref().ok().map(|test| OneRigAnswer {
                f: test.f,
                freedom: test.freedom,
                p: test.p,
                sigma0: test.sigma0,
                explains: test.explains,
                too_few: test.too_few,
                worst: test
                    .worst
                    .iter()
                    .map(|(image, [rms_px, rms_alone_px])| WorstImage {
                        image: image.clone(),
                        rms_px: *rms_px,
                        rms_alone_px: *rms_alone_px,
                    })
                    .collect(),
            }),
            one_rig_untested: found.one_rig.as_ref().err().cloned(),
            held: found.held.as_ref().map(|held| HeldAnswer { cost: held.cost, p: held.p, moves: held.moves.clone() }),
            stations: prepared.rig.stations.iter().zip(solution.stations()).map(station).collect(),
        })
    }
}
