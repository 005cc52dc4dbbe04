//! `calibench accept`: whether measuring keeps what is specified, by calibrated lengths or by check points.

use std::path::{Path, PathBuf};

use calibench_accept::measured::{extent, fill, norm};
use calibench_accept::points::{Classes, Survey};
use calibench_accept::{Decision, LengthTest, Limit, PointTest, Rule};
use calibench_cameras::inputs_of;
use calibench_exchange::{read_control, read_distances, read_lengths};
use calibench_files::Inputs;
use calibench_model::ControlRow;
use calibench_report::acceptance::{errors_over_length, of_lengths, of_points};
use calibench_report::json::AcceptanceAnswer;
use clap::{ArgGroup, Args};

use super::convert::positive;
use super::output;
use crate::deliver::{As, answer, print};
use crate::failure::Failure;

#[derive(Args)]
#[command(group(ArgGroup::new("reference").required(true).args(["lengths", "check_points"])))]
pub struct Accept {
    /// Calibrated lengths, after VDI/VDE 2634 part 1: CSV with line,from,to,calibrated,sigma,measured in one unit; sigma is a standard uncertainty (k = 1), 0 of what is
    /// taken as exact. Without the column measured they are distances between points of --measured
    #[arg(long, value_name = "CSV", requires = "limit")]
    lengths: Option<PathBuf>,
    /// Surveyed check points, after ASPRS 2023: CSV with target,X,Y,Z and, if known, sX,sY,sZ
    #[arg(long, value_name = "CSV", requires = "measured")]
    check_points: Option<PathBuf>,
    /// Measured points: CSV with target,X,Y,Z, as `intersect` and `calibrate --report` write it. The largest distance between two of them is the diagonal of the measuring volume
    #[arg(long, value_name = "CSV")]
    measured: Option<PathBuf>,
    /// The limit A + K L of a length's error, at most B: A and B in the unit of the lengths, K a number (1e-5 is 10 um for each m); K and B may be left out
    #[arg(long, value_name = "A,K,B", conflicts_with = "check_points", allow_hyphen_values = true)]
    limit: Option<Limit>,
    /// Sides of the measuring volume, in the unit of the lengths [default: its diagonal is the largest distance between points of --measured]
    #[arg(long, value_name = "X,Y,Z", value_parser = sides, conflicts_with = "check_points", allow_hyphen_values = true)]
    volume: Option<[f64; 3]>,
    /// The distances that gave the scale, as for `calibrate --distances`: they are left out of the test
    #[arg(long, value_name = "CSV", conflicts_with = "check_points")]
    scale: Option<PathBuf>,
    /// At what probability an error is within the limit, or beyond it; after ISO 14253-1:2017 [default: 0.95]
    #[arg(long, value_name = "P", value_parser = probability, conflicts_with_all = ["check_points", "guard_band"], allow_negative_numbers = true)]
    probability: Option<f64>,
    /// In place of a probability, by how many standard uncertainties: 2 is U, 0 takes errors as they are
    #[arg(long, value_name = "K", value_parser = at_least_0, conflicts_with = "check_points", allow_negative_numbers = true)]
    guard_band: Option<f64>,
    /// Class of the horizontal accuracy: RMSE of X and Y together, in the unit of the points
    #[arg(long, value_name = "RMSE", value_parser = positive, conflicts_with = "lengths", allow_negative_numbers = true)]
    horizontal: Option<f64>,
    /// Class of the vertical accuracy: RMSE of Z
    #[arg(long, value_name = "RMSE", value_parser = positive, conflicts_with = "lengths", allow_negative_numbers = true)]
    vertical: Option<f64>,
    /// Class of the 3D accuracy: RMSE of X, Y and Z together
    #[arg(long = "3d", value_name = "RMSE", value_parser = positive, conflicts_with = "lengths", allow_negative_numbers = true)]
    spatial: Option<f64>,
    /// RMSE of the survey, horizontal and vertical [default: from sX,sY,sZ; none where these are not there, which is said]
    #[arg(long, value_name = "H,V", value_parser = survey, conflicts_with = "lengths", allow_hyphen_values = true)]
    survey: Option<[f64; 2]>,
    /// The unit of lengths and coordinates, to be said with them
    #[arg(long, value_name = "UNIT")]
    unit: Option<String>,
    /// Draw the errors over length, as PNG, SVG or PDF by the ending
    #[arg(long, value_name = "PICTURE", conflicts_with = "check_points")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    answered: As,
}

/// So many numbers with commas between, each as `is_right` asks.
fn numbers<const N: usize>(text: &str, is_right: fn(f64) -> bool) -> Option<[f64; N]> {
    let number = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite() && is_right(*value));
    text.split(',').map(number).collect::<Option<Vec<f64>>>()?.try_into().ok()
}

fn sides(text: &str) -> Result<[f64; 3], String> {
    numbers(text, |side| side > 0.0).ok_or_else(|| "expected three positive sides, as in 2000,2000,1500".into())
}

fn survey(text: &str) -> Result<[f64; 2], String> {
    numbers(text, |rmse| rmse >= 0.0).ok_or_else(|| "expected two numbers of at least 0, as in 0.012,0.02".into())
}

fn at_least_0(text: &str) -> Result<f64, String> {
    numbers(text, |value| value >= 0.0).map(|[value]| value).ok_or_else(|| "expected a number of at least 0".into())
}

fn probability(text: &str) -> Result<f64, String> {
    let found = numbers(text, |value| (0.5..1.0).contains(&value));
    found.map(|[value]| value).ok_or_else(|| "expected a probability from 0.5 to below 1, as in 0.95".into())
}

impl Accept {
    pub fn run(&self) -> Result<(), Failure> {
        let paths = [&self.lengths, &self.check_points, &self.measured, &self.scale];
        let inputs = inputs_of(paths.into_iter().flatten());
        let measured = self.measured.as_deref().map(read_control).transpose()?;
        let decision = match (&self.lengths, self.limit, &self.check_points) {
            (Some(lengths), Some(limit), _) => self.by_lengths(lengths, limit, measured.as_deref(), &inputs)?,
            (_, _, Some(surveyed)) => self.by_points(surveyed, measured.as_deref().unwrap_or_default())?,
            _ => return Err(Failure::input("expected --lengths with --limit, or --check-points with --measured")),
        };
        match decision {
            Decision::Pass => Ok(()),
            Decision::Fail => Err(Failure::Gate),
            Decision::CannotTell => Err(Failure::Doubt),
        }
    }

    fn by_lengths(&self, path: &Path, limit: Limit, measured: Option<&[ControlRow]>, inputs: &Inputs) -> Result<Decision, Failure> {
        let plot = self.plot.as_deref().map(|path| output::picture("--plot", path, inputs)).transpose()?;
        let mut lengths = read_lengths(path)?;
        fill(&mut lengths, measured.unwrap_or_default());
        if lengths.iter().all(|length| length.measured.is_none()) {
            let what = "no length is measured; expected the column measured, or --measured with the targets at the ends";
            return Err(Failure::input(format!("{}: {what}", path.display())));
        }
        let scale = self.scale.as_deref().map(read_distances).transpose()?;
        let rule = self.guard_band.map_or(self.probability.map_or(Rule::DEFAULT, Rule::Probability), Rule::GuardBand);
        let diagonal = self.volume.map(norm).or(measured.map(extent));
        let test = LengthTest { lengths: &lengths, limit, rule, diagonal, scale: scale.as_deref() };
        let (found, unit) = (test.run(), self.unit.as_deref());
        if self.answered.json {
            answer(&AcceptanceAnswer::of_lengths(&test, &found, unit))?;
        } else {
            print(&of_lengths(&test, &found, unit))?;
        }
        if let Some(plot) = plot {
            errors_over_length(&test, &found, unit).write(&plot)?;
        }
        Ok(found.decision)
    }

    fn by_points(&self, path: &Path, measured: &[ControlRow]) -> Result<Decision, Failure> {
        let surveyed = read_control(path)?;
        let classes = Classes { horizontal: self.horizontal, vertical: self.vertical, spatial: self.spatial };
        let survey = self.survey.map(|[horizontal, vertical]| Survey { horizontal, vertical });
        let test = PointTest { surveyed: &surveyed, measured, classes, survey };
        let found = test.run().map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
        let unit = self.unit.as_deref();
        if self.answered.json {
            answer(&AcceptanceAnswer::of_points(&found, unit))?;
        } else {
            print(&of_points(&found, unit))?;
        }
        Ok(found.decision)
    }
}
