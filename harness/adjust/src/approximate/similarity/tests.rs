use nalgebra::{Matrix4, Rotation3, UnitQuaternion, Vector4};

use super::*;
use crate::approximate::shape::ascending;
use crate::approximate::tests::Chance;

fn moved(chance: &mut Chance, points: &[Point3<f64>]) -> (Similarity, Vec<Point3<f64>>) {
    let rotation = *Rotation3::new(chance.vector() * 2.0).matrix();
    let truth = Similarity { scale: chance.between(0.01, 100.0), rotation, translation: chance.vector() * 1000.0, rms: 0.0 };
    (truth, points.iter().map(|point| truth.apply(point)).collect())
}

/// Horn's quaternion: the largest eigenvector of a 4 x 4 matrix.
fn horn(from: &[Point3<f64>], to: &[Point3<f64>]) -> Matrix3<f64> {
    let mean = |points: &[Point3<f64>]| points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / points.len() as f64;
    let (a, b) = (mean(from), mean(to));
    let s = from.iter().zip(to).map(|(p, q)| (p.coords - a) * (q.coords - b).transpose()).sum::<Matrix3<f64>>();
    let cross = Vector3::new(s[(1, 2)] - s[(2, 1)], s[(2, 0)] - s[(0, 2)], s[(0, 1)] - s[(1, 0)]);
    let mut n = Matrix4::zeros();
    n[(0, 0)] = s.trace();
    n.fixed_view_mut::<1, 3>(0, 1).copy_from(&cross.transpose());
    n.fixed_view_mut::<3, 1>(1, 0).copy_from(&cross);
    n.fixed_view_mut::<3, 3>(1, 1).copy_from(&(s + s.transpose() - Matrix3::identity() * s.trace()));
    let q: Vector4<f64> = ascending(n).1.column(3).into();
    *UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3])).to_rotation_matrix().matrix()
}

proptest::proptest! {
    #[test]
    fn exact_points_give_the_exact_similarity(seed in 0_u64..1_000_000, count in 4_usize..30) {
        let mut chance = Chance::new(seed);
        let from = chance.points(count);
        let (truth, to) = moved(&mut chance, &from);
        let found = similarity(&from, &to, true).unwrap();
        proptest::prop_assert!((found.scale / truth.scale - 1.0).abs() < 1e-9);
        proptest::prop_assert!((found.rotation - truth.rotation).norm() < 1e-9);
        proptest::prop_assert!((found.translation - truth.translation).norm() < 1e-9 * (truth.translation.norm() + truth.scale));
        proptest::prop_assert!(found.rms < 1e-9 * truth.translation.norm().max(truth.scale));
    }

    #[test]
    fn horns_quaternion_agrees_under_noise(seed in 0_u64..1_000_000) {
        let mut chance = Chance::new(seed);
        let from = chance.points(10);
        let (truth, to) = moved(&mut chance, &from);
        let to: Vec<_> = to.iter().map(|p| p + chance.vector() * 0.05 * truth.scale).collect();
        let found = similarity(&from, &to, true).unwrap();
        proptest::prop_assert!((found.rotation - horn(&from, &to)).norm() < 1e-8);
        let rigid = similarity(&from, &to, false).unwrap();
        proptest::prop_assert!(rigid.scale == 1.0 && (rigid.rotation - found.rotation).norm() < 1e-12);
        // A flat place: no small change of the scale or the rotation does better.
        let rms = |s: &Similarity| from.iter().zip(&to).map(|(a, b)| (s.apply(a) - b).norm_squared()).sum::<f64>() / 10.0;
        proptest::prop_assert!((rms(&found).sqrt() / found.rms - 1.0).abs() < 1e-6);
        let mean = from.iter().map(|p| p.coords).sum::<Vector3<f64>>() / 10.0;
        let kept = |scale: f64, rotation: Matrix3<f64>| {
            let translation = found.scale * found.rotation * mean + found.translation - scale * rotation * mean;
            Similarity { scale, rotation, translation, rms: 0.0 }
        };
        let turned = Rotation3::new(chance.vector() * 1e-3).matrix() * found.rotation;
        for other in [kept(found.scale * 1.001, found.rotation), kept(found.scale * 0.999, found.rotation), kept(found.scale, turned)] {
            proptest::prop_assert!(rms(&other) > rms(&found));
        }
    }
}

#[test]
fn three_points_and_planes_are_enough_and_lines_are_not() {
    let mut chance = Chance::new(41);
    let from = chance.points(3);
    let (truth, to) = moved(&mut chance, &from);
    let found = similarity(&from, &to, true).unwrap();
    assert!((found.rotation - truth.rotation).norm() < 1e-9);
    let line: Vec<_> = (0..5).map(|i| Point3::new(f64::from(i), 1.0, 2.0 * f64::from(i))).collect();
    assert_eq!(similarity(&line, &chance.points(5), true), Err(ApproximateError::Collinear));
    assert_eq!(similarity(&chance.points(5), &line, true), Err(ApproximateError::Collinear));
    assert!(matches!(similarity(&from[..2], &to, true), Err(ApproximateError::TooFew { found: 2, .. })));
    let broken = [from[0], Point3::new(f64::NAN, 0.0, 0.0), from[2]];
    assert_eq!(similarity(&broken, &to, true), Err(ApproximateError::NotFinite { index: 1 }));
}

#[test]
fn a_mirror_image_is_met_by_a_rotation() {
    let mut chance = Chance::new(42);
    let from = chance.points(12);
    let mirrored: Vec<_> = from.iter().map(|p| Point3::new(-p.x, p.y, p.z)).collect();
    let found = similarity(&from, &mirrored, true).unwrap();
    assert!((found.rotation.determinant() - 1.0).abs() < 1e-12 && found.rms > 0.1);
    // The octahedron's mirror image is met by many rotations.
    let octahedron =
        [Vector3::x(), Vector3::y(), Vector3::z()].iter().flat_map(|v| [Point3::from(*v), Point3::from(-v)]).collect::<Vec<_>>();
    let inverted: Vec<_> = octahedron.iter().map(|p| Point3::from(-p.coords)).collect();
    assert_eq!(similarity(&octahedron, &inverted, true), Err(CRITICAL));
}
