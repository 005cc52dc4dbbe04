//! A target as the connected pixels on one side of a threshold.

use calibench_model::{Image, PixelPoint, Rejection};

use crate::otsu::otsu;

/// Whether the target is darker or lighter than its surroundings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Polarity {
    /// The window says: what most of its border is, the target is not.
    FromWindow,
    /// Darker.
    Dark,
    /// Lighter.
    Light,
}

/// How a target is told from its ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segmentation {
    /// The threshold, as a fraction of full scale; `None` for Otsu's.
    pub threshold: Option<f64>,
    /// Dark or light.
    pub polarity: Polarity,
    /// How many times the window is enlarged (bilinearly) before the threshold is applied.
    pub enlarge: usize,
}

/// The pixels of one target in a window.
#[derive(Clone, Debug, PartialEq)]
pub struct Blob {
    /// Positions (x, y), px as in [`PixelPoint`], and by how much the grey value (fraction of full scale) is beyond the threshold.
    pub pixels: Vec<(f64, f64, f64)>,
    /// The area that each stands for, px^2.
    pub cell: f64,
    /// It reaches the window's border, and so perhaps goes on past it.
    pub cut: bool,
}

/// The window's grey values, enlarged or not.
struct Raster {
    side: usize,
    grey: Vec<f64>,
    scale: f64,
    /// Position of each column and of each row, px.
    columns: Vec<f64>,
    rows: Vec<f64>,
}

impl Segmentation {
    /// The target at or next to `start` in the window of half-width `half` px around pixel `centre` (column, row); four neighbours connect.
    ///
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`], [`Rejection::NoCorner`] when all grey values are on one side of the threshold.
    ///
    /// Source: Otsu 1979 (threshold); Vosselman & Förstner 1988, Sect. 3.2 (enlargement).
    pub fn target(&self, image: &Image, centre: (i64, i64), half: i64, start: PixelPoint) -> Result<Blob, Rejection> {
        let raster = self.raster(image, centre, half)?;
        let threshold = match self.threshold {
            Some(given) => given,
            None => otsu(&raster.grey).ok_or(Rejection::NoCorner)?,
        };
        let light = match self.polarity {
            Polarity::Dark => false,
            Polarity::Light => true,
            Polarity::FromWindow => raster.border().filter(|&grey| grey > threshold).count() * 2 <= raster.border().count(),
        };
        let inside: Vec<bool> = raster.grey.iter().map(|&grey| if light { grey > threshold } else { grey < threshold }).collect();
        let seed = raster.nearest(&inside, start).ok_or(Rejection::NoCorner)?;
        let members = connected(&inside, raster.side, seed);
        if members.len() == inside.len() {
            return Err(Rejection::NoCorner);
        }
        Ok(raster.blob(&members, threshold))
    }

    fn raster(&self, image: &Image, centre: (i64, i64), half: i64) -> Result<Raster, Rejection> {
        let ring = i64::from(self.enlarge > 1);
        let rows: Vec<&[f32]> = image.rows_around(centre.0, centre.1, half + ring).ok_or(Rejection::Border)?.collect();
        if rows.iter().any(|row| row.iter().any(|grey| !grey.is_finite())) {
            return Err(Rejection::NotFinite);
        }
        let scale = self.enlarge as f64;
        let side = (2 * half + 1) as usize * self.enlarge;
        let along = |first: i64| (0..side).map(|i| first as f64 + (i as f64 + 0.5) / scale - 0.5).collect();
        let (columns, lines) = (along(centre.0 - half), along(centre.1 - half));
        let grey = if self.enlarge == 1 { rows.concat().into_iter().map(f64::from).collect() } else { enlarged(&rows, side, scale) };
        Ok(Raster { side, grey, scale, columns, rows: lines })
    }
}

/// The grey values between those of `rows`, which reach one px farther on each side.
fn enlarged(rows: &[&[f32]], side: usize, scale: f64) -> Vec<f64> {
    let place = |index: usize| {
        let at = (index as f64 + 0.5) / scale - 0.5 + 1.0;
        let low = at.floor();
        (low as usize, at - low)
    };
    let places: Vec<(usize, f64)> = (0..side).map(place).collect();
    let mut grey = Vec::with_capacity(side * side);
    for &(y, fy) in &places {
        let (upper, lower) = (rows[y], rows[y + 1]);
        let between = |row: &[f32], x: usize, fx: f64| f64::from(row[x]) * (1.0 - fx) + f64::from(row[x + 1]) * fx;
        grey.extend(places.iter().map(|&(x, fx)| between(upper, x, fx) * (1.0 - fy) + between(lower, x, fx) * fy));
    }
    grey
}

impl Raster {
    fn position(&self, index: usize) -> (f64, f64) {
        (self.columns[index % self.side], self.rows[index / self.side])
    }

    fn is_border(&self, index: usize) -> bool {
        let (x, y, last) = (index % self.side, index / self.side, self.side - 1);
        x == 0 || y == 0 || x == last || y == last
    }

    /// The grey values of its border.
    fn border(&self) -> impl Iterator<Item = f64> + '_ {
        let last = self.side - 1;
        self.grey.chunks_exact(self.side).enumerate().flat_map(move |(y, row)| {
            let step = if y == 0 || y == last { 1 } else { last };
            row.iter().copied().step_by(step)
        })
    }

    /// The pixel of `inside` that is nearest to `start`, the first of several.
    fn nearest(&self, inside: &[bool], start: PixelPoint) -> Option<usize> {
        let mut best: Option<(f64, usize)> = None;
        for (row, (y, line)) in self.rows.iter().zip(inside.chunks_exact(self.side)).enumerate() {
            let up = (y - start.y) * (y - start.y);
            if best.is_some_and(|(least, _)| up >= least) {
                continue;
            }
            for (column, x) in self.columns.iter().enumerate().filter(|(column, _)| line[*column]) {
                let square = (x - start.x) * (x - start.x) + up;
                if best.is_none_or(|(least, _)| square < least) {
                    best = Some((square, row * self.side + column));
                }
            }
        }
        best.map(|(_, index)| index)
    }

    fn blob(&self, members: &[usize], threshold: f64) -> Blob {
        let pixel = |&index: &usize| {
            let (x, y) = self.position(index);
            (x, y, (self.grey[index] - threshold).abs())
        };
        let cut = members.iter().any(|&index| self.is_border(index));
        Blob { pixels: members.iter().map(pixel).collect(), cell: 1.0 / (self.scale * self.scale), cut }
    }
}

/// The pixels connected with `seed`, in the order of the raster.
fn connected(inside: &[bool], side: usize, seed: usize) -> Vec<usize> {
    let mut taken = vec![false; inside.len()];
    let mut waiting = vec![seed];
    taken[seed] = true;
    while let Some(index) = waiting.pop() {
        let (x, y) = (index % side, index / side);
        let neighbours =
            [(x > 0, index.wrapping_sub(1)), (x + 1 < side, index + 1), (y > 0, index.wrapping_sub(side)), (y + 1 < side, index + side)];
        for (there, next) in neighbours {
            if there && inside[next] && !taken[next] {
                taken[next] = true;
                waiting.push(next);
            }
        }
    }
    (0..inside.len()).filter(|&index| taken[index]).collect()
}

impl Blob {
    /// Its area, px^2.
    pub fn area(&self) -> f64 {
        self.pixels.len() as f64 * self.cell
    }

    /// The mean position of its pixels.
    pub fn centre(&self) -> PixelPoint {
        self.mean(|_| 1.0)
    }

    /// The mean position, weighted by how far the grey values are beyond the threshold.
    pub fn weighted_centre(&self) -> PixelPoint {
        self.mean(|beyond| beyond)
    }

    fn mean(&self, weight: impl Fn(f64) -> f64) -> PixelPoint {
        let (mut w, mut wx, mut wy) = (0.0, 0.0, 0.0);
        // Counted from one of its pixels: full precision wherever in the image it lies.
        let (x0, y0, _) = self.pixels[0];
        for &(x, y, beyond) in &self.pixels {
            let weight = weight(beyond);
            (w, wx, wy) = (w + weight, wx + weight * (x - x0), wy + weight * (y - y0));
        }
        PixelPoint::new(x0 + wx / w, y0 + wy / w)
    }

    /// Second central moments xx, xy, yy, px^2.
    pub fn moments(&self) -> [f64; 3] {
        let c = self.centre();
        let mut sums = [0.0; 3];
        for &(x, y, _) in &self.pixels {
            let (dx, dy) = (x - c.x, y - c.y);
            sums = [sums[0] + dx * dx, sums[1] + dx * dy, sums[2] + dy * dy];
        }
        sums.map(|s| s / self.pixels.len() as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OTSU: Segmentation = Segmentation { threshold: None, polarity: Polarity::FromWindow, enlarge: 1 };

    /// Beside a look at every pixel, of any pixels inside and starts beside them.
    #[test]
    fn the_border_and_the_nearest_pixel_are_those_of_all() {
        let image = Image::from_fn(21, 21, |x, y| (x * 31 + y * 17) as f32 / 1000.0);
        for half in [0, 1, 4] {
            let raster = OTSU.raster(&image, (10, 9), half).unwrap();
            let all = raster.side * raster.side;
            let border: Vec<f64> = (0..all).filter(|&i| raster.is_border(i)).map(|i| raster.grey[i]).collect();
            assert_eq!(raster.border().collect::<Vec<_>>(), border);
            for round in 0..200_usize {
                let inside: Vec<bool> = (0..all).map(|i| (i * 7919 + round * 104_729) % 97 < 9 * (round % 4)).collect();
                let start = PixelPoint::new(4.0 + (round as f64 * 0.618).fract() * 12.0, 4.0 + (round as f64 * 0.755).fract() * 12.0);
                let square = |&i: &usize| (raster.position(i).0 - start.x).powi(2) + (raster.position(i).1 - start.y).powi(2);
                let nearest = (0..all).filter(|&i| inside[i]).min_by(|a, b| square(a).total_cmp(&square(b)));
                assert_eq!(raster.nearest(&inside, start), nearest);
            }
        }
    }

    #[test]
    fn only_the_pixels_at_the_start_are_taken() {
        let image = Image::from_fn(31, 31, |x, y| {
            let here = (13..=16).contains(&x) && (14..=18).contains(&y);
            let other = x == 19 && (10..=20).contains(&y);
            if here || other { 0.1 } else { 0.9 }
        });
        let blob = OTSU.target(&image, (15, 15), 7, PixelPoint::new(14.0, 15.0)).unwrap();
        assert_eq!((blob.pixels.len(), blob.cut, blob.centre()), (20, false, PixelPoint::new(14.5, 16.0)));
        let [xx, xy, yy] = blob.moments();
        assert_eq!((xx, xy, yy), (1.25, 0.0, 2.0));
        // Asked for what is light, it takes the ground.
        let ground = Segmentation { polarity: Polarity::Light, ..OTSU }.target(&image, (15, 15), 7, PixelPoint::new(10.0, 10.0)).unwrap();
        assert!(ground.cut);
    }

    #[test]
    fn enlarged_pixels_lie_a_quarter_of_a_pixel_aside() {
        let image = Image::from_fn(21, 21, |x, y| if (9..=11).contains(&x) && (8..=11).contains(&y) { 1.0 } else { 0.0 });
        let enlarged = Segmentation { enlarge: 2, ..OTSU };
        let blob = enlarged.target(&image, (10, 10), 5, PixelPoint::new(10.0, 10.0)).unwrap();
        assert!(blob.centre().distance(PixelPoint::new(10.0, 9.5)) < 1e-12 && (blob.cell - 0.25).abs() < 1e-15);
        assert!(blob.pixels.iter().all(|p| (p.0 * 2.0).fract().abs() == 0.5));
        assert!((blob.area() - 12.0).abs() < 3.1);
    }
}
