//! How wide lenses warp what is pictured, beside what a board's points tell of it.

use calibench_detect::{Found, FoundPoint, detect, warps};
use calibench_model::boards::{Board, Chessboard};
use calibench_model::camera::ImageSize;
use calibench_model::{Affine, PixelPoint};

use super::scene::{Random, Scene};

/// Half the side of a window, px.
const HALF: f64 = 7.0;

/// The normals of the lines through a point of the board, along its axes, and their curvatures as the lens has them, by differences; `None` near the border.
fn lines(scene: &Scene, [u, v]: [f64; 2]) -> Option<[([f64; 2], f64); 2]> {
    let step = 1e-3;
    let along = |[a, b]: [f64; 2]| {
        let at = |times: f64| scene.at([u + times * step * a, v + times * step * b]);
        let [behind, here, ahead] = [at(-1.0)?, at(0.0)?, at(1.0)?];
        let chord = (ahead.x - behind.x).hypot(ahead.y - behind.y);
        let normal = [-(ahead.y - behind.y) / chord, (ahead.x - behind.x) / chord];
        let off = [here.x - 0.5 * (ahead.x + behind.x), here.y - 0.5 * (ahead.y + behind.y)];
        Some((normal, 8.0 * (off[0] * normal[0] + off[1] * normal[1]) / (chord * chord)))
    };
    Some([along([1.0, 0.0])?, along([0.0, 1.0])?])
}

fn found(scene: &Scene, noise: f64, random: &mut Random) -> Found {
    let affine = Affine { axx: 1.0, axy: 0.0, ayx: 0.0, ayy: 1.0 };
    // Of one variance, between limits.
    let mut off = || noise * random.between(-1.0, 1.0) * 3.0_f64.sqrt();
    let point = |(index, at): (usize, PixelPoint)| FoundPoint { index, position: PixelPoint::new(at.x + off(), at.y + off()), affine };
    Found { points: scene.corners().into_iter().enumerate().map(point).collect(), markers: 0, doubts: Vec::new(), light: false }
}

/// By how much arcs within a window are farther off their tangents than the lens has them, px, and how far it has them: RMS over all points of scenes with a field of so many degrees.
/// Positions are `noise` px off, RMS, and the middle of the lens is `shift` px beside that of the image.
fn off(field: [f64; 2], noise: f64, shift: u32) -> [f64; 2] {
    let mut random = Random::new(7);
    let mut all = Vec::new();
    for scene in (0..60).map(|seed| Scene::of(seed, field)) {
        let ImageSize { width, height } = scene.size();
        let size = ImageSize { width: width + 2 * shift, height: height - shift };
        all.extend(off_in(&scene, &found(&scene, noise, &mut random), size));
    }
    rms(&all)
}

fn off_in(scene: &Scene, found: &Found, size: ImageSize) -> Vec<[f64; 2]> {
    let sagitta = |curvature: f64| 0.5 * HALF * HALF * curvature.abs();
    let mut all = Vec::new();
    for (point, told) in found.points.iter().zip(warps(&scene.layout, found, size)) {
        let Some(truth) = lines(scene, scene.layout.points[point.index].at) else { continue };
        let told = told.unwrap_or_default();
        all.extend(truth.map(|(normal, curvature)| [sagitta(told.curvature(normal) - curvature), sagitta(curvature)]));
    }
    all
}

fn rms(all: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|which| (all.iter().map(|pair| pair[which].powi(2)).sum::<f64>() / all.len() as f64).sqrt())
}

#[test]
fn points_tell_how_lines_are_curved() {
    let wide = [60.0, 200.0];
    for (noise, shift, most) in [(0.0, 0, 3e-4), (0.03, 0, 1.2e-3), (0.1, 0, 3.5e-3), (0.1, 10, 5e-3)] {
        let [told, lens] = off(wide, noise, shift);
        println!("{noise} px off, middle {shift} px aside: {told:.1e} px of {lens:.1e}");
        assert!(told < most && lens > 0.02, "{told:e} {lens:e}");
    }
}

#[test]
fn lenses_that_curve_nothing_are_told_apart() {
    let [told, lens] = off([25.0, 50.0], 0.1, 0);
    println!("{told:.1e} px of {lens:.1e}");
    assert!(told < 2e-3 && lens < 2e-3, "{told:e} {lens:e}");
}

#[test]
fn detected_points_tell_it_too() {
    let mut all = Vec::new();
    for scene in (0..40).map(|seed| Scene::of(seed, [60.0, 200.0])) {
        let board = Board::Chessboard(Chessboard { columns: scene.columns, rows: scene.rows, square: 1.0 });
        let Ok(found) = detect(&scene.picture(), &board) else { continue };
        let corners = scene.corners();
        // Counted from another end the places of the layout are others.
        if found.points.iter().all(|point| corners[point.index].distance(point.position) < 2.0) {
            all.extend(off_in(&scene, &found, scene.size()));
        }
    }
    let [told, lens] = rms(&all);
    println!("of {} lines: {told:.1e} px of {lens:.1e}", all.len());
    assert!(all.len() > 1000 && told < 4e-3 && lens > 0.02, "{told:e} {lens:e}");
}
