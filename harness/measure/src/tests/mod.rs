//! Images whose contents are known, and errors against the bound, for the tests of several operators. They share no formula with any operator.

use calibench_model::{Image, PixelPoint, Start};

use crate::operator::Operator;

pub(crate) mod bound;
pub(crate) mod closed_form_images;
pub(crate) mod junction_images;
pub(crate) mod no_corners;
pub(crate) mod quadrature_images;

/// Prints how many of `images` an operator measures a second, started about a px from where the target is.
pub(crate) fn print_rate(what: &str, operator: &dyn Operator, images: &[Image], [x, y]: [f64; 2]) {
    let round = || {
        let clock = std::time::Instant::now();
        for (i, image) in images.iter().enumerate() {
            let a = i as f64;
            std::hint::black_box(&operator.measure(image, &Start::at(PixelPoint::new(x + a.cos(), y + a.sin()))));
        }
        clock.elapsed().as_secs_f64()
    };
    let best = (0..20).map(|_| round()).fold(f64::INFINITY, f64::min);
    println!("{what}: {:.0} points/s", images.len() as f64 / best);
}
