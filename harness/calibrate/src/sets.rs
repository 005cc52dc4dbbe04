//! Several sets of parameters for the same observations: which of them the network supports.

use calibench_adjust::{Comparison, Interior, Network, Options, PerImage, Solution, Status, Variance, adjust, compare};
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::convert::{DifferenceOptions, difference};

use crate::{Calibration, CalibrationError, Compared, ComparedSet, Prepared, SetResult};

/// Adjusts the observations of `calibration` once more for every set of parameters, from the same start values and without the image points that it
/// rejected. What a set does not solve for keeps the value of the usual start; observed parameters stay observed in every set.
///
/// # Errors
/// A name that the model does not have. A set that the network does not determine is no error: it says so.
pub fn compare_sets(calibration: &Calibration<'_>, sets: &[Vec<String>]) -> Result<Compared, CalibrationError> {
    let options = Options { most_iterations: Options::default().most_iterations, ..calibration.options() };
    let networks = sets.iter().map(|names| with(calibration.prepared, names)).collect::<Result<Vec<_>, _>>()?;
    let solutions: Vec<Result<Solution<'_>, String>> =
        networks.iter().map(|network| adjust(network, &options).map_err(|error| error.to_string())).collect();
    let set = |index: usize| ComparedSet {
        names: sets[index].clone(),
        result: solutions[index].as_ref().map_err(Clone::clone).and_then(|solution| result(solution, calibration)),
        against: against(index, sets, &solutions),
    };
    Ok(Compared { sets: (0..sets.len()).map(set).collect() })
}

impl Calibration<'_> {
    /// Adjusts with other sets of parameters as well; report and summary then have a table of them.
    ///
    /// # Errors
    /// As [`compare_sets`].
    pub fn compare(&mut self, sets: &[Vec<String>]) -> Result<(), CalibrationError> {
        self.compared = Some(compare_sets(self, sets)?);
        Ok(())
    }
}

/// The same network with other parameters solved for, of every camera.
fn with(prepared: &Prepared, names: &[String]) -> Result<Network, CalibrationError> {
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let cameras = prepared.network.cameras.iter().zip(&prepared.plain).map(|(interior, plain)| solving(interior, plain, &names));
    let cameras = cameras.collect::<Result<Vec<_>, _>>()?;
    // What is held for all images is held for each.
    let is_solved = |own: &&PerImage| own.along.iter().all(|(parameter, _)| cameras[own.camera].parameters[*parameter].is_unknown());
    let per_image = prepared.network.per_image.iter().filter(is_solved).cloned().collect();
    Ok(Network { cameras, per_image, ..prepared.network.clone() })
}

/// What is no longer solved for is as in `plain`.
fn solving(interior: &Interior, plain: &Camera, names: &[&str]) -> Result<Interior, CalibrationError> {
    let fixed = |status: &Status| if *status == Status::Free { Status::Fixed } else { *status };
    let observed = Interior { parameters: interior.parameters.iter().map(fixed).collect(), ..interior.clone() };
    let known = observed.parameters.clone();
    let mut free = observed.free(names)?;
    free.parameters.iter_mut().zip(known).filter(|(_, known)| known.is_unknown()).for_each(|(status, known)| *status = known);
    let (own, plain, before) = (interior.camera.parameters(), plain.parameters(), &interior.parameters);
    let no_longer = |i: usize| before[i] == Status::Free && free.parameters[i] == Status::Fixed;
    let values: Vec<f64> = (0..own.len()).map(|i| if no_longer(i) { plain[i].value } else { own[i].value }).collect();
    free.camera = interior.camera.with_parameters(&values);
    Ok(free)
}

fn result(solution: &Solution<'_>, calibration: &Calibration<'_>) -> Result<SetResult, String> {
    let counts = solution.counts();
    let (n, u) = (counts.observations() as f64, counts.unknowns as f64);
    let sigma0 = solution.sigma0().ok_or("without redundancy there is no test")?;
    // The variance factor is an unknown of the distribution too.
    let k = u + 1.0;
    let correction = if n > k + 1.0 { 2.0 * k * (k + 1.0) / (n - k - 1.0) } else { f64::INFINITY };
    let covariances = solution.covariances(Variance::Estimated).map_err(|error| error.to_string())?;
    let tests = solution.significance(&covariances).map_err(|error| error.to_string())?;
    Ok(SetResult {
        sigma0_px: sigma0 * calibration.prepared.settings.sigma(),
        counts: (counts.observations(), counts.unknowns),
        aicc: n * (solution.cost().max(f64::MIN_POSITIVE) / n).ln() + 2.0 * k + correction,
        tests: tests.into_iter().map(|test| (calibration.parameter_name(&(test.camera, test.parameter)), test)).collect(),
        change_px: change(calibration.solution.cameras(), solution.cameras()),
    })
}

/// RMS over all cameras, and the most of any.
fn change(before: &[Camera], after: &[Camera]) -> Option<[f64; 2]> {
    let of =
        |(before, after): (&Camera, &Camera)| difference(before, after, &DifferenceOptions::default()).ok().map(|change| change.spread);
    let spreads = before.iter().zip(after).map(of).collect::<Option<Vec<_>>>()?;
    let squares: f64 = spreads.iter().map(|spread| spread.rms_px * spread.rms_px).sum();
    Some([(squares / spreads.len() as f64).sqrt(), spreads.iter().map(|spread| spread.max_px).fold(0.0, f64::max)])
}

/// The largest set that is a part of another, and the test of the rest.
fn against(index: usize, sets: &[Vec<String>], solutions: &[Result<Solution<'_>, String>]) -> Option<(usize, Comparison)> {
    let second = solutions[index].as_ref().ok()?;
    let is_part = |other: &usize| sets[*other].len() < sets[index].len() && sets[*other].iter().all(|name| sets[index].contains(name));
    let parts = (0..sets.len()).filter(is_part).filter(|&other| solutions[other].is_ok());
    let largest = parts.max_by_key(|&other| (sets[other].len(), std::cmp::Reverse(other)))?;
    let first = solutions[largest].as_ref().ok()?;
    compare(first, second).ok().map(|comparison| (largest, comparison))
}
