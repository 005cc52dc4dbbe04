//! Which part of what a camera sees the new picture holds.

use calibench_model::PixelPoint;
use calibench_model::camera::{ImageSize, NoCounterpart, Ray};
use thiserror::Error;

use crate::view::{Equirectangular, View};

/// A new picture is no more than so many times as wide and as high as the photograph.
const MOST_SIDES: f64 = 4.0;
/// Columns and rows at most.
const MOST: f64 = 65_536.0;
/// Places along a side of the photograph whose rays are looked at, beside all pixels of its border.
const PLACES: u32 = 400;
/// Places along a side of the new picture among which the largest rectangle is sought.
const NODES: usize = 400;
/// Places along the sides of the photograph by which it is counted what is kept.
const COUNTED: [u32; 2] = [120, 90];

/// How a new picture is bounded; its scale is the photograph's on the axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// Size and axis of the photograph.
    Keep,
    /// All that the photograph shows.
    All,
    /// The largest rectangle all of whose pixels come from the photograph.
    Crop,
}

/// What a new picture is projected to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A plane: straight lines are straight.
    Pinhole,
    /// A sphere, unrolled.
    Equirectangular,
}

/// A frame that cannot be.
#[derive(Debug, Error)]
pub enum FrameError {
    /// No ray, no picture.
    #[error("the camera has no ray along its axis: {0}")]
    NoAxis(#[from] NoCounterpart),
    /// Rays that no plane holds.
    #[error(
        "the camera sees {angle:.1}\u{b0} off its axis; a picture in a plane of all that is more than {MOST_SIDES} times as large as the photograph or has no end: \
         expected the frame `keep` or `crop`, or an equirectangular picture"
    )]
    TooWide {
        /// Largest angle from the axis, degrees.
        angle: f64,
    },
    /// A size that no file holds.
    #[error("the picture would be {width:.0} x {height:.0} px; expected 1 to {MOST} a side")]
    Size {
        /// Columns.
        width: f64,
        /// Rows.
        height: f64,
    },
    /// Nothing to show.
    #[error("no pixel of the picture would come from the photograph: its camera pictures nothing of what the new one sees")]
    Nothing,
}

/// The view of a new picture of what `photograph` shows, `scale` times as large as the photograph on the axis.
///
/// # Errors
/// No ray along the axis, a plane that cannot hold all, a picture without pixels or with too many.
pub fn framed(photograph: &View, target: Target, frame: Frame, scale: f64) -> Result<View, FrameError> {
    let ((axis, focal), stated) = (photograph.axis()?, photograph.size());
    let scaled = |at: PixelPoint| {
        let mut corner = at.to_corner();
        (corner.x, corner.y) = (corner.x * scale, corner.y * scale);
        corner.to_pixel()
    };
    let size = [stated.width, stated.height].map(|side| (f64::from(side) * scale).round());
    let keep = Plan { target, focal: focal.map(|focal| focal * scale), axis: scaled(axis), size };
    match frame {
        Frame::Keep => keep.view(),
        Frame::All => keep.around(photograph, &seen(photograph)?)?.view(),
        Frame::Crop => {
            let all = keep.around(photograph, &seen(photograph)?).unwrap_or_else(|_| keep.widened());
            all.cropped(photograph)
        }
    }
}

/// A view before its size is checked.
#[derive(Clone, Copy)]
struct Plan {
    target: Target,
    focal: [f64; 2],
    axis: PixelPoint,
    size: [f64; 2],
}

impl Plan {
    fn view(&self) -> Result<View, FrameError> {
        let [width, height] = self.size;
        if !self.size.iter().all(|side| (1.0..=MOST).contains(side)) {
            return Err(FrameError::Size { width, height });
        }
        Ok(self.of_size(ImageSize { width: width as u32, height: height as u32 }))
    }

    fn of_size(&self, size: ImageSize) -> View {
        match self.target {
            Target::Pinhole => View::pinhole(size, self.focal, self.axis),
            Target::Equirectangular => View::Equirectangular(Equirectangular { size, scale: self.focal[0].abs(), axis: self.axis }),
        }
    }

    /// The same with other borders: first and last column, first and last row.
    fn bounded(&self, [left, right]: [f64; 2], [top, bottom]: [f64; 2]) -> Self {
        let axis = PixelPoint::new(self.axis.x - left, self.axis.y - top);
        Self { axis, size: [right - left + 1.0, bottom - top + 1.0], ..*self }
    }

    /// As large as is allowed.
    fn widened(&self) -> Self {
        let [width, height] = self.size.map(|side| side * (MOST_SIDES - 1.0) / 2.0);
        self.bounded([-width.floor(), self.size[0] - 1.0 + width.floor()], [-height.floor(), self.size[1] - 1.0 + height.floor()])
    }

    /// With all `rays` in it.
    fn around(&self, photograph: &View, rays: &[Ray]) -> Result<Self, FrameError> {
        let view = self.of_size(photograph.size());
        let (mut columns, mut rows) = ([f64::INFINITY, f64::NEG_INFINITY], [f64::INFINITY, f64::NEG_INFINITY]);
        let mut is_whole = true;
        for ray in rays {
            let Some(PixelPoint { x, y }) = view.image(*ray) else {
                is_whole = false;
                break;
            };
            columns = [columns[0].min(x), columns[1].max(x)];
            rows = [rows[0].min(y), rows[1].max(y)];
        }
        // To a hundredth of a pixel, so that rounding adds no column.
        let whole = |[low, high]: [f64; 2]| [(low + 0.01).floor(), (high - 0.01).ceil()];
        let found = self.bounded(whole(columns), whole(rows));
        let bearable = found.size.iter().zip(self.size).all(|(found, side)| *found <= side * MOST_SIDES);
        if is_whole && (bearable || self.target == Target::Equirectangular) {
            return Ok(found);
        }
        let axis = Ray::from_tangent(0.0, 0.0);
        let angle = rays.iter().map(|ray| ray.angle_to(axis)).fold(0.0, f64::max);
        Err(FrameError::TooWide { angle: angle.to_degrees() })
    }

    /// The largest rectangle in it that the photograph fills.
    fn cropped(&self, photograph: &View) -> Result<View, FrameError> {
        let wide = self.view()?;
        let ImageSize { width, height } = wide.size();
        let is_filled = |x: f64, y: f64| wide.place_in(photograph, PixelPoint::new(x, y)).is_some_and(|at| photograph.holds(at));
        let step = (width.max(height) as usize).div_ceil(NODES).max(1);
        let [across, down] = [width, height].map(|side| (side as usize - 1) / step + 1);
        let filled: Vec<bool> = (0..across * down).map(|i| is_filled((i % across * step) as f64, (i / across * step) as f64)).collect();
        let [left, top, right, bottom] = largest(&filled, across).ok_or(FrameError::Nothing)?;
        let mut bounds = [left, top, right, bottom].map(|node| (node * step) as i64);
        let side = |[left, top, right, bottom]: [i64; 4], which: usize| -> bool {
            let mut along = match which {
                0 | 2 => top..=bottom,
                _ => left..=right,
            };
            along.all(|at| match which {
                0 => is_filled(left as f64, at as f64),
                1 => is_filled(at as f64, top as f64),
                2 => is_filled(right as f64, at as f64),
                _ => is_filled(at as f64, bottom as f64),
            })
        };
        // Between the places there may be gaps: sides that have any move inwards.
        while let Some(which) = (0..4).find(|which| !side(bounds, *which)) {
            bounds[which] += if which < 2 { 1 } else { -1 };
            if bounds[0] > bounds[2] || bounds[1] > bounds[3] {
                return Err(FrameError::Nothing);
            }
        }
        let frame = [0, 0, i64::from(width) - 1, i64::from(height) - 1];
        for which in 0..4 {
            for _ in 0..step {
                let mut more = bounds;
                more[which] += if which < 2 { -1 } else { 1 };
                let within = if which < 2 { more[which] >= frame[which] } else { more[which] <= frame[which] };
                if !within || !side(more, which) {
                    break;
                }
                bounds = more;
            }
        }
        let [left, top, right, bottom] = bounds.map(|at| at as f64);
        self.bounded([left, right], [top, bottom]).view()
    }
}

/// The rays of what a photograph shows: of its border, to the outer edges, and within it.
fn seen(photograph: &View) -> Result<Vec<Ray>, FrameError> {
    let ImageSize { width, height } = photograph.size();
    let (right, bottom) = (f64::from(width - 1), f64::from(height - 1));
    let columns = (0..width).flat_map(|x| [0.0, bottom].map(|y| PixelPoint::new(f64::from(x), y)));
    let rows = (0..height).flat_map(|y| [0.0, right].map(|x| PixelPoint::new(x, f64::from(y))));
    let [across, down] = [width, height].map(|side| side.min(PLACES));
    let within = (0..across * down).map(|i| {
        let place = |i: u32, count: u32, last: f64| last * f64::from(i) / f64::from(count.max(2) - 1);
        PixelPoint::new(place(i % across, across, right), place(i / across, down, bottom))
    });
    let rays: Vec<Ray> = columns.chain(rows).chain(within).filter_map(|at| photograph.ray(at)).collect();
    if rays.is_empty() { Err(FrameError::Nothing) } else { Ok(rays) }
}

/// The rectangle of the most places that are all filled: first column, first row, last column, last row.
fn largest(filled: &[bool], across: usize) -> Option<[usize; 4]> {
    let mut heights = vec![0_usize; across + 1];
    let (mut best, mut found) = (0, None);
    for (row, line) in filled.chunks_exact(across).enumerate() {
        for (height, filled) in heights.iter_mut().zip(line) {
            *height = if *filled { *height + 1 } else { 0 };
        }
        // Columns that begin higher rectangles, with the first column of each.
        let mut open: Vec<(usize, usize)> = Vec::new();
        for (column, height) in heights.iter().copied().enumerate() {
            let mut begin = column;
            while let Some((first, top)) = open.pop_if(|(_, top)| *top >= height) {
                if top * (column - first) > best {
                    best = top * (column - first);
                    found = Some([first, row + 1 - top, column - 1, row]);
                }
                begin = first;
            }
            if height > 0 {
                open.push((begin, height));
            }
        }
    }
    found
}

/// Angles that a picture spans, radians, along lines through the middle of its frame; where the frame ends beyond what has a ray, to there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fields {
    /// From the left to the right edge.
    pub horizontal: f64,
    /// From the upper to the lower edge.
    pub vertical: f64,
    /// From corner to corner, the larger of both.
    pub diagonal: f64,
}

/// The field of view of a picture; `None` if its middle has no ray.
pub fn fields(view: &View) -> Option<Fields> {
    let ImageSize { width, height } = view.size();
    let (w, h) = (f64::from(width), f64::from(height));
    let place = |x: f64, y: f64| calibench_model::CornerPoint { x: x * w, y: y * h }.to_pixel();
    let middle = place(0.5, 0.5);
    let centre = view.ray(middle)?;
    let to = |x: f64, y: f64| {
        let edge = place(x, y);
        let at = |share: f64| view.ray(PixelPoint::new(middle.x + share * (edge.x - middle.x), middle.y + share * (edge.y - middle.y)));
        let (mut inner, mut outer) = (0.0, 1.0);
        if let Some(ray) = at(1.0) {
            return centre.angle_to(ray);
        }
        for _ in 0..40 {
            let half = 0.5 * (inner + outer);
            if at(half).is_some() { inner = half } else { outer = half }
        }
        at(inner).map_or(0.0, |ray| centre.angle_to(ray))
    };
    Some(Fields {
        horizontal: to(0.0, 0.5) + to(1.0, 0.5),
        vertical: to(0.5, 0.0) + to(0.5, 1.0),
        diagonal: (to(0.0, 0.0) + to(1.0, 1.0)).max(to(1.0, 0.0) + to(0.0, 1.0)),
    })
}

/// What of a photograph a new picture keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kept {
    /// The share of its area that has rays, 0 to 1.
    pub with_ray: f64,
    /// The share of its area that is in the new picture, 0 to 1.
    pub shown: f64,
}

/// What `to` keeps of the photographs of `from`, counted at 120 x 90 places.
pub fn kept(from: &View, to: &View) -> Kept {
    let (size, [across, down]) = (from.size(), COUNTED);
    let (mut rays, mut shown) = (0_u32, 0_u32);
    for i in 0..across * down {
        let place = |i: u32, count: u32, side: u32| f64::from(side) * (f64::from(i) + 0.5) / f64::from(count);
        let corner = calibench_model::CornerPoint { x: place(i % across, across, size.width), y: place(i / across, down, size.height) };
        let Some(ray) = from.ray(corner.to_pixel()) else { continue };
        rays += 1;
        shown += u32::from(to.image(ray).is_some_and(|at| to.holds(at)));
    }
    let all = f64::from(across * down);
    Kept { with_ray: f64::from(rays) / all, shown: f64::from(shown) / all }
}

#[cfg(test)]
mod tests;
