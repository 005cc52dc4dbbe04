//! Corners from point files, each in the place of an operator.

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

use calibench_calibrate::choice::HALF;
use calibench_exchange::PointFile;
use calibench_judge::{Expected, FEWEST, Material};
use calibench_model::camera::ImageSize;
use calibench_model::escape;
use calibench_photographs::Chessboard;
use calibench_records::judgement::COMPARABLE;

use crate::failure::Failure;
use crate::inputs::checked;

/// A file of corners and what it is called in the verdict.
#[derive(Clone, Debug)]
pub struct CornerFile {
    pub name: Arc<str>,
    pub path: PathBuf,
}

impl FromStr for CornerFile {
    type Err = String;

    /// `FILE` or `NAME=FILE`. A file or a name may hold `=` itself: what is there decides.
    fn from_str(text: &str) -> Result<Self, String> {
        let splits = || text.match_indices('=').map(|(at, _)| (&text[..at], Path::new(&text[at + 1..])));
        let named = if Path::new(text).exists() { None } else { splits().find(|(_, file)| file.exists()).or_else(|| splits().next()) };
        let (name, path) = match named {
            Some((name, path)) => (name.to_owned(), path),
            None => (stem(Path::new(text)), Path::new(text)),
        };
        let plain = !name.is_empty() && !name.contains('`') && escape::name(&name) == name && escape::cell(&name) == name;
        if !plain {
            return Err(format!(
                "`{}` is no name of an operator: expected NAME=FILE with a plain name, as in left=corners.csv",
                escape::name(&name)
            ));
        }
        Ok(Self { name: name.into(), path: path.to_owned() })
    }
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The corners of `chessboard` that the files hold, of images of one size.
pub fn material(files: &[CornerFile], chessboard: Chessboard, size: ImageSize) -> Result<Material, Failure> {
    told_apart(files)?;
    let expected = Expected::new(chessboard.board, size);
    let read = |file: &CornerFile| Ok((file.name.clone(), checked(&file.path, &|point| expected.check(point))?));
    let read = files.iter().map(read).collect::<Result<Vec<_>, Failure>>()?;
    files.iter().zip(&read).try_for_each(|(file, (_, read))| of_board(&expected, file, read))?;
    same_images(files, &read)?;
    let material = Material::of_files(&read, chessboard.board, chessboard.side, size);
    files.iter().enumerate().try_for_each(|(operator, file)| enough(&material, operator, file))?;
    files.iter().enumerate().try_for_each(|(operator, file)| comparable(&material, operator, file))?;
    Ok(material)
}

/// Each file once, and no two of one name.
fn told_apart(files: &[CornerFile]) -> Result<(), Failure> {
    for (index, file) in files.iter().enumerate() {
        let (path, name) = (file.path.display(), &file.name);
        let same = |earlier: &CornerFile| match (earlier.path.canonicalize(), file.path.canonicalize()) {
            (Ok(earlier), Ok(path)) => earlier == path,
            _ => earlier.path == file.path,
        };
        if files[..index].iter().any(same) {
            return Err(Failure::input(format!("--points {path}: given twice; expected each file once")));
        }
        if let Some(earlier) = files[..index].iter().find(|earlier| earlier.name == *name) {
            return Err(Failure::input(format!(
                "--points: two files are called `{name}`: {} and {path}; give them names, as in --points first={} --points second={path}",
                earlier.path.display(),
                earlier.path.display()
            )));
        }
    }
    Ok(())
}

/// Files are compared on the images that they share.
fn same_images(files: &[CornerFile], read: &[(Arc<str>, PointFile)]) -> Result<(), Failure> {
    let Some((first, others)) = read.split_first() else { return Ok(()) };
    let (known, path) = (first.1.points.images(), files[0].path.display());
    for ((_, other), file) in others.iter().zip(&files[1..]) {
        let images = other.points.images();
        if images.iter().all(|image| known.find(image).is_none()) {
            let [here, there] = [images, known].map(|names| names.iter().next().unwrap_or_default());
            return Err(Failure::input(format!(
                "{}: has no image in common with {path}: it names `{here}`, the other `{there}`; expected files of the same images, by the same names",
                file.path.display()
            )));
        }
    }
    Ok(())
}

/// Rows without a position name corners of the board as well.
fn of_board(expected: &Expected, file: &CornerFile, read: &PointFile) -> Result<(), Failure> {
    read.lost
        .iter()
        .try_for_each(|[_, target, ..]| expected.name(target))
        .map_err(|why| Failure::input(format!("{}: {why}", file.path.display())))
}

/// As many corners as a comparison with the other files takes.
fn comparable(material: &Material, operator: usize, file: &CornerFile) -> Result<(), Failure> {
    let (found, all) = (material.measured(operator), material.tried().iter().sum::<usize>());
    if found as f64 >= COMPARABLE * all as f64 {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{}: has {found} of the {all} corners that the files have together; operators are compared where each has {:.0} % of them; give files of the same \
         images and corners, or judge each alone",
        file.path.display(),
        100.0 * COMPARABLE
    )))
}

/// As many images as two halves take.
fn enough(material: &Material, operator: usize, file: &CornerFile) -> Result<(), Failure> {
    let (found, needed) = (material.usable(operator).len(), 2 * HALF);
    if found >= needed {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{}: judging takes at least {needed} images with {} corners or more (each half of them is calibrated by itself), found {found}; measure more images of the board",
        file.path.display(),
        FEWEST.min(material.board.corners())
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_called_as_it_is_or_as_the_user_says() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).display().to_string();
        std::fs::write(at("a=b.csv"), "").unwrap();
        std::fs::write(at("c.csv"), "").unwrap();
        let named = |text: &str| text.parse::<CornerFile>().map(|file| (file.name.to_string(), file.path.display().to_string()));
        assert_eq!(named(&at("a=b.csv")), Ok(("a=b".into(), at("a=b.csv"))));
        assert_eq!(named(&format!("mine={}", at("a=b.csv"))), Ok(("mine".into(), at("a=b.csv"))));
        assert_eq!(named(&format!("saddle:window=7={}", at("c.csv"))), Ok(("saddle:window=7".into(), at("c.csv"))));
        assert_eq!(named("mine=absent.csv"), Ok(("mine".into(), "absent.csv".into())));
        assert_eq!(named("x/absent.csv"), Ok(("absent".into(), "x/absent.csv".into())));
        for wrong in [format!("={}", at("c.csv")), format!("a`b={}", at("c.csv")), "a\nb.csv".into(), "+1+2.csv".into()] {
            assert!(named(&wrong).unwrap_err().contains("is no name of an operator"), "{wrong}");
        }
    }
}
