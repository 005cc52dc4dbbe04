//! `calibench diff`: how far two cameras differ.

use std::path::{Path, PathBuf};

use calibench_cameras::{ReadOptions, inputs_of, read_camera_with};
use calibench_model::camera::{Camera, CameraModel, ImageSize};
use calibench_model::convert::{Difference, DifferenceOptions, Vector, difference, difference_at};
use calibench_model::reframing::same_camera;
use calibench_model::rig_difference::rig_difference;
use calibench_model::{NamedCamera, PixelPoint};
use calibench_report::json::{DifferenceAnswer, Part};
use calibench_report::{Hull, plain};
use clap::Args;

use super::convert::{advise, field, positive, region, size_of};
use super::output;
use super::reading::{Reading, shown};
use crate::deliver::{As, answer, print};
use crate::failure::Failure;
use crate::inputs::read_measured;
use crate::same_camera::for_images;

#[derive(Args)]
pub struct Diff {
    /// A camera file
    first: PathBuf,
    /// Another one, for images of the same size
    second: PathBuf,
    /// The second camera is of images of another size, of the same aspect: it is compared as it is in images of the size of the first
    #[arg(long, conflicts_with = "rig")]
    same_camera: bool,
    /// Draw the difference over the frame, as PNG, SVG or PDF by the ending
    #[arg(long, value_name = "PICTURE")]
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
    /// Difference over the frame, px RMS (of a rig, of the points pictured), beyond which the exit code is 1
    #[arg(long, value_name = "PX", value_parser = positive, allow_negative_numbers = true)]
    limit: Option<f64>,
    /// Compare rigs: files of several cameras with where they sit, as Kalibr's chains and OpenCV's stereo files; needs --distance
    #[arg(long, requires = "distance", conflicts_with_all = ["plot", "points", "no_rotation", "radius", "json"])]
    rig: bool,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    answered: As,
}

impl Diff {
    pub fn run(&self) -> Result<(), Failure> {
        if let (true, Some(distance)) = (self.rig, self.distance) {
            return self.rigs(distance);
        }
        let inputs = inputs_of([&self.first, &self.second].into_iter().chain(&self.points));
        let plot = self.plot.as_deref().map(|path| output::picture("--plot", path, &inputs)).transpose()?;
        let camera = |path: &Path| {
            let named = self.reading.one(path)?;
            named.doubt().map_or(Ok(named), |doubt| Err(Failure::input(format!("{}: {doubt}", shown(path)))))
        };
        let (first, second) = (camera(&self.first)?.camera, camera(&self.second)?);
        let a = first.size();
        let second = self.in_size(&second, a)?;
        let options = DifferenceOptions {
            region: region(self.radius),
            rotation: !self.no_rotation,
            compensation: true,
            finer: DifferenceOptions::FINE,
            ..DifferenceOptions::default()
        };
        let places = self.points.as_deref().map(places).transpose()?;
        let found = match &places {
            Some(places) => difference_at(&first, &second, places, &options),
            None => difference(&first, &second, &options),
        };
        let found = found.map_err(|error| advise(&error))?;
        let measured = Hull::of(&places.unwrap_or_default());
        let parts = self.points.is_some().then(|| {
            let part = |is_inside| part(&found.vectors, a, |at| measured.holds(at) == is_inside);
            [part(true), part(false)]
        });
        if self.answered.json {
            let files = [&self.first, &self.second].map(|path| path.display().to_string());
            let told = DifferenceAnswer::new(files, a, &found, !self.no_rotation, parts, self.distance);
            answer(&told.with_limit(self.limit, found.spread.rms_px))?;
        } else {
            print(&self.words(&found, parts))?;
        }
        if let Some(plot) = &plot {
            let title = format!("From {} to {}", stem(&self.first), stem(&self.second));
            field(&title, &first, &found.vectors, measured).write(plot)?;
        }
        self.gate(found.spread.rms_px)
    }

    /// Whether cameras that differ by so much, px RMS, pass; what was compared nowhere does not.
    fn gate(&self, rms_px: f64) -> Result<(), Failure> {
        match self.limit {
            Some(limit) if rms_px.is_nan() || rms_px > limit => {
                say!("the cameras differ by {} px RMS, more than the {limit} px of --limit", plain(rms_px));
                Err(Failure::Gate)
            }
            _ => Ok(()),
        }
    }

    /// The second camera for images of the first one's size.
    fn in_size(&self, second: &NamedCamera, a: ImageSize) -> Result<Camera, Failure> {
        if self.same_camera {
            return Ok(for_images(&self.second, second, a, true)?.camera);
        }
        let file = shown(&self.second);
        let taken = same_camera(second, a, false).map_err(|other| {
            let b = second.camera.size();
            let sizes = format!("{} x {} px and {} x {} px", a.width, a.height, b.width, b.height);
            let advice = other.advice("--same-camera", &file);
            Failure::input(format!("the images of the two cameras differ in size: {sizes}; expected the same. {file}: the camera {advice}"))
        });
        Ok(taken?.0.camera)
    }

    /// Each camera of a rig beside its first one against those of the other rig, in the order of the files.
    fn rigs(&self, distance: f64) -> Result<(), Failure> {
        let read = |path: &Path| Ok::<_, Failure>(read_camera_with(path, &ReadOptions::default())?.cameras);
        let (first, second) = (read(&self.first)?, read(&self.second)?);
        if first.len() != second.len() || first.len() < 2 {
            let counts = format!("{} and {} cameras", first.len(), second.len());
            return Err(Failure::input(format!("the files hold {counts}; expected two rigs of as many, two at least")));
        }
        let (mut text, mut most) = (String::new(), 0.0_f64);
        for (place, (a, b)) in first.iter().zip(&second).enumerate().skip(1) {
            let found = rig_difference([&first[0], a], [&second[0], b], distance);
            let found = found.map_err(|why| Failure::input(format!("camera {} of the rigs: {why}", place + 1)))?;
            most = most.max(found.px[0]);
            let name = if a.name.is_empty() { format!("camera {}", place + 1) } else { a.name.clone() };
            text.push_str(&format!(
                "{name}: moved by {}, turned by {:.4}\u{b0}; baselines {} and {}\nat {distance}: {} RMS, {} at most; {} px RMS, {} px at most, of {} points\n",
                plain(found.moved),
                found.turned_deg,
                plain(found.baselines[0]),
                plain(found.baselines[1]),
                plain(found.at_distance[0]),
                plain(found.at_distance[1]),
                plain(found.px[0]),
                plain(found.px[1]),
                found.points
            ));
        }
        print(&text)?;
        self.gate(most)
    }

    fn words(&self, found: &Difference, parts: Option<[Option<Part>; 2]>) -> String {
        let after = if self.no_rotation {
            "without a rotation".to_owned()
        } else {
            let by = if self.points.is_some() { ", the best at the points" } else { "" };
            format!("after a rotation of {:.6}\u{b0}{by}", found.rotation.angle().to_degrees())
        };
        let mut text = format!("difference  {}, {after}\n", size_of(&found.spread));
        if let Some([inside, outside]) = parts {
            text.push_str(&format!("inside      {}, where points were measured\n", in_words(inside)));
            text.push_str(&format!("outside     {}\n", in_words(outside)));
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
        text
    }
}

/// All measured positions of a point file, px.
fn places(path: &Path) -> Result<Vec<PixelPoint>, Failure> {
    Ok(read_measured(path)?.rows().map(|row| row.start.position).collect())
}

/// The size of the vectors in a part of the frame: the RMS is the mean over its area, of which a node at the frame's border has half. `None` where nothing was
/// compared.
fn part(vectors: &[Vector], size: ImageSize, is_part: impl Fn(PixelPoint) -> bool) -> Option<Part> {
    let half = |place: f64, side: u32| if place <= 0.0 || place >= f64::from(side) - 1.0 { 0.5 } else { 1.0 };
    let weighted = |vector: &Vector| (half(vector.at.x, size.width) * half(vector.at.y, size.height), vector.length());
    let lengths: Vec<(f64, f64)> = vectors.iter().filter(|vector| is_part(vector.at)).map(weighted).collect();
    if lengths.is_empty() {
        return None;
    }
    let (sum, area) = lengths.iter().fold((0.0, 0.0), |(sum, area), (weight, length)| (sum + weight * length * length, area + weight));
    Some(Part { rms_px: (sum / area).sqrt(), max_px: lengths.iter().map(|(_, length)| *length).fold(0.0, f64::max) })
}

fn in_words(part: Option<Part>) -> String {
    part.map_or("nothing was compared".into(), |Part { rms_px, max_px }| format!("{} px RMS, {} px at most", plain(rms_px), plain(max_px)))
}

fn stem(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame of three nodes along each side: a corner's share of the area is a quarter of the middle's.
    #[test]
    fn an_rms_is_the_mean_over_the_area() {
        let place = |i: i32| 50.0 * f64::from(i);
        let all = (0..9).map(|i| Vector { at: PixelPoint::new(place(i % 3), place(i / 3)), dx: if i == 4 { 0.0 } else { 2.0 }, dy: 0.0 });
        let all: Vec<Vector> = all.collect();
        let size = ImageSize { width: 101, height: 101 };
        assert_eq!(in_words(part(&all, size, |_| true)), format!("{} px RMS, 2.00 px at most", plain(3.0_f64.sqrt())));
        assert_eq!(in_words(part(&all, size, |at| at.x == 0.0 && at.y == 0.0)), "2.00 px RMS, 2.00 px at most");
        assert_eq!(in_words(part(&all, size, |at| at.x > 500.0)), "nothing was compared");
    }
}
