//! Targets of the coded field among its lines and the other targets, as tilted by 45 degrees.

use calibench_model::{Affine, Image, PixelPoint, Start, TargetKind};

use crate::operator::Operator;
use crate::registry::Registry;
use crate::tests::closed_form_images::{Noise, Picture};

const SIDE: usize = 41;
/// Scale of the recordings, px per mm.
const SCALE: f64 = 0.48;
/// Half a target's cell, and half a line beyond it, mm.
const CELL: (f64, f64) = (15.375, 1.0);
/// Kinds with their sizes, mm.
const TYPES: [(TargetKind, f64); 8] = [
    (TargetKind::Square, 9.0),
    (TargetKind::Triangle, 13.0),
    (TargetKind::Cross, 15.0),
    (TargetKind::Disc, 13.0),
    (TargetKind::Square, 17.0),
    (TargetKind::Triangle, 25.0),
    (TargetKind::Cross, 25.0),
    (TargetKind::Disc, 24.0),
];
const VARIANTS: usize = 16;
const TRIALS: usize = 6;
/// What signal-to-noise ratios of 46 and 26 dB leave as noise, in units of the contrast.
const NOISE: [f64; 2] = [0.005, 0.05];

/// How the field lies in the image: tilted about an upright axis, and rolled.
struct View {
    roll: f64,
    at: [f64; 2],
}

impl View {
    /// A shape at (`u`, `v`) mm from the target, of these lengths along its own axes, mm, turned by `turn`.
    fn shape(&self, kind: TargetKind, [u, v]: [f64; 2], [along, across]: [f64; 2], turn: f64) -> Picture {
        let (sin, cos) = turn.sin_cos();
        let map = |[u, v]: [f64; 2]| {
            let (s, c) = self.roll.sin_cos();
            let (x, y) = (SCALE * std::f64::consts::FRAC_1_SQRT_2 * u, SCALE * v);
            [c * x - s * y, s * x + c * y]
        };
        let [axx, ayx] = map([along * cos, along * sin]);
        let [axy, ayy] = map([-across * sin, across * cos]);
        let [x, y] = map([u, v]);
        let at = [self.at[0] + x, self.at[1] + y];
        Picture { kind, at, affine: Affine { axx, axy, ayx, ayy }, sigma: 0.6, ground: 0.0, contrast: 1.0 }
    }
}

/// A target, and the coverages of its image alone and among lines and other targets.
struct Scene {
    target: Picture,
    alone: Vec<f64>,
    crowded: Vec<f64>,
}

fn fraction(variant: usize, step: f64) -> f64 {
    (variant as f64 * step + 0.37).fract()
}

fn scene(index: usize, variant: usize) -> Scene {
    let (kind, size) = TYPES[index];
    let spread = |step: f64| 2.0 * fraction(variant * 8 + index, step) - 1.0;
    let view = View { roll: spread(0.618_034) * 3.0, at: [20.0 + 0.5 * spread(0.754_878), 20.0 + 0.5 * spread(0.569_84)] };
    let reach = match kind {
        TargetKind::Disc => 0.5,
        TargetKind::Triangle => 1.0 / 3.0_f64.sqrt(),
        TargetKind::Cross => 0.527_046,
        _ => 0.5_f64.sqrt(),
    };
    // As far from the middle of its cell as the field allows it; the cell is one of the sixteen between lines.
    let slack = (CELL.0 - reach * size - 3.0).max(0.0);
    let place = [slack * spread(0.313), slack * spread(0.777)];
    let target = view.shape(kind, [0.0, 0.0], [size, size], 3.2 * spread(0.431));
    let cell = [variant % 4, variant / 4 % 4];
    let mut beside = Vec::new();
    for (number, (axis, side)) in [(0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0)].into_iter().enumerate() {
        let mut at = place.map(|p| -p);
        let last = cell[axis] == if side < 0.0 { 0 } else { 3 };
        if last {
            at[axis] += side * (CELL.0 + CELL.1);
            let lengths = if axis == 0 { [2.0 * CELL.1, 300.0] } else { [300.0, 2.0 * CELL.1] };
            beside.push(view.shape(TargetKind::Square, at, lengths, 0.0));
            at[axis] += side * CELL.1;
        } else {
            at[axis] += side * CELL.0;
        }
        at[axis] += side * CELL.0;
        let (kind, size) = TYPES[(index + variant + 3 * number) % 8];
        beside.push(view.shape(kind, at, [size, size], spread(0.2 + 0.1 * number as f64)));
    }
    let alone = target.grey(SIDE);
    let mut crowded = alone.clone();
    for other in beside {
        crowded.iter_mut().zip(other.grey(SIDE)).for_each(|(sum, covered)| *sum = (*sum + covered).min(1.0));
    }
    Scene { target, alone, crowded }
}

fn image(coverage: &[f64]) -> Image<'static> {
    Image::new(SIDE, SIDE, coverage.iter().map(|covered| (0.85 - 0.8 * covered) as f32).collect())
}

/// As a start is: half a pixel off at a whole pixel, turned by 5 degrees and stretched by a tenth.
fn start(target: &Picture, noise: &mut Noise) -> Start {
    let at = [0, 1].map(|axis| (target.at[axis] + 0.5 * noise.normal()).round());
    let ((sin, cos), u, v) = ((0.087 * noise.normal()).sin_cos(), (0.1 * noise.normal()).exp(), (0.1 * noise.normal()).exp());
    let a = target.affine;
    let affine = Affine {
        axx: u * (cos * a.axx - sin * a.ayx),
        axy: v * (cos * a.axy - sin * a.ayy),
        ayx: u * (sin * a.axx + cos * a.ayx),
        ayy: v * (sin * a.axy + cos * a.ayy),
    };
    Start { kind: Some(target.kind), affine: Some(affine), ..Start::at(PixelPoint::new(at[0], at[1])) }
}

fn operator(spec: &str) -> Box<dyn Operator> {
    Registry::builtin().parse(spec).unwrap().operator.unwrap()
}

/// RMSE per axis, px, and how many are lost, alone and crowded.
fn measured(operator: &dyn Operator, scenes: &[Scene], level: f64) -> [(f64, usize); 2] {
    let mut noise = Noise(46);
    let mut sums = [(0.0, 0, 0); 2];
    for scene in scenes {
        for _ in 0..TRIALS {
            let start = start(&scene.target, &mut noise);
            for (coverage, (square, count, lost)) in [&scene.alone, &scene.crowded].into_iter().zip(&mut sums) {
                match operator.measure(&noise.on(&image(coverage), 0.8 * level), &start) {
                    Ok(found) => {
                        *square += found.position.distance(PixelPoint::new(scene.target.at[0], scene.target.at[1])).powi(2);
                        *count += 1;
                    }
                    Err(_) => *lost += 1,
                }
            }
        }
    }
    sums.map(|(square, count, lost): (f64, i32, usize)| ((square / f64::from(count) / 2.0).sqrt(), lost))
}

#[test]
fn what_stands_beside_a_target_does_not_count() {
    let operators = [13, 15].map(|window| operator(&format!("lsm:window={window}")));
    let (mut lost, mut points) = (0, 0);
    for (index, (kind, size)) in TYPES.into_iter().enumerate() {
        let scenes: Vec<Scene> = (0..VARIANTS).map(|variant| scene(index, variant)).collect();
        for operator in &operators {
            let [fine, coarse] = NOISE.map(|level| measured(&**operator, &scenes, level));
            println!("{kind} of {size} mm, alone and crowded: {fine:.4?} at 46 dB, {coarse:.4?} at 26 dB");
            assert!(fine[1].0 <= 0.010, "{kind} of {size} mm: {fine:?}");
            assert!(coarse[1].0 <= 1.3 * coarse[0].0, "{kind} of {size} mm: {coarse:?}");
            lost += fine[1].1 + coarse[1].1;
            points += 2 * VARIANTS * TRIALS;
        }
    }
    assert!(200 * lost < points, "{lost} of {points} are lost");
}

/// Next to the image's border the window is laid inside, and what is found is as good.
#[test]
fn a_target_in_view_needs_no_window_around_it() {
    let operator = operator("lsm:window=15");
    let mut noise = Noise(5);
    for index in 0..8 {
        let scene = scene(index, 1);
        let whole = image(&scene.alone);
        let first = scene.target.at.map(|c| (c - 5.5).floor() as usize);
        let cut = Image::from_fn(27, 27, |x, y| whole.at(x + first[0], y + first[1]));
        let start = start(&scene.target, &mut noise);
        let moved = PixelPoint::new(start.position.x - first[0] as f64, start.position.y - first[1] as f64);
        let found = operator.measure(&cut, &Start { position: moved, ..start }).unwrap();
        let truth = PixelPoint::new(scene.target.at[0] - first[0] as f64, scene.target.at[1] - first[1] as f64);
        assert!(found.position.distance(truth) < 1e-4, "{index}: {:e}", found.position.distance(truth));
        let off = Start { affine: None, ..Start { position: PixelPoint::new(5.0, 5.0), ..start } };
        assert_eq!(operator.measure(&cut, &off).unwrap_err(), calibench_model::Rejection::Border);
    }
}

/// Something between ink and paper covers half of a disc of 14 px, or a little less: what stands before a target is not beside it.
#[test]
fn no_disc_that_is_half_covered_is_a_pixel_off_without_a_word() {
    let operator = operator("lsm:window=15");
    let mut noise = Noise(14);
    let square = |side: f64| Affine { axx: side, axy: 0.0, ayx: 0.0, ayy: side };
    let picture = |kind, at, side| Picture { kind, at, affine: square(side), sigma: 0.7, ground: 0.0, contrast: 1.0 };
    let mut found = 0;
    for place in 0..300 {
        let border = 1.0 + f64::from(place % 3);
        let at = [0.618_034, 0.754_878].map(|step| 19.5 + (f64::from(place) * step).fract());
        let disc = picture(TargetKind::Disc, at, 14.0);
        let cover = picture(TargetKind::Square, [at[0] + border + 30.0, at[1]], 60.0);
        let light =
            disc.grey(SIDE).into_iter().zip(cover.grey(SIDE)).map(|(disc, cover)| (0.85 - 0.8 * disc) * (1.0 - cover) + 0.45 * cover);
        let image = noise.on(&Image::new(SIDE, SIDE, light.map(|grey| grey as f32).collect()), 0.02);
        if let Ok(measured) = operator.measure(&image, &start(&disc, &mut noise)) {
            let off = measured.position.distance(PixelPoint::new(at[0], at[1]));
            assert!(off < 1.0, "{off} px, covered from {border} px on");
            found += 1;
        }
    }
    assert!(found < 15, "{found} of 300 are measured");
}
