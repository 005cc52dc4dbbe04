//! A block of images over a field of many targets, each seen in five of them.

use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;

use calibench_cameras::{format_named, write_camera};
use calibench_exchange::{POSE_COLUMNS, station_numbers};
use calibench_files::write_table;
use calibench_images::write_png;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};
use calibench_model::{Image, NamedCamera, Pose};
use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Vector3};
use rand_chacha::rand_core::Rng;

/// Columns and rows of an image.
pub const WIDTH: u32 = 2000;
/// See [`WIDTH`].
pub const HEIGHT: u32 = 1500;
/// Images, however many rows there are.
pub const IMAGES: usize = 50;
/// Images that see a target.
const SEEN: usize = 5;
/// Control points, however many targets there are.
const CONTROL: usize = 1000;
/// Half the range of the errors of an image coordinate, px.
const ERROR: f64 = 0.2;

/// Cameras, poses and targets.
pub struct Network {
    camera: Camera,
    poses: Vec<Pose>,
    targets: Vec<Point3<f64>>,
}

/// The name of an image, without its ending.
pub fn name(image: usize) -> String {
    format!("image_{image:02}")
}

impl Network {
    /// A network of so many image points, but for a few that are outside of an image.
    pub fn of(rows: usize) -> Self {
        let distortion = std::array::from_fn(|i| if i == 0 { -0.05 } else { 0.0 });
        let size = ImageSize { width: WIDTH, height: HEIGHT };
        let camera = OpenCv { size, fx: 1500.0, fy: 1500.0, cx: 1003.0, cy: 746.0, distortion, coefficients: 5 }.into();
        let pose = |image: usize| {
            let (column, row) = ((image % 10) as f64, (image / 10) as f64);
            let middle = Point3::new(8.0, 6.0, 0.0);
            let centre = Point3::new(-4.0 + 24.0 / 9.0 * column, -3.0 + 18.0 / 4.0 * row, 18.0 + (image % 3) as f64);
            Pose::looking_at(centre, middle, Vector3::y(), std::f64::consts::FRAC_PI_2 * (image % 4) as f64)
        };
        let mut random = stream(Key { seed: 1, of: "rows", trial: 0, view: "", target: "" }, Purpose::Layout);
        let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let targets = (0..rows / SEEN).map(|_| Point3::new(16.0 * uniform(), 12.0 * uniform(), 2.0 * uniform())).collect();
        Self { camera, poses: (0..IMAGES).filter_map(pose).collect(), targets }
    }

    /// Writes points, control, stations, the camera and photographs; the size of the point file, bytes.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn write(&self, folder: &Path) -> Result<u64, Box<dyn Error>> {
        let points = folder.join("points.csv");
        self.points(BufWriter::new(File::create(&points)?))?;
        let mut control = BufWriter::new(File::create(folder.join("control.csv"))?);
        writeln!(control, "target,X,Y,Z,sX,sY,sZ")?;
        let step = (self.targets.len() / CONTROL).max(1);
        for (place, first) in (0..self.targets.len() / step).map(|place| (place, place * step)) {
            // Every image sees some.
            let target = first + place % step.min(IMAGES / SEEN);
            let Point3 { coords, .. } = self.targets[target];
            writeln!(control, "t{target},{},{},{},0.001,0.001,0.001", coords.x, coords.y, coords.z)?;
        }
        control.flush()?;
        let columns = [&["image"], &POSE_COLUMNS[..]].concat();
        let station = |(image, pose): (usize, &Pose)| {
            std::iter::once(format!("{}.png", name(image)))
                .chain(station_numbers(pose).map(|number| number.to_string()))
                .collect::<Vec<_>>()
        };
        write_table(File::create(folder.join("stations.csv"))?, &columns, self.poses.iter().enumerate().map(station))?;
        let format = format_named("opencv-yaml").ok_or("OpenCV's camera files are a format")?;
        fs::remove_file(folder.join("camera.yml")).ok();
        write_camera(&folder.join("camera.yml"), format, &[NamedCamera::new("", self.camera)])?;
        photographs(folder)?;
        Ok(fs::metadata(points)?.len())
    }

    /// Image by image, as `measure` writes them.
    fn points(&self, mut file: impl Write) -> Result<(), Box<dyn Error>> {
        let mut random = stream(Key { seed: 1, of: "rows", trial: 0, view: "", target: "" }, Purpose::DrawnPoint);
        let mut error = || ERROR * ((random.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0);
        writeln!(file, "image,target,x,y")?;
        for (image, pose) in self.poses.iter().enumerate() {
            // Every tenth target or so, another one in every image.
            let own = (0..self.targets.len()).filter(|target| (target * 7 + target / 10 * 3 + image) % (IMAGES / SEEN) == 0);
            for target in own {
                let Ok(seen) = self.camera.project(pose.ray(&self.targets[target])) else { continue };
                let (x, y) = (seen.x + error(), seen.y + error());
                if x > 0.0 && y > 0.0 && x < f64::from(WIDTH - 1) && y < f64::from(HEIGHT - 1) {
                    writeln!(file, "{}.png,t{target},{x:.4},{y:.4}", name(image))?;
                }
            }
        }
        Ok(file.flush()?)
    }
}

/// One photograph of small squares, under all names.
fn photographs(folder: &Path) -> Result<(), Box<dyn Error>> {
    let first = folder.join(format!("{}.png", name(0)));
    if first.exists() {
        return Ok(());
    }
    let squares = Image::from_fn(WIDTH as usize, HEIGHT as usize, |x, y| if (x / 16 + y / 16) % 2 == 0 { 0.1 } else { 0.9 });
    write_png(&first, &squares, false)?;
    for image in 1..IMAGES {
        fs::copy(&first, folder.join(format!("{}.png", name(image))))?;
    }
    Ok(())
}
