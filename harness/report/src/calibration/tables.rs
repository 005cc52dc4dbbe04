//! Everything as CSV.

use std::collections::HashMap;
use std::io;

use calibench_adjust::{Found, PointReliability, Residual, Significance, Use};
use calibench_calibrate::Calibration;
use calibench_exchange::{POSE_COLUMNS, POSE_SIGMA_COLUMNS, station_numbers, write_control};
use calibench_files::NewFolder;
use calibench_model::ControlRow;
use calibench_model::camera::CameraModel;

use super::csv::table;
use super::uncertainty::UncertaintyMap;

/// Writes all tables into `folder`; `maps` are the uncertainty's, camera by camera.
pub(super) fn write(calibration: &Calibration<'_>, maps: &[Vec<UncertaintyMap>], folder: &NewFolder) -> io::Result<()> {
    residuals(calibration, folder)?;
    if let Some(compared) = &calibration.compared {
        super::sets_page::write(compared, folder)?;
    }
    parameters(calibration, folder)?;
    correlations(calibration, folder)?;
    stations(calibration, folder)?;
    super::board::table(calibration, folder)?;
    super::measured_board::table(calibration, folder)?;
    super::lengths::write(calibration, folder)?;
    super::own_numbers::write(calibration, folder)?;
    super::uncertainty::write(calibration, maps, folder)?;
    let rows = object_points(calibration);
    folder.write("points.csv", |file| write_control(file, &rows))
}

fn texts<const N: usize>(values: Option<[f64; N]>) -> Vec<String> {
    values.map_or_else(|| vec![String::new(); N], |values| values.iter().map(f64::to_string).collect())
}

const RESIDUALS: [&str; 15] = [
    "image",
    "target",
    "x",
    "y",
    "vx",
    "vy",
    "redundancy_x",
    "redundancy_y",
    "w_x",
    "w_y",
    "detectable_x",
    "detectable_y",
    "weight",
    "status",
    "reason",
];

/// What was taken from the image coordinates of discs, px; there where anything was.
const ECCENTRICITY: [&str; 2] = ["eccentricity_x", "eccentricity_y"];

/// Every row that was given, and every target that a method could not measure, with its status. Residuals are adjusted less observed, px, of discs less what was
/// taken from them.
fn residuals(calibration: &Calibration<'_>, folder: &NewFolder) -> io::Result<()> {
    let prepared = calibration.prepared;
    let survey = &prepared.survey;
    // All are in the order of the file: the next of each is that of the row or of a later one.
    let mut residuals = calibration.solution.each_residual().peekable();
    let mut checks = calibration.reliability.iter().flat_map(|r| &r.points).peekable();
    let mut left_out = prepared.left_out.iter().peekable();
    let rejected: HashMap<usize, &Found> = calibration.found.iter().map(|found| (found.observation, found)).collect();
    let taken = prepared.eccentricity.as_ref();
    let given = (0..survey.sights()).map(|index| {
        let sight = survey.sight(index);
        let mut row = vec![survey.images[sight.image].clone(), survey.target(sight.target).to_owned()];
        row.extend(texts(Some([sight.position.x, sight.position.y])));
        if let Some(left) = left_out.next_if(|left| left.sight == index) {
            row.extend(vec![String::new(); 9]);
            row.extend(["left_out".to_owned(), left.why.clone()]);
            row.extend(taken.iter().flat_map(|_| texts::<2>(None)));
        } else if let Some(residual) = residuals.next_if(|residual| prepared.sights[residual.observation] as usize == index) {
            let checked = checks.next_if(|check| check.observation == residual.observation);
            row.extend(adjusted(&residual, checked, rejected.get(&residual.observation).copied()));
            row.extend(taken.iter().flat_map(|taken| texts(Some(taken.offsets[residual.observation]))));
        }
        row
    });
    let unmeasured = prepared.unmeasured.iter().map(|[image, target, status, reason]| {
        let mut row = vec![image.to_owned(), target.to_owned()];
        row.extend(vec![String::new(); 11]);
        row.extend([status.to_owned(), reason.to_owned()]);
        row.extend(taken.iter().flat_map(|_| texts::<2>(None)));
        row
    });
    let columns = [&RESIDUALS[..], if taken.is_some() { &ECCENTRICITY } else { &[] }].concat();
    table(folder, "residuals.csv", &columns, given.chain(unmeasured))
}

/// The cells of a row after its coordinates.
fn adjusted(residual: &Residual, checked: Option<&PointReliability>, rejected: Option<&Found>) -> Vec<String> {
    let (used, weight) = match residual.used {
        Use::Full => ("used", 1.0),
        Use::Downweighted(weight) => ("downweighted", weight),
        Use::LeftOut => ("rejected", 0.0),
    };
    let why = rejected.map_or(String::new(), |found| {
        let kept = if found.left_out { "" } else { ", kept: the network needs it" };
        format!("normalised residual {:.2} beyond {:.2}{kept}", found.w, found.critical)
    });
    let mut row = texts(residual.v);
    row.extend(texts(checked.map(|p| p.redundancy)));
    row.extend(texts(checked.map(|p| p.w)));
    row.extend(texts(checked.map(|p| p.detectable)));
    row.extend([weight.to_string(), used.to_owned(), why]);
    row
}

/// All parameters; those that were not solved for have no standard deviation.
fn parameters(calibration: &Calibration<'_>, folder: &NewFolder) -> io::Result<()> {
    let tests = calibration.significance();
    let of_camera = |camera: usize| {
        let rows = of_camera(calibration, &tests, camera);
        let name = calibration.name_of(camera);
        rows.into_iter().map(move |row| [vec![name.to_owned()], row].concat())
    };
    let columns = ["camera", "parameter", "unit", "value", "sigma", "sigma_by_images", "t", "p", "status"];
    table(folder, "parameters.csv", &columns, (0..calibration.cameras()).flat_map(of_camera))
}

fn of_camera(calibration: &Calibration<'_>, tests: &[Significance], camera: usize) -> Vec<Vec<String>> {
    let (names, covariance) = calibration.covariances.of_camera(camera);
    let priors = &calibration.prepared.settings.cameras[camera].priors;
    let row = |parameter: calibench_model::camera::CameraParameter| {
        let sigma = names.iter().position(|name| *name == parameter.name).map(|i| covariance[(i, i)].sqrt());
        let test = tests.iter().find(|test| test.camera == camera && test.parameter == parameter.name);
        let mut row = vec![parameter.name.to_owned(), parameter.unit.to_owned(), parameter.value.to_string()];
        row.extend(texts(sigma.map(|sigma| [sigma])));
        let resampled = calibration.resampled.as_ref().and_then(|found| found.as_ref().ok());
        let place = calibration.covariances.parameters.iter().position(|known| *known == (camera, parameter.name));
        row.extend(texts(resampled.zip(place).map(|(found, place)| [found.sigmas[place]])));
        row.extend(texts(test.map(|test| [test.t, test.p])));
        let observed = priors.iter().any(|prior| prior.parameter == parameter.name);
        row.push(
            if observed {
                "observed"
            } else if sigma.is_some() {
                "free"
            } else {
                "fixed"
            }
            .to_owned(),
        );
        row
    };
    calibration.camera(camera).parameters().into_iter().map(row).collect()
}

/// Every pair of solved parameters once.
fn correlations(calibration: &Calibration<'_>, folder: &NewFolder) -> io::Result<()> {
    let rho = calibration.covariances.correlations();
    let names: Vec<String> = calibration.covariances.parameters.iter().map(|parameter| calibration.parameter_name(parameter)).collect();
    let pairs = (0..names.len()).flat_map(|i| (0..i).map(move |j| (j, i)));
    let rows = pairs.map(|(i, j)| vec![names[i].clone(), names[j].clone(), rho[(i, j)].to_string()]);
    table(folder, "correlations.csv", &["first", "second", "rho"], rows)
}

/// Poses as `render` writes them, with standard deviations: of X0 in object units, of a small rotation about the camera's axes in degrees.
fn stations(calibration: &Calibration<'_>, folder: &NewFolder) -> io::Result<()> {
    let columns = [&["image"], &POSE_COLUMNS[..], &POSE_SIGMA_COLUMNS, &["points", "rms_px", "camera"]].concat();
    let (poses, rms) = (calibration.solution.poses(), calibration.solution.rms_by_image());
    let counts = super::points_by_image(calibration);
    let row = |(index, name): (usize, &String)| {
        let covariance = &calibration.covariances.poses[index];
        let sigma = |i: usize| covariance[(i, i)].max(0.0).sqrt();
        let mut row = vec![name.clone()];
        row.extend(texts(Some(station_numbers(&poses[index]))));
        row.extend(texts(Some([sigma(0), sigma(1), sigma(2)])));
        row.extend(texts(Some([sigma(3), sigma(4), sigma(5)].map(f64::to_degrees))));
        row.push(counts[index].to_string());
        row.extend(texts(rms[index].map(|rms| [rms])));
        row.push(calibration.name_of(calibration.owner(index)).to_owned());
        row
    };
    table(folder, "stations.csv", &columns, calibration.prepared.survey.images.iter().enumerate().map(row))
}

/// Object points as a control file; fixed ones have no standard deviation.
fn object_points(calibration: &Calibration<'_>) -> Vec<ControlRow> {
    let row = |(index, point): (usize, &calibench_adjust::ObjectPoint)| {
        let covariance = &calibration.covariances.points[index];
        let sigmas: [f64; 3] = std::array::from_fn(|i| covariance[(i, i)].max(0.0).sqrt());
        let sigmas = Some(sigmas).filter(|sigmas| sigmas.iter().all(|sigma| *sigma > 0.0));
        ControlRow { sigmas, ..ControlRow::new(&point.name, calibration.solution.points()[index].coords.into()) }
    };
    calibration.prepared.network.points.iter().enumerate().map(row).collect()
}
