//! Testfields for the printer: their sheets at true scale, as SVG and as PDF; and what every PDF is made of, letters and streams.
//!
//! What is printed is what is rendered: every outline as it is, print noise included; a bend is the user's to avoid. The lightest level of a sheet is left
//! white and the darkest is printed black, what lies between in proportion to its reflectance. A bar of 100 mm shows whether the printer kept the scale.

mod deflated;
mod layout;
mod lettering;
mod pdf;
mod svg;

use std::io;

use calibench_files::folder::NewFolder;
use calibench_model::Testfield;
use thiserror::Error;

pub use deflated::deflated;
pub use layout::{Paper, Sheet, sheets};
pub use lettering::{Font, Lettering};
pub use pdf::pdf;
pub use svg::svg;

/// How a testfield is printed.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintOptions {
    /// Its name, in the footer and in the names of files.
    pub name: String,
    /// Millimetres in an object unit: 1 for mm, 1000 for m.
    pub mm_per_unit: f64,
    /// The paper.
    pub paper: Paper,
}

/// Why a testfield cannot be printed.
#[derive(Debug, Error)]
pub enum PrintError {
    /// A scale that is none, mm in an object unit.
    #[error("{0} mm in an object unit: expected a number from 0.001 to 1000000")]
    Scale(f64),
    /// A paper that is none: width and height, mm.
    #[error("paper of {0} x {1} mm: expected at least 140 x 80 and at most 5000 x 5000 mm")]
    Paper(f64, f64),
    /// A testfield without plates.
    #[error("the testfield has no plate to print")]
    Nothing,
    /// A coordinate that is not a number.
    #[error("plate `{0}` has a coordinate that is not a number")]
    NotFinite(String),
    /// More pages than anybody would print.
    #[error("plate `{plate}` of {width:.0} x {height:.0} mm takes {pages} pages of this paper: expected at most 1000")]
    Pages {
        /// The plate.
        plate: String,
        /// Its width, mm.
        width: f64,
        /// Its height, mm.
        height: f64,
        /// Pages.
        pages: f64,
    },
    /// A page that PDF cannot hold.
    #[error("plate `{plate}` needs a page of {width:.0} x {height:.0} mm: a PDF page has at most 5080 mm; print it on several pages")]
    TooLarge {
        /// The plate.
        plate: String,
        /// The page's width, mm.
        width: f64,
        /// The page's height, mm.
        height: f64,
    },
    /// What the file system refuses.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Writes one SVG file a page into `folder`, and all pages as the PDF file `NAME.pdf`.
///
/// # Errors
/// What cannot be printed, and what the file system refuses.
pub fn write_sheets(folder: &NewFolder, field: &Testfield, options: &PrintOptions) -> Result<(), PrintError> {
    let pages = sheets(field, options)?;
    let pdf = pdf(&pages)?;
    for sheet in &pages {
        folder.write(&format!("{}.svg", sheet.file_stem), |file| file.write_all(svg(sheet).as_bytes()))?;
    }
    Ok(folder.write(&format!("{}.pdf", options.name), |file| file.write_all(&pdf))?)
}

/// A length in mm to a nanometre, as short as can be.
fn number(mm: f64) -> String {
    let text = format!("{mm:.6}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".into() } else { short.into() }
}

#[cfg(test)]
mod tests;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
