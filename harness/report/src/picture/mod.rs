//! Pictures as files: pixels, or lines and text that can be scaled and edited.

mod pdf;

use std::io;

use calibench_files::OutputFile;
use calibench_files::photograph::marked;

use crate::Canvas;
use crate::html::svg;

/// Endings of the files that pictures are written to: PNG for screens, SVG and PDF for print.
pub const PICTURES: [&str; 3] = ["png", "svg", "pdf"];

impl Canvas {
    /// Writes the picture as a file of its own: SVG or PDF by its ending, else PNG. The same picture gives the same bytes.
    ///
    /// A PNG is marked as drawn by this program: it is replaced when it is drawn again, a photograph never is.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn write(&self, file: &OutputFile) -> io::Result<()> {
        let bytes = if file.has_ending(&["svg"]) {
            svg(self).into_bytes()
        } else if file.has_ending(&["pdf"]) {
            pdf::pdf(self)
        } else {
            let mut png = Vec::new();
            self.encode(&mut png)?;
            marked(png)
        };
        file.write(|output| output.write_all(&bytes))
    }
}

#[cfg(test)]
mod tests;
