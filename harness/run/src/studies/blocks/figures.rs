//! What is reported of a block.

use calibench_model::camera::CameraModel;
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
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
            (Quantity::Observations, one.observations as f64),
            (Quantity::Held, one.held as f64),
            (Quantity::Unknowns, one.unknowns as f64),
            (Quantity::Redundancy, one.observations as f64 - one.unknowns as f64),
            (Quantity::ShareOfRedundancy, share),
            (Quantity::Images, one.images.len() as f64),
            (Quantity::ImagesWithoutOrientation, (one.chosen.len() - one.images.len()) as f64),
            (Quantity::Points, one.points.len() as f64),
            (Quantity::ImagePoints, one.residuals.len() as f64),
            (Quantity::GrossErrors, one.gross as f64),
            (Quantity::Iterations, one.iterations as f64),
        ];
        let sigma0 =
            one.sigma0_px.into_iter().flat_map(move |px| [(Quantity::Sigma0, px, "px"), (Quantity::Sigma0Um, px * pitch_um, "um")]);
        counts.map(|(quantity, value)| (quantity, value, "")).into_iter().chain(sigma0).collect::<Vec<_>>()
    };
    if !block.several {
        let counts = solved.iter().flat_map(of).map(|(quantity, value, unit)| Figure::plain(quantity, value, unit));
        return counts.chain(solved.iter().map(|one| Figure::plain(Quantity::ImageScale, one.scale, "px"))).collect();
    }
    let each: Vec<_> = solved.iter().map(of).collect();
    let mut figures = vec![Figure::plain(Quantity::Networks, solved.len() as f64, "")];
    for (figure, unit) in each.first().into_iter().flatten().map(|(figure, _, unit)| (*figure, *unit)) {
        let values: Vec<f64> =
            each.iter().filter_map(|one| one.iter().find(|(quantity, ..)| *quantity == figure)).map(|found| found.1).collect();
        let (least, most) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)));
        figures.push(Figure::plain(figure, values.iter().sum::<f64>() / values.len() as f64, unit));
        figures.push(Figure::plain(figure.least(), least, unit));
        figures.push(Figure::plain(figure.most(), most, unit));
    }
    for (one, solved) in each.iter().zip(solved) {
        let sigma0 = one.iter().find(|(quantity, ..)| *quantity == Quantity::Sigma0);
        figures.extend(
            sigma0.map(|&(_, value, unit)| Figure::plain(Quantity::Sigma0OfNetwork.of(&[&name(job, &solved.chosen)]), value, unit)),
        );
    }
    figures
}

/// The parameters that were solved for, by group.
pub fn parameters(one: &Solved) -> Vec<Figure> {
    let of = |(group, sigmas): &(usize, Vec<(&'static str, f64)>)| {
        let all = one.cameras[*group].parameters();
        let figure = |(name, sigma): &(&'static str, f64)| {
            let parameter = all.iter().find(|parameter| parameter.name == *name)?;
            let name = Quantity::ParameterOfGroup.of(&[&(group + 1).to_string(), name]);
            Some(Figure { name, value: parameter.value, sigma: Some(*sigma), error: None, unit: parameter.unit })
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
    let rms =
        rms.map(|(station, (sum, count))| Figure::plain(Quantity::ImageResidual.of(&[&station.name]), (sum / count as f64).sqrt(), "px"));
    let ratio = (axes[0] > 0.0).then(|| Figure::plain(Quantity::RowsOverColumns, (axes[1] / axes[0]).sqrt(), ""));
    rms.chain(ratio).collect()
}

/// Every residual.
pub fn every_residual(job: &Job<'_>, one: &Solved) -> Vec<Figure> {
    let of = |(station, target, v): &(usize, usize, [f64; 2])| {
        let of = [job.stations[*station].name.as_str(), job.field.targets[*target].id.as_str()];
        [(Quantity::ResidualX, v[0]), (Quantity::ResidualY, v[1])].map(|(axis, value)| Figure::plain(axis.of(&of), value, "px"))
    };
    one.residuals.iter().flat_map(of).collect()
}

/// Every height.
pub fn heights(job: &Job<'_>, one: &Solved) -> Vec<Figure> {
    let unit = job.unit.name();
    let of = |(target, at, sigma): &(usize, nalgebra::Point3<f64>, [f64; 3])| {
        let name = Quantity::ObjectZ.of(&[&job.field.targets[*target].id]);
        Figure { name, value: at.z, sigma: Some(sigma[2]), error: None, unit }
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
    Ok([(Quantity::BendX, 4), (Quantity::BendY, 5)].map(|(quantity, k)| Figure::plain(quantity, -found[k], unit)))
}
