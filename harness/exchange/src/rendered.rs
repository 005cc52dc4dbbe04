//! Which images a folder of renders holds: the list that `render` writes beside them.

use std::io::{self, Write};
use std::path::Path;

use calibench_files::bounded;
use calibench_files::table::write_table;
use calibench_model::escape;
use calibench_model::points::Names;
use csv::StringRecord;

use crate::fingerprint::Fingerprint;
use crate::points::{PointFileError, csv_error, line_of};

/// The name of the list in the folder.
pub const RENDERED: &str = "rendered.csv";
const COLUMNS: [&str; 6] = ["image", "scenario", "seed", "trial", "view", "fingerprint"];

/// An image of a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderedImage {
    /// Its file name.
    pub image: String,
    /// The scenario.
    pub scenario: String,
    /// The seed of its random numbers.
    pub seed: u64,
    /// The trial, counted from 0.
    pub trial: u64,
    /// The view: a station's name, or that of a scene's only view.
    pub view: String,
    /// By which it is known again.
    pub fingerprint: Fingerprint,
}

/// Writes the list of images.
///
/// # Errors
/// What the output refuses.
pub fn write_rendered(output: impl Write, images: &[RenderedImage]) -> io::Result<()> {
    let row = |one: &RenderedImage| {
        let RenderedImage { image, scenario, seed, trial, view, fingerprint } = one;
        [image.clone(), scenario.clone(), seed.to_string(), trial.to_string(), view.clone(), fingerprint.to_string()]
    };
    write_table(output, &COLUMNS, images.iter().map(row))
}

/// The list of images of a folder, in the order of the file.
///
/// # Errors
/// The first mistake, with line and column: another header, a cell that is none, an image that is there twice, no image.
pub fn read_rendered(folder: &Path) -> Result<Vec<RenderedImage>, PointFileError> {
    let path = folder.join(RENDERED);
    let file = path.display().to_string();
    let wrong =
        |line, column: Option<&str>, problem| PointFileError { file: file.clone(), line, column: column.map(str::to_owned), problem };
    let text =
        bounded::table(&path).map_err(|error| wrong(None, None, format!("{error}; expected the list that `calibench render` writes")))?;
    let mut reader = csv::Reader::from_reader(&text[..]);
    if *reader.headers().map_err(|error| csv_error(&file, &error))? != COLUMNS[..] {
        return Err(wrong(Some(1), None, format!("expected the header {}", COLUMNS.join(","))));
    }
    let (mut images, mut names, mut record) = (Vec::new(), Names::default(), StringRecord::new());
    while reader.read_record(&mut record).map_err(|error| csv_error(&file, &error))? {
        let line = Some(line_of(&text, &record));
        let image = read(&record).map_err(|column| {
            let found = &record[COLUMNS.iter().position(|known| *known == column).unwrap_or(0)];
            wrong(line, Some(column), format!("found `{found}`; expected what `calibench render` wrote"))
        })?;
        if names.place(&image.image) < images.len() {
            return Err(wrong(line, Some(COLUMNS[0]), format!("`{}` is there already; expected each image once", image.image)));
        }
        images.push(image);
    }
    if images.is_empty() { Err(wrong(None, None, "holds no image".to_owned())) } else { Ok(images) }
}

/// The image of a row, or the column that is wrong.
fn read(record: &StringRecord) -> Result<RenderedImage, &'static str> {
    let name = |column: usize| escape::from_cell(&record[column]).to_owned();
    let number = |column: usize| record[column].parse().map_err(|_| COLUMNS[column]);
    let fingerprint = record[5].parse().map_err(|_| COLUMNS[5])?;
    Ok(RenderedImage { image: name(0), scenario: name(1), seed: number(2)?, trial: number(3)?, view: name(4), fingerprint })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use calibench_model::Image;

    fn image(name: &str, trial: u64) -> RenderedImage {
        let fingerprint = Fingerprint::of(&Image::from_fn(5, 4, |x, y| (x * y) as f32 / 12.0), true);
        RenderedImage { image: name.into(), scenario: "a/b".into(), seed: 7, trial, view: "=left".into(), fingerprint }
    }

    #[test]
    fn what_is_written_is_read_again_and_mistakes_have_their_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(RENDERED);
        let error = || read_rendered(folder.path()).unwrap_err().to_string();
        assert!(error().contains("`calibench render` writes"));
        let images = [image("one.png", 0), image("two.png", 3)];
        write_rendered(fs::File::create(&path).unwrap(), &images).unwrap();
        assert_eq!(read_rendered(folder.path()).unwrap(), images);
        let text = fs::read_to_string(&path).unwrap();
        for (old, new, expected) in [
            (",seed,", ",sed,", ":1: expected the header image,scenario,seed"),
            (",3,", ",x,", ":3, column `trial`: found `x`"),
            ("5x4x16", "5x4", ":2, column `fingerprint`"),
            ("two.png", "one.png", ":3, column `image`: `one.png` is there already"),
        ] {
            fs::write(&path, text.replacen(old, new, 1)).unwrap();
            assert!(error().contains(expected), "{expected}: {}", error());
        }
        fs::write(&path, text.lines().next().unwrap()).unwrap();
        assert!(error().contains("holds no image"));
    }
}
