//! `calibench init`: a project of one's own with a gate, of operators or of a calibrator.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use super::bless::Bless;
use super::context::Context;
use crate::deliver::print;
use crate::failure::Failure;

/// What is written in either case, by its path in the project.
const FILES: [(&str, &str); 2] = [(".gitignore", "/records/\n"), ("reference/baselines/ceilings.toml", include_str!("ceilings.toml"))];
/// For operators.
const OPERATORS: [(&str, &str); 2] =
    [("README.md", include_str!("README.md")), ("scenarios/first/corners.toml", include_str!("corners.toml"))];
/// For a calibrator.
const CALIBRATOR: [(&str, &str); 4] = [
    ("README.md", include_str!("calibrator.md")),
    ("scenarios/first/board.toml", include_str!("board.toml")),
    ("methods/mine.toml", include_str!("mine.toml")),
    ("methods/mine.py", include_str!("mine.py")),
];

#[derive(Args)]
pub struct Init {
    /// The folder, new or empty
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// For a calibration system of one's own: a board in noise, and a program to put it in
    #[arg(long)]
    calibrator: bool,
}

impl Init {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let folder = &self.folder;
        let failed = |path: &Path, error: &std::io::Error| Failure::input(format!("{}: {error}", path.display()));
        if let Some(first) = first_entry(folder).map_err(|error| failed(folder, &error))? {
            return Err(Failure::input(format!("{}: holds `{first}`; expected a new or an empty folder", folder.display())));
        }
        let schema = format!("{:#}\n", calibench_scenario::schema::schema(context.registry()?));
        let own: &[(&str, &str)] = if self.calibrator { &CALIBRATOR } else { &OPERATORS };
        let all = FILES.iter().chain(own).copied().chain([("scenarios/scenario.schema.json", schema.as_str())]);
        for (name, text) in all {
            let path = folder.join(name);
            path.parent()
                .map_or(Ok(()), fs::create_dir_all)
                .and_then(|()| fs::write(&path, text))
                .map_err(|error| failed(&path, &error))?;
        }
        let inside = Context::new(context.toolbox, context.quiet, Some(folder.clone()), None);
        Bless::all().run(&inside)?;
        print(&format!(
            "{}: one scenario, blessed. Next: `calibench check` in that folder; its README.md has the commands\n",
            folder.display()
        ))
    }
}

/// The name of something in the folder; nothing if it is empty or not there.
fn first_entry(folder: &Path) -> std::io::Result<Option<String>> {
    match fs::read_dir(folder) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
        Ok(mut entries) => entries.next().map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned())).transpose(),
    }
}
