//! Smoothed images.

use calibench_model::{Image, stop};

/// The image with the binomial weights 1 4 6 4 1 in both directions.
pub(crate) fn smoothed(image: &Image) -> Image<'static> {
    let (width, height) = (image.width(), image.height());
    let mut grey = Vec::with_capacity(width * height);
    let mut line = vec![0.0_f32; width + 4];
    let weigh = |a: f32, b: f32, c: f32, d: f32, e: f32| (a + e) + 4.0 * (b + d) + 6.0 * c;
    for y in 0..height {
        stop::point();
        let row = |off: usize| &image.row((y + off).saturating_sub(2).min(height - 1))[..width];
        let (a, b, c, d, e) = (row(0), row(1), row(2), row(3), row(4));
        let middle = &mut line[2..width + 2];
        for x in 0..width {
            middle[x] = weigh(a[x], b[x], c[x], d[x], e[x]);
        }
        let (first, last) = (line[2], line[width + 1]);
        line[..2].fill(first);
        line[width + 2..].fill(last);
        grey.extend(line.windows(5).map(|w| weigh(w[0], w[1], w[2], w[3], w[4]) / 256.0));
    }
    Image::new(width, height, grey)
}
