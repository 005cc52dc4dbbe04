//! Images of known making, rendered, and what is found in them.

use calibench_model::camera::{Camera, ImageSize, Photogrammetric};
use calibench_model::{Image, Pose};
use calibench_random::Key;
use calibench_synth::optics::{Motion, Optics};
use calibench_synth::raster::Renderer;
use calibench_synth::sensor::{Design as SensorDesign, Gradient, Noise, Per, Processing, Sensor};
use calibench_synth::testfield::{Chessboard, Levels};
use calibench_synth::view::View;
use nalgebra::{Point3, Vector3};

use crate::look::{INK, Light, Look, PAPER, ViewLook, across, noise_line};
use crate::{Design, Geometry, Scene, Tone, fitted, written};

const KEY: Key<'_> = Key { seed: 5, of: "twin", trial: 0, view: "", target: "" };
const SIZE: [f64; 2] = [640.0, 480.0];
const BOARD: Chessboard = Chessboard {
    rows: 6,
    columns: 9,
    square: 25.0,
    margin: 20.0,
    bend: None,
    print_noise: 0.0,
    levels: Levels { paper: PAPER, ink: INK },
    background: 0.4,
};

fn camera() -> Camera {
    let size = ImageSize { width: SIZE[0] as u32, height: SIZE[1] as u32 };
    let mm = |c| Photogrammetric { size, pitch_um: 10.0, c, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] };
    Camera::Photogrammetric(mm(6.0))
}

fn poses() -> Vec<Pose> {
    let middle = Point3::new(100.0, -62.5, 0.0);
    let from =
        |dx: f64, dy: f64, dz: f64, roll: f64| Pose::looking_at(middle + Vector3::new(dx, dy, dz), middle, Vector3::y(), roll).unwrap();
    vec![from(0.0, 0.0, 380.0, 0.1), from(120.0, -60.0, 330.0, 0.4), from(-150.0, 40.0, 350.0, -0.2), from(30.0, 160.0, 340.0, 0.9)]
}

fn geometry() -> Geometry {
    let corners = (0..BOARD.rows).flat_map(|row| (0..BOARD.columns).map(move |column| [column as f64 * 25.0, -(row as f64) * 25.0, 0.0]));
    Geometry::new(camera(), [BOARD.rows, BOARD.columns], corners)
}

/// The image from `pose`, numbered `trial`.
fn image(pose: &Pose, optics: &Optics, sensor: &SensorDesign, trial: u64) -> Image<'static> {
    let (field, camera) = (BOARD.generate(KEY).unwrap(), camera());
    let view = View { field: &field, camera: &camera, local: None, pose };
    let picture = view.seen(optics.reach()).unwrap().picture().unwrap();
    let light = Renderer::new(optics, SIZE[0] as usize, SIZE[1] as usize).unwrap().render(&picture, &[]);
    Sensor::new(sensor.clone()).unwrap().expose(light, Key { trial, ..KEY }).unwrap().image
}

fn looks(optics: &Optics, sensor: &SensorDesign) -> Vec<ViewLook> {
    let geometry = geometry();
    let one = |(trial, pose): (usize, &Pose)| ViewLook::of(&image(pose, optics, sensor, trial as u64), &geometry, pose);
    poses().iter().enumerate().map(one).collect()
}

fn look(optics: &Optics, sensor: &SensorDesign) -> Look {
    let sides: Vec<f64> = poses().iter().map(|pose| geometry().side(pose)).collect();
    Look::of(&looks(optics, sensor), SIZE, &sides).unwrap()
}

fn white(sigma: f64) -> SensorDesign {
    SensorDesign { exposure: 0.8, noise: Noise::White { sigma, prnu: 0.0 }, ..SensorDesign::default() }
}

#[test]
fn the_spread_of_edges_is_that_of_blur_and_pixel() {
    for blur in [0.4, 0.8, 1.3] {
        let look = look(&Optics { blur, ..Optics::default() }, &white(0.002));
        let expected = (blur * blur + 1.0 / 12.0).sqrt();
        assert!((look.spread() / expected - 1.0).abs() < 0.02, "{blur}: {} {expected}", look.spread());
        assert!(look.corner.abs() < 0.02, "{}", look.corner);
        assert!(look.raggedness.unwrap().value < 2e-4 && look.shift.unwrap().value.abs() < 1e-4, "{look:?}");
    }
}

#[test]
fn a_motion_widens_edges_by_its_part_across_them() {
    let motion = Motion { length: 3.0, direction: 0.6 };
    let optics = Optics { blur: 0.6, motion: Some(motion), ..Optics::default() };
    let look = look(&optics, &white(0.002));
    for (spread, pose) in look.spreads.iter().zip(poses()) {
        for edge in geometry().edges(&pose) {
            let [x, y] = edge.normal();
            let part = motion.length * (x * motion.direction.cos() + y * motion.direction.sin());
            let expected = 0.36 + (1.0 + part * part) / 12.0;
            let found = across(&spread.unwrap(), [x, y]);
            assert!((found / expected - 1.0).abs() < 0.12, "{x} {y}: {found} {expected}");
        }
    }
    let smears = Design::first(&look, false).unwrap().views.into_iter().map(|view| view.smear());
    assert!(smears.into_iter().all(|smear| smear.motion.is_some_and(|[dx, dy]| dx.hypot(dy) > 2.0 && dx * dy >= -0.1)));
}

#[test]
fn light_and_its_gradient_are_found() {
    let gradient = Gradient { x: 0.3, y: -0.2, per: Per::Frame };
    let look = look(&Optics { blur: 0.7, ..Optics::default() }, &SensorDesign { gradient: Some(gradient), ..white(0.002) });
    for light in look.lights(Tone::default()) {
        let Light { exposure, veil, gradient: [x, y] } = light.unwrap();
        assert!((exposure - 0.8).abs() < 0.01 && veil.abs() < 0.005, "{light:?}");
        assert!((x - 0.3).abs() < 0.02 && (y + 0.2).abs() < 0.02, "{light:?}");
    }
}

#[test]
fn noise_and_its_whiteness_are_found() {
    let looks = looks(&Optics { blur: 0.7, ..Optics::default() }, &white(0.01));
    let line = noise_line(&looks.iter().flat_map(|view| view.squares.clone()).collect::<Vec<_>>(), Tone::default()).unwrap();
    assert!((line.at(0.4).sqrt() / 0.01 - 1.0).abs() < 0.03, "{line:?}");
    let all: Vec<f64> = looks.iter().flat_map(|view| &view.squares).map(|square| square.correlation[0]).collect();
    assert!((all.iter().sum::<f64>() / all.len() as f64).abs() < 0.03);
}

/// What makes images and what finds their making agree: a twin of a twin has its making.
#[test]
fn the_twin_of_a_simulation_is_made_like_it() {
    let (blur, sigma) = (0.9, 0.008);
    let real = look(&Optics { blur, ..Optics::default() }, &white(sigma));
    let found = fitted(&real, |design, trial| {
        let geometry = geometry();
        let sides: Vec<f64> = poses().iter().map(|pose| geometry.side(pose)).collect();
        let one = |(pose, view): (&Pose, &crate::ViewDesign)| {
            let optics = Optics { blur: view.smear().blur, ..Optics::default() };
            let noise = Noise::White { sigma: design.noise.at(0.4).sqrt(), prnu: 0.0 };
            let sensor = SensorDesign { exposure: view.light.exposure, noise, ..SensorDesign::default() };
            ViewLook::of(&image(pose, &optics, &sensor, 50 + trial), &geometry, pose)
        };
        let looks: Vec<ViewLook> = poses().iter().zip(&design.views).map(one).collect();
        Ok::<_, ()>(Look::of(&looks, SIZE, &sides))
    });
    let design = found.unwrap().unwrap().design;
    for view in &design.views {
        assert!((view.smear().blur / blur - 1.0).abs() < 0.03, "{:?}", view.smear());
    }
    assert!((design.noise.at(0.4).sqrt() / sigma - 1.0).abs() < 0.05, "{:?}", design.noise);
    assert!(design.smoothing < 0.3 && design.halo.abs() < 0.1, "{design:?}");
}

#[test]
fn smoothed_noise_has_the_correlation_of_its_gaussian_in_both_directions() {
    let smoothing = 0.8;
    let processing = Some(Processing { smoothing, sharpening: 0.0, radius: 1.0 });
    let looks = looks(&Optics { blur: 0.7, ..Optics::default() }, &SensorDesign { processing, ..white(0.02) });
    let expected = (-0.25 / (smoothing * smoothing)).exp();
    for direction in 0..2 {
        let all: Vec<f64> = looks.iter().flat_map(|view| &view.squares).map(|square| square.correlation[direction]).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        assert!((mean - expected).abs() < 0.03, "{direction}: {mean} {expected}");
    }
}

#[test]
fn edges_overshoot_where_they_were_sharpened_and_tail_off_where_light_is_spread() {
    let halo = |optics: Optics, sharpening: f64| {
        let processing = Some(Processing { smoothing: 0.0, sharpening, radius: 1.0 });
        look(&optics, &SensorDesign { processing, ..white(0.002) }).halo.unwrap().value
    };
    let plain = Optics { blur: 0.8, ..Optics::default() };
    let tail = Some(calibench_synth::optics::Tail { share: 0.2, blur: 2.5 });
    let [sharp, usual, tailed] = [halo(plain, 1.0), halo(plain, 0.0), halo(Optics { tail, ..plain }, 0.0)];
    assert!(sharp > usual + 0.02 && tailed < usual - 0.005, "{sharp} {usual} {tailed}");
}

/// What the next design has more is what photographs have more than the twin.
#[test]
fn light_and_ink_follow_what_photographs_have_more() {
    let optics = Optics { blur: 0.8, ..Optics::default() };
    let real = look(&optics, &SensorDesign { veil: 0.06, exposure: 0.7, ..white(0.003) });
    let twin = look(&optics, &white(0.003));
    let before = Design::first(&twin, false).unwrap();
    let next = before.nearer(&real, &twin, None);
    for (old, new) in before.views.iter().zip(&next.views) {
        assert!((new.light.veil - old.light.veil - 0.06).abs() < 0.005, "{:?} {:?}", old.light, new.light);
        assert!((new.light.exposure / old.light.exposure - 0.7 / 0.8).abs() < 0.01, "{:?} {:?}", old.light, new.light);
    }
}

#[test]
fn a_shoulder_has_four_times_the_light_below_it_and_noise_as_without_it() {
    let scene = Scene {
        why: "w".into(),
        source: "s".into(),
        camera: "c".into(),
        board: "b".into(),
        rows: 6,
        columns: 9,
        square: 25.0,
        stations: vec![("a".into(), poses()[0])],
        tables: None,
        bits: 8,
        side: 40.0,
        seed: 1,
    };
    let noise = crate::look::NoiseLine { dark: 1e-6, slope: 4e-4 };
    let plain = Design { noise, ..Design::plain(1) };
    let bent = Design { tone: Tone { shoulder: 0.25 }, ..plain.clone() };
    let number = |text: &str, key: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(&format!("{key} = "))).unwrap_or_else(|| panic!("{key}: {text}"));
        line.parse::<f64>().unwrap()
    };
    let [plain, bent] = [plain, bent].map(|design| written(&scene, &design));
    assert!((number(&plain, "exposure") / number(&bent, "exposure") - 4.0).abs() < 1e-3);
    // Variance over level: electrons at white; the white of the sensor is four times as bright.
    assert!((number(&plain, "full_well") - 2500.0).abs() < 0.1 && (number(&bent, "full_well") - 10_000.0).abs() < 0.1);
    // Read noise in electrons is that of the same light.
    assert!((number(&plain, "read_noise") - number(&bent, "read_noise")).abs() < 1e-2);
    assert!(bent.contains("shoulder = { start = 0.7500, gain = 4 }") && !plain.contains("shoulder"));
}
