//! Corners from point files, each in the place of an operator.

use std::path::Path;

use calibench_judge::{CornerFile, Expected, Field, Material};
use calibench_model::camera::ImageSize;
use calibench_model::escape;

use crate::failure::Failure;
use crate::inputs::checked;

/// `FILE` or `NAME=FILE`. A file or a name may hold `=` itself: what is there decides.
pub fn corner_file(text: &str) -> Result<CornerFile, String> {
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
    Ok(CornerFile { name: name.into(), path: path.to_owned() })
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The points of `field` that the files hold, of images of one size.
pub fn material(files: &[CornerFile], field: Field, size: ImageSize) -> Result<Material, Failure> {
    CornerFile::told_apart(files)?;
    let expected = Expected::new(field, size);
    let read = |file: &CornerFile| checked(&file.path, &|point| expected.check(point));
    let read = files.iter().map(read).collect::<Result<Vec<_>, Failure>>()?;
    Ok(Material::of_corner_files(files, &read, &expected)?)
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
        let named = |text: &str| corner_file(text).map(|file| (file.name.to_string(), file.path.display().to_string()));
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
