//! Views of a bent sheet by a camera with local distortion: the image against rays, the truth against differences and against the image itself.

use calibench_model::{PixelPoint, TargetKind};
use calibench_random::Key;
use nalgebra::{Matrix2, Vector2};

use super::*;
use crate::local::{LocalDesign, LocalDistortion};
use crate::view::TargetTruth;

const KEY: Key<'_> = Key { seed: 5, of: "local", trial: 0, view: "", target: "" };
/// Some pixels large, and smooth over a few targets.
const DESIGN: LocalDesign = LocalDesign { sigma: 1.2, correlation: 14.0 };

fn local(design: LocalDesign, size: ImageSize) -> LocalDistortion {
    LocalDistortion::draw(design, size, KEY).unwrap()
}

#[test]
fn a_view_with_local_distortion_agrees_with_rays() {
    let plates = vec![plate("wall", [0.0, 0.0, 0.0], 1.2, None), plate("near", [0.3, -0.1, 0.6], 0.4, None)];
    let field = field(plates);
    let local = local(DESIGN, SIZE);
    let camera = camera([-0.9, 0.4, 0.0]);
    // From near enough that the wall passes the frame on all sides, and from afar.
    for pose in [pose(0.2, 0.2, 1.1, 0.4), pose(1.4, -0.9, 2.0, -0.7)] {
        let view = View { field: &field, camera: &camera, local: Some(&local), pose: &pose };
        let found = difference(&view);
        assert!(found < RAYS_ERROR, "{pose:?}: {found}");
        let plain = View { local: None, ..view };
        let (displaced, plain) = (view.picture(3.0).unwrap(), plain.picture(3.0).unwrap());
        assert_ne!(displaced.pieces, plain.pieces);
    }
}

/// A bent sheet 1.2 m wide with a disc in its middle that nothing is near, and its view from the side.
fn disc_alone(bend: Bend) -> Testfield {
    let (at, size) = ([0.02, -0.03], 0.12);
    let disc = Area { outline: Outline::disc(at, 0.5 * size), level: 0.05, ground: 0.85 };
    let sheet = Plate { areas: vec![disc], level: 0.85, ..plate("a", [0.0, 0.0, 0.0], 0.6, Some(bend)) };
    let target = ObjectTarget { at, size, room: Some(0.01), ..disc_target(0, 1.0) };
    Testfield { plates: vec![sheet], targets: vec![target], background: 0.2 }
}

const BEND: Bend = Bend { peak: 0.05, middle: [0.1, 0.0], across: 0.4, reach: 0.5, along: 0.0 };

fn with_view(test: impl Fn(&View<'_>, &TargetTruth)) {
    let field = disc_alone(BEND);
    let camera = camera([-0.4, 0.1, 0.0]);
    for seed in 0..4 {
        let local = LocalDistortion::draw(DESIGN, SIZE, Key { seed, ..KEY }).unwrap();
        for pose in [pose(0.7, -0.3, 0.7, 0.4), pose(-0.2, 0.1, 0.9, 2.0)] {
            let view = View { field: &field, camera: &camera, local: Some(&local), pose: &pose };
            let truth = view.seen(4.0).unwrap().truth().remove(0);
            assert_eq!(truth.visibility, Visibility::Visible);
            test(&view, &truth);
        }
    }
}

/// The map by differences of images of points of the bent sheet around the target.
#[test]
fn the_affine_map_is_that_of_differences() {
    with_view(|view, truth| {
        let (plate, target) = (&view.field.plates[0], &view.field.targets[0]);
        let at = |du: f64, dv: f64| {
            let ray = view.pose.ray(&plate.point([target.at[0] + du, target.at[1] + dv]));
            view.local.unwrap().displaced(view.camera.project(ray).unwrap())
        };
        assert_eq!(truth.at, Some(at(0.0, 0.0)));
        assert_eq!(truth.object, plate.point(target.at));
        let h = 1e-5;
        let along = |[u, v]: [f64; 2]| {
            let (high, low) = (at(h * u, h * v), at(-h * u, -h * v));
            [high.x - low.x, high.y - low.y].map(|d| d / (2.0 * h) * target.size)
        };
        let [[axx, ayx], [axy, ayy]] = target.axes.map(along);
        let affine = truth.affine.unwrap();
        for (found, expected) in [(affine.axx, axx), (affine.axy, axy), (affine.ayx, ayx), (affine.ayy, ayy)] {
            assert!((found - expected).abs() < 1e-6, "{affine:?}, expected {expected}");
        }
    });
}

/// The border of the free square around the target, in the image: no nearer to the middle, along an axis of the image, than the room says, and as near somewhere.
#[test]
fn the_room_is_that_of_the_square_s_picture() {
    with_view(|view, truth| {
        let (plate, target) = (&view.field.plates[0], &view.field.targets[0]);
        let [u, v] = target.axes;
        let away = |s: f64, t: f64| {
            let ray = view.pose.ray(&plate.point([0, 1].map(|i| target.at[i] + 0.01 * (s * u[i] + t * v[i]))));
            let at = view.local.unwrap().displaced(view.camera.project(ray).unwrap());
            (at.x - truth.at.unwrap().x).abs().max((at.y - truth.at.unwrap().y).abs())
        };
        let sides = (-500..=500).map(|step| f64::from(step) / 500.0).flat_map(|s| [(s, 1.0), (s, -1.0), (1.0, s), (-1.0, s)]);
        let nearest = sides.map(|(s, t)| away(s, t)).fold(f64::INFINITY, f64::min);
        let room = truth.room.unwrap();
        assert!((nearest / room - 1.0).abs() < 0.05, "{nearest} px, {room} px");
    });
}

/// Centroid and second moments of what the disc takes away from the light, in the rendered image.
#[test]
fn the_ellipse_is_that_of_the_rendered_blob() {
    with_view(|view, truth| {
        let ellipse = truth.ellipse.unwrap();
        // Blurred, so that the sums over pixels are integrals.
        let optics = Optics { blur: 1.0, ..Optics::default() };
        let picture = view.picture(optics.reach()).unwrap();
        let image = Renderer::new(&optics, picture.width, picture.height).unwrap().render(&picture, &[]);
        let near = |x: usize, y: usize| ellipse.centre.distance(PixelPoint::new(x as f64, y as f64)) < ellipse.axes[0] + 7.0;
        let (mut area, mut first, mut second) = (0.0, Vector2::zeros(), Matrix2::zeros());
        for (x, y) in (0..picture.height).flat_map(|y| (0..picture.width).map(move |x| (x, y))).filter(|&(x, y)| near(x, y)) {
            let dark = (0.85 - f64::from(image.at(x, y))) / 0.8;
            let from = Vector2::new(x as f64 - ellipse.centre.x, y as f64 - ellipse.centre.y);
            area += dark;
            first += from * dark;
            // What blur and photosite add to the second moments.
            second += (from * from.transpose() - Matrix2::identity() * (1.0 + 1.0 / 12.0)) * dark;
        }
        let centre = first / area;
        assert!(centre.norm() < 1e-5, "{centre} px off");
        let (sine, cosine) = ellipse.angle.sin_cos();
        let [a, b] = ellipse.axes.map(|axis| axis * axis / 4.0);
        let turn = Matrix2::new(cosine, -sine, sine, cosine);
        let expected = turn * Matrix2::new(a, 0.0, 0.0, b) * turn.transpose();
        assert!((second / area - expected).norm() < 1e-4, "{} {expected}", second / area);
        assert!(ellipse.centre.distance(truth.at.unwrap()) > 0.005, "not the image of the centre");
        assert!(ellipse.axes[1] > 3.0 && view.field.targets[0].kind == TargetKind::Disc);
    });
}

/// What is true without them is true with a field of almost nothing.
#[test]
fn a_field_of_almost_nothing_changes_almost_nothing() {
    let field = disc_alone(BEND);
    let (camera, pose) = (camera([-0.4, 0.1, 0.0]), pose(0.7, -0.3, 0.7, 0.4));
    let local = local(LocalDesign { sigma: 1e-9, ..DESIGN }, SIZE);
    let plain = View { field: &field, camera: &camera, local: None, pose: &pose };
    let of = |view: &View<'_>| view.seen(4.0).unwrap().truth().remove(0);
    let (with, without) = (of(&View { local: Some(&local), ..plain }), of(&plain));
    assert!(with.at.unwrap().distance(without.at.unwrap()) < 1e-8);
    assert!(with.ellipse.unwrap().centre.distance(without.ellipse.unwrap().centre) < 1e-8);
}

#[test]
fn outlines_follow_the_field_to_a_hundred_thousandth_of_a_pixel() {
    let field =
        field(vec![plate("a", [0.0, 0.0, 0.0], 1.0, Some(Bend { peak: 0.2, middle: [0.1, 0.0], across: 0.4, reach: 1.0, along: 0.0 }))]);
    let (camera, pose) = (camera([-0.9, 0.4, 0.0]), pose(0.9, -0.5, 2.2, 0.4));
    for design in [DESIGN, LocalDesign { sigma: 0.033, correlation: 15.0 }, LocalDesign { sigma: 0.1, correlation: 3.0 }] {
        let local = local(design, SIZE);
        let view = View { field: &field, camera: &camera, local: Some(&local), pose: &pose };
        let picture = view.picture(5.0).unwrap();
        let plate = &field.plates[0];
        let (mut worst, mut inside) = (0.0_f64, 0);
        for curve in plate.areas.iter().flat_map(|area| &area.outline.0) {
            for i in 0..50 {
                let ray = pose.ray(&plate.point(curve.at((f64::from(i) + 0.37) / 50.0)));
                let at = local.displaced(camera.project(ray).unwrap());
                if at.x < 0.0 || at.y < 0.0 || at.x > 119.0 || at.y > 89.0 {
                    continue;
                }
                inside += 1;
                let nearest = picture.pieces.iter().map(|piece| rays::distance(piece, [at.x, at.y])).fold(f64::INFINITY, f64::min);
                worst = worst.max(nearest);
            }
        }
        assert!(worst < 2e-5 && inside > 400, "{design:?}: {worst:e} of {inside}, {} pieces", picture.pieces.len());
    }
}
