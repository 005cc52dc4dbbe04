//! Whose folder it is: the command that fills it, and the project for which.

use std::path::{Component, Path, PathBuf};

const COMMAND: &str = "# command: calibench ";
const PROJECT: &str = "# project: ";

/// Who wrote a folder, and who alone may replace it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Owner {
    command: String,
    /// The project, as it is found from the folder.
    project: Option<String>,
}

impl Owner {
    /// `command` for a folder at `folder`, and for a project if there is one. Folders keep their way to the project: both may be moved together.
    pub fn new(command: &str, folder: &Path, project: Option<&Path>) -> Self {
        let way = project.and_then(|project| way(&whole(folder)?, &project.canonicalize().ok()?));
        Self { command: command.to_owned(), project: way }
    }

    /// The one that the comments of a manifest name.
    pub fn read(manifest: &str) -> Option<Self> {
        let of = |begin: &str| manifest.lines().take_while(|line| line.starts_with('#')).find_map(|line| line.strip_prefix(begin));
        Some(Self { command: of(COMMAND)?.to_owned(), project: of(PROJECT).map(str::to_owned) })
    }

    /// Its lines in a manifest.
    pub fn text(&self) -> String {
        let project = self.project.as_ref().map(|project| format!("{PROJECT}{project}\n"));
        format!("{COMMAND}{}\n{}", self.command, project.unwrap_or_default())
    }

    /// Why a folder at `folder` of this owner is not replaced by `other`: another command, or another project that is still there.
    pub fn refuses(&self, other: &Self, folder: &Path) -> Option<String> {
        let at =
            |owner: &Self| owner.project.as_ref().and_then(|way| folder.join(way).canonicalize().ok()).filter(|found| is_project(found));
        let (there, here) = (at(self), at(other));
        if self.command == other.command && (there.is_none() || here.is_none() || there == here) {
            return None;
        }
        let of = there.map_or_else(String::new, |project| format!(" of the project {}", project.display()));
        Some(format!(
            "was written by `calibench {}`{of}, and is not replaced by `calibench {}`: name another folder",
            self.command, other.command
        ))
    }
}

/// Whether a folder is a project: it holds `scenarios` and `reference`.
pub fn is_project(folder: &Path) -> bool {
    folder.join("scenarios").is_dir() && folder.join("reference").is_dir()
}

/// The real path of a folder that may not be there yet.
fn whole(folder: &Path) -> Option<PathBuf> {
    folder.canonicalize().ok().or_else(|| Some(whole(folder.parent().filter(|parent| *parent != folder)?)?.join(folder.file_name()?)))
}

/// The way from one folder to another, with `/` between folders; none where a name is no plain text.
fn way(from: &Path, to: &Path) -> Option<String> {
    let common = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    let up = from.components().skip(common).map(|_| Some(".."));
    let down = to.components().skip(common).map(|part| match part {
        Component::Normal(name) => name.to_str().filter(|name| !name.contains(char::is_control)),
        _ => None,
    });
    let way: Vec<&str> = up.chain(down).collect::<Option<_>>()?;
    Some(if way.is_empty() { ".".to_owned() } else { way.join("/") })
}

#[cfg(test)]
mod tests {
    use std::{fs, io};

    use super::super::OutputFolder;
    use super::*;

    fn replace(folder: &Path, command: &str, project: Option<&Path>) -> io::Result<()> {
        let output = OutputFolder::open(folder)?.owned_by(command, project)?;
        output.replace(|new| new.write("page", |file| file.write_all(command.as_bytes())))
    }

    #[test]
    fn a_folder_is_replaced_by_its_own_command_and_project_alone() {
        let all = tempfile::tempdir().unwrap();
        let at = |name: &str| all.path().join(name);
        ["one/scenarios", "one/reference", "two/scenarios", "two/reference"].iter().for_each(|part| fs::create_dir_all(at(part)).unwrap());
        let (one, two, folder) = (at("one"), at("two"), at("one/records/a"));
        replace(&folder, "run", Some(&one)).unwrap();
        replace(&folder, "run", Some(&one)).unwrap();
        for (command, project, expected) in [
            ("render", &one, "was written by `calibench run` of the project"),
            ("run", &two, "one, and is not replaced by `calibench run`"),
        ] {
            let error = replace(&folder, command, Some(project)).unwrap_err().to_string();
            assert!(error.contains(expected) && error.contains("records/a: "), "{error}");
        }
        assert!(replace(&folder, "render", None).is_err());
        assert_eq!(fs::read_to_string(folder.join("page")).unwrap(), "run");
        // Moved with its project, or away from a project that is gone, it is still its own.
        fs::rename(&one, at("moved")).unwrap();
        replace(&at("moved/records/a"), "run", Some(&at("moved"))).unwrap();
        fs::rename(at("moved/records/a"), at("b")).unwrap();
        fs::remove_dir_all(at("moved")).unwrap();
        replace(&at("b"), "run", Some(&two)).unwrap();
        assert!(replace(&at("b"), "run", None).is_ok());
    }

    #[test]
    fn what_an_older_calibench_wrote_belongs_to_whoever_replaces_it() {
        let all = tempfile::tempdir().unwrap();
        let folder = all.path().join("a");
        OutputFolder::open(&folder).unwrap().replace::<io::Error>(|new| new.write("page", |file| file.write_all(b"old"))).unwrap();
        replace(&folder, "render", None).unwrap();
        assert!(replace(&folder, "run", None).is_err());
    }
}
