//! Inputs of known kind, drawn anew with each seed: sound ones, and such as are something else than they say.

use calibench_calibrate::{
    BoardShape, CalibrationError, DatumChoice, GrossErrors, Optics, Risk, Settings, Suspected, calibrate, prepare, suspected,
};
use calibench_model::camera::{Camera, DoubleSphere, ImageSize, OpenCv, OpenCvFisheye};
use calibench_model::{ControlRow, PixelPoint, Points, Pose};
use nalgebra::{Point3, Vector3};

use crate::network::{SIZE, Scene, board, lens, optics, settings, wall};

/// What a calibration is asked with.
pub type Input = (Points, Vec<ControlRow>, Settings);

/// A kind of input: its name, and that of a seed.
pub type Kind = (&'static str, fn(u64) -> Input);

/// Standard deviation of an image coordinate, px.
const SIGMA: f64 = 0.1;

/// Inputs that are what they say.
pub const SOUND: [Kind; 16] = [
    ("board", |seed| whole(&noisy(board(lens()), seed), settings("opencv5"))),
    ("board, tested for a bend", |seed| whole(&noisy(board(lens()), seed), Settings { shape: BoardShape::Tested, ..settings("opencv5") })),
    ("board, photogrammetric", |seed| whole(&noisy(board(square()), seed), settings("photogrammetric"))),
    ("board, Metashape's model", |seed| whole(&noisy(board(square()), seed), settings("metashape"))),
    ("board, gross errors sought", |seed| {
        whole(&noisy(board(lens()), seed), Settings { gross: GrossErrors::Rejected(Risk::EachPoint), ..settings("opencv5") })
    }),
    ("board beyond the frame", |seed| whole(&noisy(full_frame(), seed), settings("opencv5"))),
    ("tags", |seed| whole(&of_tags(18.0, seed), settings("opencv5"))),
    ("fisheye", |seed| {
        whole(&noisy(Scene { camera: fisheyed().camera, poses: fisheyed().poses, ..full_frame() }, seed), settings("opencv-fisheye"))
    }),
    ("wide, double sphere", |seed| whole(&noisy(Scene { camera: double_sphere(), ..fisheyed() }, seed), settings("double-sphere"))),
    ("wall", |seed| whole(&noisy(wall(lens()), seed), settings("opencv5"))),
    ("wall, 12 points known", |seed| whole(&noisy(Scene { control: 12, ..wall(lens()) }, seed), settings("opencv5"))),
    ("board, its principal point off the middle", |seed| {
        whole(&noisy(Scene { camera: off_the_middle(), ..full_frame() }, seed), settings("opencv5"))
    }),
    ("board, the principal point held", |seed| {
        let held = Optics {
            solve: Some(["fx", "fy", "k1", "k2", "k3", "p1", "p2"].map(String::from).to_vec()),
            start: Some(off_the_middle()),
            ..optics("opencv5")
        };
        whole(&noisy(Scene { camera: off_the_middle(), ..full_frame() }, seed), Settings::new(vec![held]))
    }),
    ("board, upright photographs", |seed| upright(&noisy(board(lens()), seed))),
    ("wall with a board on it", |seed| (among_control(97.0, seed).0, among_control(97.0, seed).1, settings("opencv5"))),
    ("wall, free network", |seed| whole(&noisy(wall(lens()), seed), Settings { datum: DatumChoice::Free, ..settings("opencv5") })),
];

/// Inputs that are something else than they say, by the word of what is to be suspected first.
pub const MISTAKEN: [(&str, Kind); 14] = [
    ("lens", ("a fisheye as a pinhole", |seed| whole(&noisy(fisheyed(), seed), settings("opencv5")))),
    (
        "raster",
        ("columns and rows of a board exchanged", |seed| {
            let scene = noisy(board(lens()), seed);
            let turned =
                |(k, row): (usize, ControlRow)| ControlRow { position: [30.0 * (k % 7) as f64, 30.0 * (k / 7) as f64, 0.0], ..row };
            (scene.points(), scene.known().into_iter().enumerate().map(turned).collect(), settings("opencv5"))
        }),
    ),
    ("axes", ("x and y exchanged, of a wall", |seed| exchanged(&noisy(wall(lens()), seed)))),
    ("axes", ("x and y exchanged, of a board", |seed| exchanged(&noisy(board(lens()), seed)))),
    (
        "up",
        ("y upwards, of a wall", |seed| {
            let scene = noisy(wall(lens()), seed);
            let upwards = |at: PixelPoint| PixelPoint::new(at.x, f64::from(SIZE.height) - 1.0 - at.y);
            (moved(&scene.points(), upwards), scene.known(), settings("opencv5"))
        }),
    ),
    ("spacing", ("another spacing of tags", |seed| (of_tags(18.0, seed).points(), of_tags(15.0, seed).known(), settings("opencv5")))),
    (
        "stretch",
        ("a board longer along its rows", |seed| {
            let stated = noisy(board(lens()), seed);
            let stretched = stated.targets.iter().map(|at| Point3::new(1.03 * at.x, at.y, 0.0)).collect();
            (Scene { targets: stretched, ..noisy(board(lens()), seed) }.points(), stated.known(), settings("opencv5"))
        }),
    ),
    (
        "scale",
        ("squares of another size among control", |seed| (among_control(97.0, seed).0, among_control(100.0, seed).1, settings("opencv5"))),
    ),
    ("size", ("images twice as large as stated", |seed| of_size(&noisy(board(lens()), seed), [800, 600]))),
    ("size", ("images half as large as stated", |seed| of_size(&noisy(board(lens()), seed), [3200, 2400]))),
    ("size", ("width and height exchanged, of a wall", |seed| of_size(&noisy(wall(lens()), seed), [SIZE.height, SIZE.width]))),
    ("size", ("images cropped to 16 : 9 from what is stated", |seed| of_size(&noisy(filled(), seed), [SIZE.width, 1600]))),
    ("size", ("images cropped from what is stated", |seed| of_size(&noisy(filled(), seed), [2000, 1500]))),
    ("origin", ("pixels counted from the corner, at the border", |seed| of_size(&noisy(dense(), seed), [SIZE.width - 1, SIZE.height - 1]))),
];

/// What a calibration answers: how many doubts it has, and what would be suspected of it if it had any; why there is none.
pub fn examined((points, control, settings): &Input) -> Result<(usize, Vec<Suspected>), CalibrationError> {
    let prepared = prepare(points.clone(), control, settings)?;
    calibrate(&prepared, &[], |calibration| (calibration.doubts().len(), suspected(points, control, settings, Ok(calibration))))
}

/// The same with what is suspected as the commands ask: where there are doubts, or no calibration.
pub fn asked((points, control, settings): &Input) -> Result<(usize, Vec<Suspected>), (CalibrationError, Vec<Suspected>)> {
    let of_error = |error: CalibrationError| {
        let suspects = suspected(points, control, settings, Err(&error));
        (error, suspects)
    };
    let prepared = prepare(points.clone(), control, settings).map_err(of_error)?;
    let found = calibrate(&prepared, &[], |calibration| {
        let doubts = calibration.doubts().len();
        (doubts, if doubts == 0 { Vec::new() } else { suspected(points, control, settings, Ok(calibration)) })
    });
    found.map_err(of_error)
}

/// What is suspected of it.
pub fn suspects(input: &Input) -> Vec<Suspected> {
    asked(input).map_or_else(|(_, suspects)| suspects, |(_, suspects)| suspects)
}

/// The points with others' places.
pub fn moved(points: &Points, to: impl Fn(PixelPoint) -> PixelPoint) -> Points {
    let mut moved = points.clone();
    moved.move_each(to);
    moved
}

/// The scene with noise of a seed.
pub fn noisy(scene: Scene, seed: u64) -> Scene {
    Scene { sigma: SIGMA, seed: 1 + 1_000_003 * seed, ..scene }
}

fn whole(scene: &Scene, settings: Settings) -> Input {
    (scene.points(), scene.known(), settings)
}

fn exchanged(scene: &Scene) -> Input {
    (moved(&scene.points(), |at| PixelPoint::new(at.y, at.x)), scene.known(), settings("opencv5"))
}

/// The scene with another stated size of its images, px.
pub fn of_size(scene: &Scene, [width, height]: [u32; 2]) -> Input {
    whole(scene, Settings::new(vec![Optics { size: ImageSize { width, height }, ..optics("opencv5") }]))
}

/// Tags of 60, gaps of `gap`, four by three, each with its four corners.
pub fn of_tags(gap: f64, seed: u64) -> Scene {
    let along = |k: usize| (k / 2) as f64 * (60.0 + gap) + (k % 2) as f64 * 60.0;
    let targets: Vec<_> = (0..48).map(|k| Point3::new(along(k % 8), along(k / 8), 0.0)).collect();
    noisy(Scene { control: targets.len(), targets, ..board(lens()) }, seed)
}

/// A board that fills the frame and more.
fn full_frame() -> Scene {
    raster([17, 11], 30.0)
}

/// The same with corners near every border.
pub fn filled() -> Scene {
    raster([36, 24], 15.0)
}

/// The same with so many corners that some lie at the border.
pub fn dense() -> Scene {
    raster([48, 32], 10.0)
}

fn raster([columns, rows]: [usize; 2], step: f64) -> Scene {
    let along = |k: usize, count: usize| step * (k as f64 - 0.5 * (count - 1) as f64);
    let at = |k: usize| Point3::new(120.0 + along(k % columns, columns), 90.0 + along(k / columns, rows), 0.0);
    let targets: Vec<_> = (0..columns * rows).map(at).collect();
    Scene { control: targets.len(), targets, ..board(lens()) }
}

/// A board from near, with a lens that pictures angles.
fn fisheyed() -> Scene {
    let k = [0.02, -0.01, 0.0, 0.0];
    let lens: Camera = OpenCvFisheye { size: SIZE, fx: 520.0, fy: 520.0, cx: 790.0, cy: 610.0, skew: 0.0, k }.into();
    let middle = Point3::new(120.0, 90.0, 0.0);
    let station = |i: i32| {
        let (sin, cos) = (0.9 * f64::from(i)).sin_cos();
        let at = middle + Vector3::new(70.0 * cos, 60.0 * sin, 90.0 + 6.0 * f64::from(i));
        Pose::looking_at(at, middle + Vector3::new(30.0 * sin, 20.0 * cos, 0.0), Vector3::y(), 0.7 * f64::from(i)).unwrap()
    };
    Scene { poses: (0..8).map(station).collect(), ..board(lens) }
}

/// A lens as of a part of a sensor, or one that is shifted.
fn off_the_middle() -> Camera {
    let mut distortion = [0.0; 14];
    distortion[..5].copy_from_slice(&[-0.11, 0.07, 4e-4, -6e-4, -0.012]);
    OpenCv { size: SIZE, fx: 1450.0, fy: 1446.0, cx: 880.0, cy: 660.0, distortion, coefficients: 5 }.into()
}

/// The same photographs turned by a right angle.
fn upright(scene: &Scene) -> Input {
    let right = f64::from(SIZE.height) - 1.0;
    let (points, control, settings) = of_size(scene, [SIZE.height, SIZE.width]);
    (moved(&points, |at| PixelPoint::new(right - at.y, at.x)), control, settings)
}

/// A lens with one scale.
fn square() -> Camera {
    let mut distortion = [0.0; 14];
    distortion[..2].copy_from_slice(&[-0.11, 0.07]);
    OpenCv { size: SIZE, fx: 1450.0, fy: 1450.0, cx: 812.0, cy: 590.0, distortion, coefficients: 5 }.into()
}

fn double_sphere() -> Camera {
    DoubleSphere { size: SIZE, fx: 420.0, fy: 420.0, cx: 790.0, cy: 610.0, xi: -0.15, alpha: 0.56 }.into()
}

/// Points and control of a wall with a board of 6 x 4 corners on it, `side` apart, that are named as a board's.
pub fn among_control(side: f64, seed: u64) -> (Points, Vec<ControlRow>) {
    const ON_WALL: usize = 48;
    let wall = wall(lens());
    let corner = |k: usize| Point3::new(600.0 + side * (k % 6) as f64, 700.0 + side * (k / 6) as f64, 250.0);
    let targets: Vec<_> = wall.targets.iter().copied().chain((0..24).map(corner)).collect();
    let scene = noisy(Scene { control: targets.len(), targets, ..wall }, seed);
    let named = |name: &str| {
        let k: usize = name[1..].parse().unwrap();
        if k < ON_WALL { name.to_owned() } else { format!("r{}c{}", (k - ON_WALL) / 6 + 1, (k - ON_WALL) % 6 + 1) }
    };
    let seen = scene.points();
    let mut points = Points::with_capacity(seen.len());
    seen.rows().enumerate().for_each(|(row, point)| points.push(point.image, &named(point.target), seen.start(row)));
    (points, scene.known().into_iter().map(|row| ControlRow { target: named(&row.target), ..row }).collect())
}
