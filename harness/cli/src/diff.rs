//! `calibench diff`: how far two cameras differ.

use std::path::{Path, PathBuf};

use calibench_exchange::Inputs;
use calibench_model::PixelPoint;
use calibench_model::camera::CameraModel;
use calibench_model::convert::{DifferenceOptions, Vector, difference, difference_at};
use calibench_report::{Hull, plain};
use clap::Args;

use super::convert::{advise, field, positive, region, size_of};
use super::output;
use super::reading::Reading;
use crate::deliver::print;
use crate::failure::Failure;
use crate::inputs::read_measured;

#[derive(Args)]
pub struct Diff {
    /// A camera file
    first: PathBuf,
    /// Another one, for images of the same size
    second: PathBuf,
    /// Draw the difference over the frame
    #[arg(long, value_name = "PNG")]
    plot: Option<PathBuf>,
    /// Compare without the best rotation
    #[arg(long)]
    no_rotation: bool,
    /// Measured image points: the rotation is the best at these, where poses make up for the camera, and what lies outside of them is said apart
    #[arg(long, value_name = "CSV", conflicts_with = "no_rotation")]
    points: Option<PathBuf>,
    /// Compare only within this radius from the image of the axis, px
    #[arg(long, value_name = "PX", value_parser = positive, allow_negative_numbers = true)]
    radius: Option<f64>,
    /// Say what the difference is on an object at this distance, in its unit
    #[arg(long, value_name = "D", value_parser = positive, allow_negative_numbers = true)]
    distance: Option<f64>,
    #[command(flatten)]
    reading: Reading,
}

impl Diff {
    pub fn run(&self) -> Result<(), Failure> {
        let inputs = Inputs::new([&self.first, &self.second].into_iter().chain(&self.points));
        let plot = self.plot.as_deref().map(|path| output::picture("--plot", path, &inputs)).transpose()?;
        let camera = |path: &Path| self.reading.one(path).map(|named| named.camera);
        let (first, second) = (camera(&self.first)?, camera(&self.second)?);
        let (a, b) = (first.size(), second.size());
        if a != b {
            let sizes = format!("{} x {} px and {} x {} px", a.width, a.height, b.width, b.height);
            return Err(Failure::input(format!("the images of the two cameras differ in size: {sizes}; expected the same")));
        }
        let options = DifferenceOptions {
            region: region(self.radius),
            rotation: !self.no_rotation,
            compensation: true,
            ..DifferenceOptions::default()
        };
        let places = self.points.as_deref().map(places).transpose()?;
        let found = match &places {
            Some(places) => difference_at(&first, &second, places, &options),
            None => difference(&first, &second, &options),
        };
        let found = found.map_err(|error| advise(&error))?;
        let after = if self.no_rotation {
            "without a rotation".to_owned()
        } else {
            let by = if places.is_some() { ", the best at the points" } else { "" };
            format!("after a rotation of {:.6}\u{b0}{by}", found.rotation.angle().to_degrees())
        };
        let mut text = format!("difference  {}, {after}\n", size_of(&found.spread));
        let measured = Hull::of(&places.unwrap_or_default());
        if self.points.is_some() {
            text.push_str(&format!("inside      {}, where points were measured\n", part(&found.vectors, |at| measured.holds(at))));
            text.push_str(&format!("outside     {}\n", part(&found.vectors, |at| !measured.holds(at))));
        }
        if let Some(compensated) = &found.compensated {
            let [dx, dy] = compensated.shift;
            text.push_str(&format!(
                "of these    {} remain after the best change of the principal distance ({:+.6} %) and point ({dx:+.3}, {dy:+.3} px)\n",
                size_of(&compensated.spread),
                100.0 * compensated.scale
            ));
        }
        if found.not_comparable > 0.0 {
            text.push_str(&format!(
                "left out    {:.2} % of the region, which one of the cameras does not picture\n",
                100.0 * found.not_comparable
            ));
        }
        if let Some(distance) = self.distance {
            let on = |px| plain(found.on_object(px, distance));
            text.push_str(&format!(
                "on object   {} RMS, {} at most, at a distance of {distance}\n",
                on(found.spread.rms_px),
                on(found.spread.max_px)
            ));
        }
        print(&text)?;
        let Some(plot) = &plot else { return Ok(()) };
        let title = format!("From {} to {}", stem(&self.first), stem(&self.second));
        Ok(field(&title, &first, &found.vectors, measured).write(plot)?)
    }
}

/// All measured positions of a point file, px.
fn places(path: &Path) -> Result<Vec<PixelPoint>, Failure> {
    Ok(read_measured(path)?.rows().map(|row| row.start.position).collect())
}

/// The size of the vectors in a part of the frame.
fn part(vectors: &[Vector], is_part: impl Fn(PixelPoint) -> bool) -> String {
    let lengths: Vec<f64> = vectors.iter().filter(|vector| is_part(vector.at)).map(Vector::length).collect();
    if lengths.is_empty() {
        return "nothing was compared".to_owned();
    }
    let rms = (lengths.iter().map(|length| length * length).sum::<f64>() / lengths.len() as f64).sqrt();
    format!("{} px RMS, {} px at most", plain(rms), plain(lengths.iter().copied().fold(0.0, f64::max)))
}

fn stem(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
