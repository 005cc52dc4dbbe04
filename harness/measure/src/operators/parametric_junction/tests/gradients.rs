//! Light that is not even, and photosites that are narrower than pixels.

use nalgebra::SVector;

use super::super::unknowns::Unknowns;
use super::super::window::Window;
use super::*;
use crate::following::Laid;
use crate::gradient::{ADDED, EACH, EVEN, LIGHT};
use crate::marquardt::Problem;

/// Half the derivative of the squared residuals is `-J^T r`: by differences, for unknowns that are far from right.
fn check_right_hand_side<const P: usize>(image: &Image, arms: usize, gradient: u8) {
    let unknowns = Unknowns { arms, gradient };
    assert_eq!(unknowns.count(), P);
    let mut window = Window::<P>::new(image, 15, unknowns, 0.9, [0.4, 0.35]);
    window.centre_on((15, 15));
    let rest = [0.03, -0.02, 0.015, 0.01, 0.012, -0.017, 0.021, -0.009];
    let x = SVector::<f64, P>::from_fn(|i, _| match i {
        0 | 1 => [0.3, -0.2][i],
        _ if i < unknowns.variance() => 0.4 + 1.7 * (i - 2) as f64,
        _ if i == unknowns.variance() => 0.6,
        _ if i < unknowns.slope() => [-0.9, 0.8, -0.1, 0.3][i - unknowns.grey(0)],
        _ => rest[i - unknowns.slope()],
    });
    let normal = window.normal(&x).unwrap();
    for unknown in 0..P {
        // What is multiplied by distances takes smaller steps.
        let h = if unknown < unknowns.slope() { 0.02 } else { 0.002 };
        let mut omega = |steps: f64| {
            let mut moved = x;
            moved[unknown] += steps * h;
            window.normal(&moved).unwrap().omega
        };
        let difference = (8.0 * (omega(1.0) - omega(-1.0)) - (omega(2.0) - omega(-2.0))) / (12.0 * h);
        let (analytic, scale) = (-2.0 * normal.b[unknown], normal.n[(unknown, unknown)].sqrt());
        let close = (difference - analytic).abs() < 3e-3 * (analytic.abs() + scale);
        assert!(close, "{arms} arms, gradient {gradient}, unknown {unknown}: {difference} {analytic}");
    }
}

#[test]
fn right_hand_sides_are_those_of_differences() {
    let junction = junction(&[100.0, 130.0, 130.0], 0.2, 0.7, [0.1, 0.2]);
    let image = quadrature_images::image(&junction.render(SIDE), SIDE);
    check_right_hand_side::<7>(&image, 2, EVEN);
    check_right_hand_side::<9>(&image, 2, ADDED);
    check_right_hand_side::<9>(&image, 2, LIGHT);
    check_right_hand_side::<11>(&image, 2, EACH);
    check_right_hand_side::<9>(&image, 3, EVEN);
    check_right_hand_side::<11>(&image, 3, ADDED);
    check_right_hand_side::<11>(&image, 3, LIGHT);
    check_right_hand_side::<15>(&image, 3, EACH);
    check_right_hand_side::<9>(&image, 4, EVEN);
    check_right_hand_side::<11>(&image, 4, ADDED);
    check_right_hand_side::<11>(&image, 4, LIGHT);
    check_right_hand_side::<17>(&image, 4, EACH);
}

fn error(junction: &Junction, spec: &str) -> f64 {
    let image = quadrature_images::image(&junction.render(SIDE), SIDE);
    let start = Start::at(PixelPoint::new(junction.position[0] + 1.0, junction.position[1] - 0.8));
    let found = operator(&format!("window=15,arms={},{spec}", junction.grey.len())).measure(&image, &start).unwrap();
    (found.position.x - junction.position[0]).hypot(found.position.y - junction.position[1])
}

/// Half a percent of the contrast a px.
#[test]
fn what_is_estimated_leaves_no_bias() {
    for widths in [&[70.0, 290.0][..], &[100.0, 130.0, 130.0], &[60.0, 120.0, 60.0, 120.0]] {
        let plain = junction(widths, 0.4, 0.9, [0.2, -0.3]);
        let each = [[0.003, 0.0], [-0.001, 0.002], [0.0, -0.002], [0.001, 0.001]];
        let added = Junction { gradient: [0.002, -0.0022], ..plain.clone() };
        let light = Junction { light: [0.004, -0.0035], ..plain.clone() };
        let each = Junction { each: each[..widths.len()].to_vec(), ..plain.clone() };
        for (uneven, settings) in [(added, &[ADDED, EACH][..]), (light, &[LIGHT, EACH]), (each, &[EACH])] {
            let without = error(&uneven, "gradient=0");
            for setting in settings {
                let with = error(&uneven, &format!("gradient={setting}"));
                println!("{widths:?}, gradient {setting}: {with:.1e} px, {without:.1e} without");
                assert!(with < 1e-5 && without > 10.0 * with, "{widths:?}, gradient {setting}: {with:e} {without:e}");
            }
        }
    }
}

#[test]
fn photosites_narrower_than_pixels_are_told() {
    for (widths, blur) in [(&[70.0, 290.0][..], 0.4), (&[100.0, 130.0, 130.0], 0.4), (&[60.0, 120.0, 60.0, 120.0], 0.4)] {
        let narrow = Junction { photosite: 0.6, ..junction(widths, 0.4, blur, [0.2, -0.3]) };
        let (told, untold) = (error(&narrow, "photosite=0.6"), error(&narrow, "photosite=1"));
        println!("{widths:?}: {told:.1e} px, {untold:.1e} untold");
        assert!(told < 1e-5 && untold > 10.0 * told, "{widths:?}: {told:e} {untold:e}");
    }
}
