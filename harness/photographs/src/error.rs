//! Photographs that cannot be measured.

use std::path::PathBuf;

use calibench_images::PhotoError;
use calibench_model::camera::ImageSize;
use thiserror::Error;

/// What is wrong with photographs.
#[derive(Debug, Error)]
pub enum PhotographsError {
    /// One that cannot be read.
    #[error(transparent)]
    Photo(#[from] PhotoError),
    /// There is none.
    #[error("no photograph was given")]
    None,
    /// A folder without any.
    #[error("{}: holds no photograph; expected PNG, JPEG, TIFF, PNM, BMP or WebP{why}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What it holds instead, in words that go on; empty where that is nothing of note.
        why: String,
    },
    /// None has the size that is wanted, px.
    #[error("no photograph has {} x {} px; expected one of that size, or the size of some of them", .0.width, .0.height)]
    NoneOfSize(ImageSize),
    /// One is given twice.
    #[error("{}: given twice; expected each photograph once", .0.display())]
    Twice(PathBuf),
    /// Points name a photograph that may be either of two.
    #[error("two photographs are called {name}: {} and {}; points must name them with their folders, as `{}`", .paths[0].display(), .paths[1].display(), .paths[1].display())]
    Ambiguous {
        /// What points call it.
        name: String,
        /// Those of that name.
        paths: [PathBuf; 2],
    },
    /// No point is of any of the photographs.
    #[error("no point is of a photograph that was given: points name `{named}`, the photographs are called `{called}`")]
    NoneNamed {
        /// The image of the first point.
        named: String,
        /// The name of the first photograph.
        called: String,
    },
    /// Photographs of one camera that differ in size, by size, the most frequent first.
    #[error("photographs of several sizes: {}; expected photographs of one camera, in one orientation; --only-size {} leaves the others out", sizes(.0), most(.0))]
    Sizes(Vec<((u32, u32), Vec<PathBuf>)>),
}

/// The most frequent size, as an option.
fn most(all: &[((u32, u32), Vec<PathBuf>)]) -> String {
    all.first().map_or_else(String::new, |((width, height), _)| format!("{width}x{height}"))
}

/// Sizes, px, with how many photographs have them; of all but the most frequent the names, too.
fn sizes(all: &[((u32, u32), Vec<PathBuf>)]) -> String {
    let one = |(place, ((width, height), photos)): (usize, &((u32, u32), Vec<PathBuf>))| {
        let names: Vec<String> = photos.iter().map(|path| path.display().to_string()).collect();
        let named = if place == 0 && photos.len() > 1 { format!("as {}", names[0]) } else { names.join(", ") };
        format!("{width} x {height} px ({}: {named})", photos.len())
    };
    all.iter().enumerate().map(one).collect::<Vec<_>>().join("; ")
}
