use super::*;
use crate::tests::bound::noisy;
use rand::SeedableRng;

#[test]
#[ignore = "prints speeds"]
fn speed() {
    for spec in ["window=15,arms=2", "window=15", "window=15,arms=2,search=0"] {
        for blur in [0.3, 0.5, 0.7, 1.0, 1.5, 2.0] {
            let junction = junction(&[90.0, 270.0], 0.4, blur, [0.2, -0.3]);
            let grey = junction.render(SIDE);
            let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
            let images: Vec<Image> = (0..200).map(|_| quadrature_images::image(&noisy(&grey, 0.012, &mut rng), SIDE)).collect();
            let operator = operator(spec);
            let mut best = f64::INFINITY;
            for _ in 0..20 {
                let clock = std::time::Instant::now();
                for (i, image) in images.iter().enumerate() {
                    let a = i as f64;
                    let start = Start::at(PixelPoint::new(junction.position[0] + a.cos(), junction.position[1] + a.sin()));
                    std::hint::black_box(&operator.measure(image, &start)).as_ref().unwrap();
                }
                best = best.min(clock.elapsed().as_secs_f64());
            }
            println!("{spec} blur {blur}: {:.0} points/s", 200.0 / best);
        }
    }
}
