//! Gaussian smoothing of a whole image.

use calibench_model::Image;

/// The image under a Gaussian of standard deviation `sigma` px, cut off at four sigma; at the border the outermost pixels are repeated.
pub fn smooth(image: &Image, sigma: f64) -> Image<'static> {
    let radius = (4.0 * sigma).ceil() as usize;
    let raw: Vec<f64> = (0..=radius).map(|d| (-((d * d) as f64) / (2.0 * sigma * sigma)).exp()).collect();
    let sum = raw[0] + 2.0 * raw[1..].iter().sum::<f64>();
    let weights: Vec<f32> = raw.iter().map(|w| (w / sum) as f32).collect();
    let (width, height) = (image.width(), image.height());
    if width == 0 || height == 0 {
        return Image::new(width, height, Vec::new());
    }
    let mut along_rows = Vec::with_capacity(width * height);
    let mut padded = vec![0.0; width + 2 * radius];
    for y in 0..height {
        let row = image.row(y);
        padded[..radius].fill(row[0]);
        padded[radius..radius + width].copy_from_slice(row);
        padded[radius + width..].fill(row[width - 1]);
        let start = along_rows.len();
        along_rows.extend(padded[radius..radius + width].iter().map(|grey| grey * weights[0]));
        for (d, weight) in weights.iter().enumerate().skip(1) {
            let pairs = padded[radius - d..].iter().zip(&padded[radius + d..]);
            along_rows[start..].iter_mut().zip(pairs).for_each(|(to, (a, b))| *to += weight * (a + b));
        }
    }
    let mut grey = vec![0.0; width * height];
    for (y, to) in grey.chunks_exact_mut(width).enumerate() {
        for (d, weight) in weights.iter().enumerate() {
            let row = |y: usize| &along_rows[y * width..(y + 1) * width];
            let (above, below) = (row(y.saturating_sub(d)), row((y + d).min(height - 1)));
            // The middle row is both above and below.
            let weight = if d == 0 { weight / 2.0 } else { *weight };
            to.iter_mut().zip(above.iter().zip(below)).for_each(|(to, (a, b))| *to += weight * (a + b));
        }
    }
    Image::new(width, height, grey)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gaussian_becomes_a_wider_one() {
        let gauss = |variance: f64| {
            Image::from_fn(61, 61, move |x, y| {
                ((-((x as f64 - 30.0).powi(2) + (y as f64 - 30.0).powi(2)) / (2.0 * variance)).exp() / variance) as f32
            })
        };
        let (found, expected) = (smooth(&gauss(4.0), 1.5), gauss(4.0 + 2.25));
        for (a, b) in found.grey().iter().zip(expected.grey()) {
            assert!((a - b).abs() < 5e-5, "{a} {b}");
        }
    }

    #[test]
    fn a_plain_image_stays_as_it_is() {
        let image = Image::new(7, 3, vec![0.4; 21]);
        assert!(smooth(&image, 2.0).grey().iter().all(|g| (g - 0.4).abs() < 1e-6));
    }
}
