use super::*;
use crate::tests::bound::noisy;
use crate::tests::print_rate;
use rand::SeedableRng;

#[test]
#[ignore = "prints speeds"]
fn speed() {
    for spec in ["window=15,arms=2", "window=15", "window=15,arms=2,search=0"] {
        for blur in [0.3, 0.5, 0.7, 1.0, 1.5, 2.0] {
            let junction = junction(&[90.0, 270.0], 0.4, blur, [0.2, -0.3]);
            let grey = junction.render(SIDE);
            let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
            let images: Vec<Image<'static>> = (0..200).map(|_| quadrature_images::image(&noisy(&grey, 0.012, &mut rng), SIDE)).collect();
            let operator = operator(spec);
            print_rate(&format!("{spec} blur {blur}"), &*operator, &images, junction.position);
        }
    }
}
