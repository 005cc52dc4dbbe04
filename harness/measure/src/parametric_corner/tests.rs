use super::*;
use crate::exact::{self, Chess};
use crate::registry::Registry;

pub(super) fn operator(spec: &str) -> Box<dyn Operator> {
    Registry::builtin().parse(&format!("parametric_corner:{spec}")).unwrap().operator.unwrap()
}

/// A chess corner in the middle of a window of 31 px, tilted by `tilt` about an axis halfway between its edges, turned by `turn`, radians.
pub(super) fn chess(tilt: f64, turn: f64, blur: f64, phase: [f64; 2]) -> Chess {
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

pub(super) const SIDE: usize = 31;

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

#[test]
#[ignore = "prints speeds"]
fn speed() {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    for spec in ["window=15", "window=15,search=0"] {
        for blur in [0.3, 0.5, 0.7, 1.0, 1.5, 2.0] {
            let corner = chess(0.5, 0.4, blur, [0.2, -0.3]);
            let grey = corner.render(SIDE);
            let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
            let normal = Normal::new(0.0, 0.02 * 0.6).unwrap();
            let images: Vec<Image> =
                (0..200).map(|_| exact::image(&grey.iter().map(|g| g + normal.sample(&mut rng)).collect::<Vec<_>>(), SIDE)).collect();
            let operator = operator(spec);
            let mut best = f64::INFINITY;
            for _ in 0..20 {
                let clock = std::time::Instant::now();
                for (i, image) in images.iter().enumerate() {
                    let a = i as f64;
                    let start = Start::at(PixelPoint::new(corner.position[0] + a.cos(), corner.position[1] + a.sin()));
                    let found = operator.measure(image, &start);
                    std::hint::black_box(&found);
                }
                best = best.min(clock.elapsed().as_secs_f64());
            }
            println!("{spec} blur {blur}: {:.0} points/s", 200.0 / best);
        }
    }
}

#[test]
#[ignore = "prints speeds"]
fn pieces() {
    use crate::marquardt::Problem;
    for blur in [0.3, 0.5, 0.75, 1.0, 1.5, 2.0] {
        let corner = chess(0.5, 0.4, blur, [0.2, -0.3]);
        let image = exact::image(&corner.render(SIDE), SIDE);
        let time = |f: &mut dyn FnMut()| {
            (0..20).map(|_| { let c = std::time::Instant::now(); for _ in 0..50 { f() } c.elapsed().as_secs_f64() / 50.0 }).fold(f64::INFINITY, f64::min) * 1e6
        };
        let mut window = Window::<7, false, false>::new(&image, 15);
        window.centre_on((15, 15));
        let x = SVector::<f64, 7>::from([0.2, -0.3, corner.normals[0], corner.normals[1], blur * blur, 0.5, 0.3]);
        let mut y = x; y[0] += 0.05; y[1] -= 0.05; y[4] = 0.5; y[2] += 0.05;
        let normal = time(&mut || { std::hint::black_box(window.normal(&x)); });
        let minimise = time(&mut || { std::hint::black_box(minimise(&mut window, y, 1e-2)); });
        window.fidelity = Fidelity::Rough;
        let rough = time(&mut || { std::hint::black_box(window.normal(&x)); });
        let mr = time(&mut || { std::hint::black_box(crate::marquardt::minimise(&mut window, y, 0.1)); });let sr = crate::marquardt::minimise_count(&mut window, y); window.fidelity = Fidelity::Full;
        let saddle = time(&mut || { std::hint::black_box(start::saddle(&image, (15, 15), 5, 7)); });
        let dirs = time(&mut || { std::hint::black_box(start::directions(&image, corner.position, 7)); });
        let new = time(&mut || { std::hint::black_box(Window::<7, false, false>::new(&image, 15)); });
        let n = window.normal(&x).unwrap();
        let cof = time(&mut || { std::hint::black_box(n.cofactors()); });
        let s = crate::marquardt::minimise_count(&mut window, y);
        println!("blur {blur}: rough {rough:.1} {mr:.1} {sr} normal {normal:.1} minimise {minimise:.1} ({s}) saddle {saddle:.1} directions {dirs:.1} new {new:.1} cof {cof:.2} us");
    }
}
