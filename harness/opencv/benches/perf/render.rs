//! Megapixels per second of the renderer, stage by stage, beside the way in which an image is simulated with OpenCV: a texture four times as fine as the
//! image, warped, blurred, spoiled.

use std::hint::black_box;

use calibench_model::camera::{Camera, ImageSize, Photogrammetric};
use calibench_model::{Area, Outline, Plate, Pose, Testfield};
use calibench_random::Key;
use calibench_synth::optics::Optics;
use calibench_synth::raster::{Picture, Renderer};
use calibench_synth::sensor::{Design, Electrons, Frame, Noise, Sensor};
use calibench_synth::view::View;
use nalgebra::{Point3, Vector3};

use crate::{seconds, warp};

const KEY: Key<'static> = Key { seed: 1, of: "perf", trial: 0, view: "v", target: "" };

/// The camera of the views: 22 mm, full Brown distortion, `width` x `height` px.
pub(crate) fn camera(width: u32, height: u32) -> Camera {
    let size = ImageSize { width, height };
    let pitch_um = 5.15 * 4272.0 / f64::from(width);
    let (k, p) = ([-4.6e-4, 1.0e-6, -2e-9], [0.86e-4, -0.3e-4]);
    Photogrammetric { size, pitch_um, c: 22.0, x0: 0.042, y0: -0.134, k, p, b: [1e-4, -2e-4] }.into()
}

/// A plate of 280 x 190 mm with a margin, `areas` on it.
fn field(areas: Vec<Area>) -> Testfield {
    let corners = [[-140.0, -95.0], [140.0, 95.0]];
    let plate =
        Plate { id: "p".into(), origin: Point3::origin(), u: Vector3::x(), v: Vector3::y(), bend: None, corners, level: 0.8, areas };
    Testfield { plates: vec![plate], targets: Vec::new(), background: 0.4 }
}

/// A chessboard of 10 x 7 squares.
pub(crate) fn board() -> Testfield {
    let side = 25.0;
    let dark = (0..70).filter(|i| (i % 10 + i / 10) % 2 == 0);
    let square = |i: i32| {
        let (u, v) = (f64::from(i % 10 - 5) * side, f64::from(i / 10) * side - 87.5);
        Area { outline: Outline::rectangle([u, v], [u + side, v + side]), level: 0.1, ground: 0.8 }
    };
    field(dark.map(square).collect())
}

/// `count` discs in rows.
fn discs(count: usize) -> Testfield {
    let columns = (count as f64 * 1.5).sqrt().ceil() as usize;
    let step = 270.0 / columns as f64;
    let disc = |i: usize| {
        let centre = [(i % columns) as f64 * step - 134.0, (i / columns) as f64 * step - 90.0];
        Area { outline: Outline::disc(centre, 0.3 * step), level: 0.1, ground: 0.8 }
    };
    field((0..count).map(disc).collect())
}

pub(crate) fn pose() -> Pose {
    Pose::looking_at(Point3::new(40.0, -50.0, 290.0), Point3::new(3.0, 2.0, 0.0), Vector3::y(), 0.03).expect("apart")
}

fn sensor() -> Sensor {
    let electrons = Electrons { read: 5.0, ..Electrons::of_well(20_000.0) };
    Sensor::new(Design { noise: Noise::Electrons(electrons), converter: Some(8), ..Design::default() }).expect("a plain sensor")
}

/// One view, from the testfield to 8 bit.
struct Job {
    field: Testfield,
    camera: Camera,
    renderer: Renderer,
    optics: Optics,
    frame: Frame,
}

impl Job {
    fn new(field: Testfield, width: u32, height: u32, blur: f64) -> Self {
        let optics = Optics { blur, ..Optics::default() };
        let frame = Frame { width: width as usize, height: height as usize };
        let renderer = Renderer::new(&optics, frame.width, frame.height).expect("plain optics");
        Self { field, camera: camera(width, height), renderer, optics, frame }
    }

    fn picture(&self) -> Picture {
        let pose = pose();
        let view = View { field: &self.field, camera: &self.camera, local: None, pose: &pose };
        view.picture(self.optics.reach()).expect("a board before the camera")
    }

    fn whole(&self, sensor: &Sensor) {
        let picture = self.picture();
        let image = self.renderer.render_with(&picture, &[], |first, rows| {
            sensor.expose_rows(rows, first, self.frame, KEY);
        });
        black_box(image);
    }

    fn megapixels(&self) -> f64 {
        (self.frame.width * self.frame.height) as f64 / 1e6
    }
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads").install(work)
}

pub(crate) fn run() {
    let sensor = sensor();
    println!("\nRendering, full Brown distortion, blur 0.7 px, photon and read noise, 8 bit, medians of 5:");
    println!("{:<44} {:>12} {:>12} {:>12}", "", "one thread", "two threads", "noise-free");
    let row = |name: &str, job: &Job| {
        let rate = |seconds: f64| job.megapixels() / seconds;
        let one = on_threads(1, || seconds(|| job.whole(&sensor)));
        let two = on_threads(2, || seconds(|| job.whole(&sensor)));
        let bare = on_threads(1, || {
            seconds(|| {
                black_box(job.renderer.render(&job.picture(), &[]));
            })
        });
        println!("  {name:<42} {:>7.1} Mpx/s {:>6.1} Mpx/s {:>6.1} Mpx/s   {:>8.1} views/s", rate(one), rate(two), rate(bare), 1.0 / one);
    };
    row("chessboard 10 x 7, 4272 x 2848", &Job::new(board(), 4272, 2848, 0.7));
    for count in [10, 200, 1000, 10_000, 100_000] {
        row(&format!("wall of {count} discs, 4272 x 2848"), &Job::new(discs(count), 4272, 2848, 0.7));
    }
    for (width, height) in [(240, 240), (480, 320), (1362, 908), (4272, 2848), (12_288, 8192)] {
        row(&format!("wall of 200 discs, {width} x {height}"), &Job::new(discs(200), width, height, 0.7));
    }
    for blur in [0.0, 0.3, 2.0, 5.0] {
        row(&format!("chessboard, 4272 x 2848, blur {blur}"), &Job::new(board(), 4272, 2848, blur));
    }
    memory(&Job::new(board(), 4272, 2848, 0.7), &sensor);
    stages(&Job::new(board(), 4272, 2848, 0.7), &sensor);
    warp::run();
}

/// The peak of the memory that a view takes, where the system tells it.
fn memory(job: &Job, sensor: &Sensor) {
    let figure = |key: &str| -> Option<f64> {
        let status = std::fs::read_to_string("/proc/self/status").ok()?;
        let line = status.lines().find(|line| line.starts_with(key))?;
        line.split_whitespace().nth(1)?.parse().ok()
    };
    // Writing a 5 makes the peak what is resident now.
    let peak = std::fs::write("/proc/self/clear_refs", "5").ok().and_then(|()| {
        let before = figure("VmRSS:")?;
        on_threads(2, || job.whole(sensor));
        Some((figure("VmHWM:")? - before) * 1024.0 / (job.megapixels() * 1e6))
    });
    match peak {
        Some(bytes) => println!("\nPeak memory, chessboard 10 x 7, 4272 x 2848: {bytes:.1} bytes a pixel"),
        None => println!("\nPeak memory: the system does not tell"),
    }
}

/// Seconds of each stage on one thread.
fn stages(job: &Job, sensor: &Sensor) {
    println!("\nIts stages, chessboard, one thread:");
    let print = |name: &str, seconds: f64| println!("  {name:<42} {:>8.1} ms {:>9.1} Mpx/s", seconds * 1e3, job.megapixels() / seconds);
    on_threads(1, || {
        let picture = job.picture();
        print("outlines in the image", seconds(|| drop(black_box(job.picture()))));
        let mut image = job.renderer.render(&picture, &[]);
        print("grey values", seconds(|| drop(black_box(job.renderer.render(&picture, &[])))));
        print(
            "photon and read noise, 8 bit",
            seconds(|| {
                sensor.expose_rows(image.grey_mut(), 0, job.frame, KEY);
            }),
        );
    });
}
