//! Lights in the dark, and dots of a few pixels: spots that are too small to be round.

use calibench_model::{Image, stop, upper_median};

use crate::ground::{Ground, least_contrast};
use crate::plane::Point;
use crate::round::Round;

/// Around a spot, so many px from its darkest pixel, nothing of it is seen any more.
const REACH: usize = 4;
/// By how much the surroundings may vary, as a share of the spot's contrast.
const EVEN: f32 = 0.35;
/// What is darker than this share of the contrast belongs to the spot.
const OWN: f32 = 0.2;

/// The dark spots of an image of less than some 7 px, in reading order. Their areas are those of spots as dark all over, px^2; their shape is not told.
pub(crate) fn spots(image: &Image) -> Vec<Round> {
    let (width, height) = (image.width(), image.height());
    let least = least_contrast(&Ground::new(image).own);
    let mut found = Vec::new();
    for y in REACH..height.saturating_sub(REACH) {
        stop::point();
        for x in REACH..width.saturating_sub(REACH) {
            if is_darkest(image, x, y)
                && let Some(level) = ground(image, x, y, least)
            {
                found.push(spot(image, x, y, level));
            }
        }
    }
    found
}

/// Whether a pixel is the darkest of the 5 x 5 around it, of equal ones the first.
fn is_darkest(image: &Image, x: usize, y: usize) -> bool {
    let own = image.at(x, y);
    // The next ones first: most pixels end here.
    image.at(x - 1, y) > own
        && image.at(x + 1, y) >= own
        && (y - 2..=y + 2).all(|row| {
            let before = |column: usize| (row, column) < (y, x);
            (x - 2..=x + 2).all(|column| if before(column) { image.at(column, row) > own } else { image.at(column, row) >= own })
        })
}

/// The level of the ground around a spot; `None` if it is none: too faint, or one of many things around.
fn ground(image: &Image, x: usize, y: usize, least: f32) -> Option<f32> {
    let own = image.at(x, y);
    let ring = || {
        let across = (x - REACH..=x + REACH).flat_map(|x| [(x, y - REACH), (x, y + REACH)]);
        let down = (y - REACH + 1..y + REACH).flat_map(|y| [(x - REACH, y), (x + REACH, y)]);
        across.chain(down).map(|(x, y)| image.at(x, y))
    };
    let darkest = ring().fold(f32::INFINITY, f32::min);
    if darkest - own < (1.0 - EVEN) * least {
        return None;
    }
    let level = upper_median(ring().map(f64::from))? as f32;
    let contrast = level - own;
    (contrast >= least && level - darkest <= EVEN * contrast).then_some(level)
}

/// The centre of gravity of what is darker than the ground around.
fn spot(image: &Image, x: usize, y: usize, level: f32) -> Round {
    let contrast = f64::from(level - image.at(x, y));
    let (mut sum, mut at) = (0.0, [0.0; 2]);
    for row in y + 1 - REACH..y + REACH {
        for column in x + 1 - REACH..x + REACH {
            let darker = level - image.at(column, row);
            if f64::from(darker) > f64::from(OWN) * contrast {
                let weight = f64::from(darker) / contrast;
                sum += weight;
                at = [at[0] + weight * column as f64, at[1] + weight * row as f64];
            }
        }
    }
    let at: Point = at.map(|moment| moment / sum);
    // As the moments of a disc of this area.
    let moment = sum / (4.0 * std::f64::consts::PI);
    Round { at, moments: [moment, 0.0, moment], area: sum, is_oval: true, is_cut: false }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spots_are_found_to_a_fraction_of_a_pixel_and_edges_are_none() {
        let centres: [Point; 4] = [[20.3, 15.8], [40.0, 15.0], [60.5, 30.5], [25.0, 45.6]];
        let image = Image::from_fn(120, 60, |x, y| {
            let off = |at: Point| (x as f64 - at[0]).powi(2) + (y as f64 - at[1]).powi(2);
            let light: f64 = centres.iter().enumerate().map(|(k, at)| (0.3 + 0.2 * k as f64) * (-0.5 * off(*at)).exp()).sum();
            let edge = if x > 100 { 0.8 } else { 0.0 };
            1.0 - (light + edge).min(1.0) as f32
        });
        let found = spots(&image);
        assert_eq!(found.len(), 4, "{found:?}");
        for at in centres {
            let off = |spot: &Round| (spot.at[0] - at[0]).hypot(spot.at[1] - at[1]);
            assert!(found.iter().any(|spot| off(spot) < 0.2), "{at:?}: {found:?}");
        }
        assert!(spots(&Image::from_fn(60, 40, |x, y| ((x + y) % 2) as f32)).is_empty(), "a chequered field");
    }
}
