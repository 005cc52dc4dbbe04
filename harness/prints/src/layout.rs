//! Pages: which part of which plate lies where.

use calibench_model::testfield::{Area, Curve, PlatePoint};
use calibench_model::{Plate, Testfield};

use super::{PrintError, PrintOptions};

/// Blank paper around everything, mm.
const MARGIN: f64 = 10.0;
/// The height of the footer with the scale bar, mm.
const FOOTER: f64 = 14.0;
/// The least width of a page that is cut to its plate, mm: the footer must fit.
const LEAST_WIDTH: f64 = 140.0;
/// The most pages of a plate.
const MOST_PAGES: f64 = 1000.0;
/// What the tiles of a plate may lack or exceed by rounding, mm.
const ROUNDING: f64 = 1e-6;

/// What is printed on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paper {
    /// One page for each plate, as large as it needs.
    Whole,
    /// Sheets of this width and height, mm, upright or across; larger plates are tiled.
    Sheets {
        /// mm.
        width: f64,
        /// mm.
        height: f64,
    },
}

impl Paper {
    /// A4.
    pub const A4: Self = Self::Sheets { width: 210.0, height: 297.0 };
    /// A3.
    pub const A3: Self = Self::Sheets { width: 297.0, height: 420.0 };
    /// US Letter.
    pub const LETTER: Self = Self::Sheets { width: 215.9, height: 279.4 };

    /// Width and height that a plate may have to stand on one sheet, mm: upright and across. `None` where a page is as large as its plate.
    pub fn room(&self) -> Option<[[f64; 2]; 2]> {
        match *self {
            Self::Whole => None,
            Self::Sheets { width, height } => Some([usable([width, height]), usable([height, width])]),
        }
    }
}

/// A page: lengths in mm, origin at its lower left corner, x to the right, y upwards.
#[derive(Clone, Debug)]
pub struct Sheet<'a> {
    /// What is printed.
    pub plate: &'a Plate,
    /// Name for a file, without ending.
    pub file_stem: String,
    /// What the footer says.
    pub label: String,
    /// Width and height of the page, mm.
    pub size: [f64; 2],
    /// The part of the page that shows the plate: two opposite corners, the lower left first, mm.
    pub window: [[f64; 2]; 2],
    /// Where the plate's (0, 0) lies on the page, mm.
    pub origin: [f64; 2],
    /// Millimetres in an object unit.
    pub scale: f64,
}

impl Sheet<'_> {
    /// A position on the plate (object units), on the page (mm).
    pub fn place(&self, [u, v]: PlatePoint) -> [f64; 2] {
        [self.origin[0] + u * self.scale, self.origin[1] + v * self.scale]
    }

    /// The areas that this page shows, outer ones first, each with its grey, 0 (black) to 1 (white), as a printer takes it (sRGB).
    pub fn areas(&self) -> Vec<(&Area, f64)> {
        let mut areas: Vec<_> =
            self.plate.areas.iter().map(|area| (area, bounds(area))).filter(|(_, bounds)| self.shows(*bounds)).collect();
        // An area inside another is smaller than it.
        let extent = |[low, high]: [PlatePoint; 2]| (high[0] - low[0]) * (high[1] - low[1]);
        areas.sort_by(|a, b| extent(b.1).total_cmp(&extent(a.1)));
        let range = self.range();
        areas.into_iter().map(|(area, _)| (area, grey(area.level, range))).collect()
    }

    /// The grey of the sheet itself, 0 (black) to 1 (white), as a printer takes it (sRGB).
    pub fn ground(&self) -> f64 {
        grey(self.plate.level, self.range())
    }

    /// Marks outside the window's corners: lines from one point of the page to another, mm.
    pub fn marks(&self) -> Vec<[[f64; 2]; 2]> {
        let [low, high] = self.window;
        let mut marks = Vec::new();
        for (x, right) in [(low[0], -1.0), (high[0], 1.0)] {
            for (y, up) in [(low[1], -1.0), (high[1], 1.0)] {
                marks.push([[x + right, y], [x + right * 6.0, y]]);
                marks.push([[x, y + up], [x, y + up * 6.0]]);
            }
        }
        marks
    }

    /// The left end of the scale bar of 100 mm, at its lower edge: a point of the page, mm.
    pub fn bar(&self) -> [f64; 2] {
        [MARGIN, MARGIN]
    }

    fn shows(&self, [low, high]: [PlatePoint; 2]) -> bool {
        let (low, high) = (self.place(low), self.place(high));
        (0..2).all(|i| low[i] < self.window[1][i] && high[i] > self.window[0][i])
    }

    /// The lowest and the highest level of the plate.
    fn range(&self) -> [f64; 2] {
        let levels = self.plate.areas.iter().map(|area| area.level).chain([self.plate.level]);
        levels.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], level| [low.min(level), high.max(level)])
    }
}

/// The printer's grey (sRGB) of a level within this range.
fn grey(level: f64, [low, high]: [f64; 2]) -> f64 {
    let linear = if high > low { (level - low) / (high - low) } else { 1.0 };
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// A box around an area, for arcs around their circle.
fn bounds(area: &Area) -> [PlatePoint; 2] {
    let around = |curve: &Curve| match *curve {
        Curve::Line { from, to } => [from, to],
        Curve::Arc { centre: [u, v], radius, .. } => [[u - radius, v - radius], [u + radius, v + radius]],
    };
    area.outline.0.iter().flat_map(around).fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], [u, v]| {
        [[low[0].min(u), low[1].min(v)], [high[0].max(u), high[1].max(v)]]
    })
}

/// The pages of a testfield, plate by plate, tiles row by row from the upper left.
///
/// # Errors
/// What cannot be printed.
pub fn sheets<'a>(field: &'a Testfield, options: &PrintOptions) -> Result<Vec<Sheet<'a>>, PrintError> {
    if !(1e-3..=1e6).contains(&options.mm_per_unit) {
        return Err(PrintError::Scale(options.mm_per_unit));
    }
    if let Paper::Sheets { width, height } = options.paper
        && !((LEAST_WIDTH..=5000.0).contains(&width) && (80.0..=5000.0).contains(&height))
    {
        return Err(PrintError::Paper(width, height));
    }
    if field.plates.is_empty() {
        return Err(PrintError::Nothing);
    }
    let mut pages = Vec::new();
    for (index, plate) in field.plates.iter().enumerate() {
        let several = if field.plates.len() > 1 { format!("{}-", index + 1) } else { String::new() };
        let stem = plain(&format!("{}-{several}{}", options.name, plate.id));
        pages.extend(of_plate(plate, &stem, options)?);
    }
    Ok(pages)
}

/// Letters, digits, `-` and `.` stay; everything else becomes `_`.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || "-.".contains(c) { c } else { '_' }).collect()
}

fn of_plate<'a>(plate: &'a Plate, stem: &str, options: &PrintOptions) -> Result<Vec<Sheet<'a>>, PrintError> {
    check_finite(plate)?;
    let scale = options.mm_per_unit;
    let [low, high] = plate.corners;
    let size = [(high[0] - low[0]) * scale, (high[1] - low[1]) * scale];
    let page = match options.paper {
        Paper::Whole => [(size[0] + 2.0 * MARGIN).max(LEAST_WIDTH), size[1] + 2.0 * MARGIN + FOOTER],
        Paper::Sheets { width, height } => best([width, height], size),
    };
    let usable = usable(page);
    let counts = tiles(page, size);
    let pages = counts[0] * counts[1];
    if pages > MOST_PAGES {
        return Err(PrintError::Pages { plate: plate.id.clone(), width: size[0], height: size[1], pages });
    }
    let [columns, rows] = counts.map(|count| count as usize);
    let tiles = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let sheet = |(row, column): (usize, usize)| {
        // The first tile shows the upper left corner; the last ones may be smaller.
        let (left, top) = (column as f64 * usable[0], size[1] - row as f64 * usable[1]);
        let (right, bottom) = ((left + usable[0]).min(size[0]), (top - usable[1]).max(0.0));
        let upper = page[1] - MARGIN;
        let window = [[MARGIN, upper - (top - bottom)], [MARGIN + right - left, upper]];
        let part = format!(", row {} of {rows}, column {} of {columns}", row + 1, column + 1);
        let tiled = rows * columns > 1;
        Sheet {
            plate,
            file_stem: if tiled { format!("{stem}-r{}c{}", row + 1, column + 1) } else { stem.to_owned() },
            label: format!("{}, plate {}{}", options.name, plate.id, if tiled { &part } else { "" }),
            size: page,
            window,
            origin: [window[0][0] - left - low[0] * scale, window[0][1] - bottom - low[1] * scale],
            scale,
        }
    };
    Ok(tiles.map(sheet).collect())
}

fn check_finite(plate: &Plate) -> Result<(), PrintError> {
    let curves = plate.areas.iter().flat_map(|area| &area.outline.0);
    let finite = |curve: &Curve| match *curve {
        Curve::Line { from, to } => from.iter().chain(&to).all(|x| x.is_finite()),
        Curve::Arc { centre: [u, v], radius, start, sweep } => [u, v, radius, start, sweep].iter().all(|x| x.is_finite()),
    };
    let fits = plate.corners.iter().flatten().all(|x| x.is_finite()) && plate.level.is_finite();
    let levels = plate.areas.iter().all(|area| area.level.is_finite());
    if fits && levels && curves.into_iter().all(finite) { Ok(()) } else { Err(PrintError::NotFinite(plate.id.clone())) }
}

fn usable(page: [f64; 2]) -> [f64; 2] {
    [page[0] - 2.0 * MARGIN, page[1] - 2.0 * MARGIN - FOOTER]
}

/// Columns and rows of tiles.
fn tiles(page: [f64; 2], size: [f64; 2]) -> [f64; 2] {
    let usable = usable(page);
    [0, 1].map(|i| ((size[i] - ROUNDING) / usable[i]).ceil().max(1.0))
}

/// The paper upright or across, whichever takes fewer pages.
fn best(paper: [f64; 2], size: [f64; 2]) -> [f64; 2] {
    let across = [paper[1], paper[0]];
    let pages = |page| tiles(page, size).iter().product::<f64>();
    if across[0] >= LEAST_WIDTH && pages(across) < pages(paper) { across } else { paper }
}
