use super::*;
use crate::exact::{self, Chess};
use crate::registry::Registry;

fn operator(spec: &str) -> Box<dyn Operator> {
    Registry::builtin().parse(&format!("parametric_corner:{spec}")).unwrap().operator.unwrap()
}

/// A chess corner in the middle of a window of 31 px, tilted by `tilt` about an axis halfway between its edges, turned by `turn`, radians.
fn chess(tilt: f64, turn: f64, blur: f64, phase: [f64; 2]) -> Chess {
    let half_angle = tilt.cos().atan();
    Chess {
        position: phase.map(|p| 15.0 + p),
        normals: [turn - half_angle, turn + half_angle],
        curvature: [0.0; 2],
        blur,
        mean: 0.5,
        half: 0.3,
        gradient: [0.0; 2],
    }
}

const SIDE: usize = 31;

#[test]
fn noise_free_bias() {
    let mut worst: f64 = 0.0;
    for blur in [0.3, 0.5, 0.71, 1.0, 1.5, 2.0] {
        let mut of_blur: f64 = 0.0;
        for (index, tilt) in [0.0_f64, 30.0, 45.0, 60.0].into_iter().enumerate() {
            for k in 0..6 {
                let k = f64::from(k) + 0.37 * index as f64;
                let corner = chess(tilt.to_radians(), 0.61 * k, blur, [0.07 * k - 0.2, 0.45 - 0.17 * k]);
                let image = exact::image(&corner.render(SIDE), SIDE);
                let found = operator("window=15").measure(&image, &Start::at(PixelPoint::new(16.0, 14.3))).unwrap();
                let error = (found.position.x - corner.position[0]).hypot(found.position.y - corner.position[1]);
                of_blur = of_blur.max(error);
            }
        }
        println!("blur {blur}: {of_blur:.1e} px");
        worst = worst.max(of_blur);
    }
    assert!(worst <= 1e-5, "{worst:e}");
}
