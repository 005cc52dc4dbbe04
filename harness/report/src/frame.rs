//! The frame of the images as a drawing board.

use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::field::{Area, write};

/// A map of the frame: where it lies in the picture, and how large.
#[derive(Clone, Copy)]
pub(crate) struct Map {
    size: ImageSize,
    corner: (i32, i32),
    /// Width and height, px of the picture.
    pub(crate) extent: (u32, u32),
}

impl Map {
    /// A map `width` px wide whose upper left corner lies at `corner`.
    pub(crate) fn new(size: ImageSize, corner: (u32, u32), width: u32) -> Self {
        let height = (f64::from(width) * f64::from(size.height) / f64::from(size.width)).round().max(20.0) as u32;
        Self { size, corner: (corner.0 as i32, corner.1 as i32), extent: (width, height) }
    }

    /// A place of the frame in the picture.
    pub(crate) fn place(&self, at: PixelPoint) -> (i32, i32) {
        let corner = at.to_corner();
        let part = |value: f64, size: u32, px: u32| (value / f64::from(size) * f64::from(px)).round() as i32;
        (self.corner.0 + part(corner.x, self.size.width, self.extent.0), self.corner.1 + part(corner.y, self.size.height, self.extent.1))
    }

    /// The frame's outline.
    pub(crate) fn outline(&self, area: &Area<'_>) {
        let (left, up) = self.corner;
        let corners = [(left, up), (left + self.extent.0 as i32, up + self.extent.1 as i32)];
        area.draw(&Rectangle::new(corners, BLACK)).ok();
    }

    /// Outline and axes in px.
    pub(crate) fn axes(&self, area: &Area<'_>) {
        self.outline(area);
        let (left, up) = self.corner;
        let (width, height) = (self.extent.0 as i32, self.extent.1 as i32);
        for i in 0..=4 {
            let part = f64::from(i) / 4.0;
            let (column, row) = ((part * f64::from(self.size.width)).round(), (part * f64::from(self.size.height)).round());
            write(area, &format!("{column}"), (left + width * i / 4, up + height + 14), HPos::Center);
            write(area, &format!("{row}"), (left - 8, up + height * i / 4), HPos::Right);
        }
        write(area, "x, px", (left + width / 2, up + height + 34), HPos::Center);
        write(area, "y, px", (left - 8, up - 14), HPos::Right);
    }
}
