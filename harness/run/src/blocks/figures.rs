//! What is reported of a block.

use calibench_model::camera::CameraModel;
use calibench_records::results::{Figure, Group};
use calibench_scenario::Block;
use nalgebra::{DMatrix, DVector};

use super::Job;
use super::network::{Solved, name};

/// Counts and sigma0; of several networks each, and mean, least and most.
pub fn counted(job: &Job<'_>, block: &Block, solved: &[Solved]) -> Vec<Figure> {
    let pitch_um = job.blocks.camera.base.pitch_um;
    let of = |one: &Solved| {
        let share = (one.observations - one.unknowns) as f64 / one.observations as f64;
        let counts = [
            ("observations", one.observations as f64),
            ("of them held", one.held as f64),
            ("unknowns", one.unknowns as f64),
            ("redundancy", one.observations as f64 - one.unknowns as f64),
            ("share of redundancy", share),
            ("images", one.images.len() as f64),
            ("images without orientation", (one.chosen.len() - one.images.len()) as f64),
            ("points", one.points.len() as f64),
            ("image points", one.residuals.len() as f64),
            ("gross errors", one.gross as f64),
            ("iterations", one.iterations as f64),
        ];
        let sigma0 = one.sigma0_px.into_iter().flat_map(move |px| [("sigma0", px, "px"), ("sigma0 in um", px * pitch_um, "um")]);
        counts.map(|(name, value)| (name, value, "")).into_iter().chain(sigma0).collect::<Vec<_>>()
    };
    let plain = |name: String, value: f64, unit: &'static str| Figure::plain(Group::Network, name, value, unit);
    if !block.several {
        let counts = solved.iter().flat_map(of).map(|(name, value, unit)| plain(name.into(), value, unit));
        // Pixels to an object unit.
        return counts.chain(solved.iter().map(|one| plain("image scale".into(), one.scale, "px"))).collect();
    }
    let each: Vec<_> = solved.iter().map(of).collect();
    let mut figures = vec![plain("networks".into(), solved.len() as f64, "")];
    for (figure, unit) in each.first().into_iter().flatten().map(|(figure, _, unit)| (*figure, *unit)) {
        let values: Vec<f64> = each.iter().filter_map(|one| one.iter().find(|(name, ..)| *name == figure)).map(|found| found.1).collect();
        let (least, most) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)));
        figures.push(plain(figure.into(), values.iter().sum::<f64>() / values.len() as f64, unit));
        figures.push(plain(format!("{figure}, least"), least, unit));
        figures.push(plain(format!("{figure}, most"), most, unit));
    }
    for (one, solved) in each.iter().zip(solved) {
        let sigma0 = one.iter().find(|(name, ..)| *name == "sigma0");
        figures.extend(sigma0.map(|&(_, value, unit)| plain(format!("sigma0/{}", name(job, &solved.chosen)), value, unit)));
    }
    figures
}

/// The parameters that were solved for, by group.
pub fn parameters(one: &Solved) -> Vec<Figure> {
    let of = |(group, sigmas): &(usize, Vec<(&'static str, f64)>)| {
        let all = one.cameras[*group].parameters();
        let figure = |(name, sigma): &(&'static str, f64)| {
            let parameter = all.iter().find(|parameter| parameter.name == *name)?;
            let name = format!("group {}/{name}", group + 1).into();
            Some(Figure { group: Group::Iop, name, value: parameter.value, sigma: Some(*sigma), error: None, unit: parameter.unit })
        };
        sigmas.iter().filter_map(figure).collect::<Vec<_>>()
    };
    one.sigmas.iter().flat_map(of).collect()
}

/// The root mean square residual of each image, and of all in rows (y) over that in columns (x).
pub fn by_image(job: &Job<'_>, one: &Solved) -> Vec<Figure> {
    let (mut squares, mut axes) = (vec![(0.0, 0_usize); job.stations.len()], [0.0; 2]);
    for (station, _, [x, y]) in &one.residuals {
        squares[*station].0 += x * x + y * y;
        squares[*station].1 += 2;
        axes = [axes[0] + x * x, axes[1] + y * y];
    }
    let rms = job.stations.iter().zip(squares).filter(|(_, (_, count))| *count > 0);
    let rms = rms.map(|(station, (sum, count))| Figure::plain(Group::Residual, station.name.as_str(), (sum / count as f64).sqrt(), "px"));
    let ratio = (axes[0] > 0.0).then(|| Figure::plain(Group::Network, "rows over columns", (axes[1] / axes[0]).sqrt(), ""));
    rms.chain(ratio).collect()
}

/// Every residual.
pub fn every_residual(job: &Job<'_>, one: &Solved) -> Vec<Figure> {
    let of = |(station, target, v): &(usize, usize, [f64; 2])| {
        let point = format!("{}/{}", job.stations[*station].name, job.field.targets[*target].id);
        [("x", v[0]), ("y", v[1])].map(|(axis, value)| Figure::plain(Group::Point, format!("{point}/{axis}"), value, "px"))
    };
    one.residuals.iter().flat_map(of).collect()
}

/// Every height.
pub fn heights(job: &Job<'_>, one: &Solved) -> Vec<Figure> {
    let unit = job.unit.name();
    let of = |(target, at, sigma): &(usize, nalgebra::Point3<f64>, [f64; 3])| {
        let name = format!("{}/Z", job.field.targets[*target].id).into();
        Figure { group: Group::Object, name, value: at.z, sigma: Some(sigma[2]), error: None, unit }
    };
    one.points.iter().map(of).collect()
}

/// The height in the middle over that at a distance `over` from it, along u and along v (X and Y): by a surface of the second order through all points.
///
/// # Errors
/// In words: fewer points than a surface takes.
pub fn bend(job: &Job<'_>, one: &Solved, over: f64) -> Result<[Figure; 2], String> {
    let row = |x: f64, y: f64| [1.0, x, y, x * y, x * x, y * y];
    if one.points.len() < 6 {
        return Err(format!("{} points: the bend of a surface takes 6", one.points.len()));
    }
    let scaled = |i: usize| row(one.points[i].1.x / over, one.points[i].1.y / over);
    let matrix = DMatrix::from_fn(one.points.len(), 6, |i, k| scaled(i)[k]);
    let heights = DVector::from_iterator(one.points.len(), one.points.iter().map(|point| point.1.z));
    let found = matrix.svd(true, true).solve(&heights, 1e-12).map_err(str::to_owned)?;
    let unit = job.unit.name();
    Ok([("bend along X", 4), ("bend along Y", 5)].map(|(name, k)| Figure::plain(Group::Network, name, -found[k], unit)))
}
