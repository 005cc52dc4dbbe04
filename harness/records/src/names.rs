//! Where records lie.

use std::path::{Path, PathBuf};

/// The scenario as it was run, in the folder of its records.
pub const SCENARIO: &str = "scenario.toml";
/// What the pages of the scenario tell of it, in the same folder: a [`Description`](crate::description::Description).
pub const DESCRIPTION: &str = "scenario.json";

/// In the same folder, the path of the scenario's file, if it is not one of the project's.
pub const ORIGIN: &str = "origin.txt";

/// In the folder of a part of a run, what the part is: a [`Manifest`](crate::parts::Manifest). Such a folder is no run.
pub const PART: &str = "part.json";

/// The name of the folder of a cell's records in that of its scenario.
pub fn cell_name(index: usize) -> String {
    format!("cell-{:04}", index + 1)
}

/// The name of the run of a scenario's cell, whose label is `label`.
pub fn cell_run(name: &str, label: &str) -> String {
    format!("{name}@{label}")
}

/// The folder of a cell's records in that of its scenario.
pub fn cell_folder(folder: &Path, index: usize) -> PathBuf {
    folder.join(cell_name(index))
}

/// The name under which the image of view `view` is kept: its full name, so that `a.jpg` and `a.png` do not meet.
pub fn kept_image_name(view: &str) -> String {
    format!("{view}.png")
}

/// Where the image of view `view` is kept in the folder of a scenario's records.
pub fn kept_image(folder: &Path, view: &str) -> PathBuf {
    folder.join(kept_image_name(view))
}

/// The set of figures under which counts of detections stand.
pub const DETECTION: &str = "detection";

/// Under which view the picture of a step of recognition in view `view` is kept.
pub fn recognition_step(view: &str, step: &str) -> String {
    format!("recognition-{view}-{step}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_cells_sort_as_they_are_counted() {
        assert_eq!((cell_name(0), cell_name(1233)), ("cell-0001".into(), "cell-1234".into()));
        assert_eq!(cell_folder(Path::new("a/b"), 8), PathBuf::from("a/b/cell-0009"));
        let names: Vec<String> = (0..120).map(cell_name).collect();
        assert!(names.is_sorted() && names.windows(2).all(|pair| pair[0] != pair[1]));
    }

    #[test]
    fn images_of_one_stem_do_not_meet() {
        assert_eq!((kept_image_name("a.jpg"), kept_image_name("a.png")), ("a.jpg.png".into(), "a.png.png".into()));
        assert_eq!(kept_image(Path::new("x"), "left"), PathBuf::from("x/left.png"));
    }
}
