//! `calibench print`.

use std::path::PathBuf;

use calibench_cameras::kalibr_target;
use calibench_prints::{Paper, PrintError, PrintOptions, write_sheets};
use calibench_scenario::Subject;
use clap::{Args, ValueEnum};

use super::context::Context;
use super::output;
use crate::failure::Failure;

/// The file that describes a board for Kalibr.
const KALIBR_TARGET: &str = "target.yaml";

/// Writes a scenario's testfield at true scale, as SVG and PDF, and of a board that Kalibr knows its target.yaml.
#[derive(Args)]
pub struct Print {
    /// Name of a scenario, or a TOML file
    scenario: String,
    /// The folder; of one that is there, only what calibench wrote is replaced, and if it holds anything else it is refused
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Pages as large as each plate, or tiles of this paper with marks to join them
    #[arg(long, value_enum, default_value_t = Size::Whole)]
    paper: Size,
}

/// A size of paper.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Size {
    /// As large as the plate
    Whole,
    /// 210 x 297 mm
    A4,
    /// 297 x 420 mm
    A3,
}

impl Print {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let scenario = context.scenario(&self.scenario)?;
        let Subject::Views(subject) = &scenario.subject else {
            return Err(Failure::input(format!("`{}` has no testfield to print; expected a scenario with [testfield]", scenario.name)));
        };
        let paper = match self.paper {
            Size::Whole => Paper::Whole,
            Size::A4 => Paper::A4,
            Size::A3 => Paper::A3,
        };
        let stem = scenario.name.replace('/', "-");
        let options = PrintOptions { name: stem, mm_per_unit: subject.unit.mm(), paper };
        let project = context.folder()?;
        let output = output::folder("-o", &self.output, &context.inputs(&self.scenario, &scenario), ("print", project.as_deref()))?;
        let target = subject.sheet.map(|board| kalibr_target(&board, 1e-3 * subject.unit.mm()));
        output.replace(|folder| {
            write_sheets(folder, &subject.field, &options)?;
            if let Some(Ok(text)) = &target {
                folder.write(KALIBR_TARGET, |file| file.write_all(text.as_bytes()))?;
            }
            Ok::<_, PrintError>(())
        })?;
        if let (Some(Err(why)), false) = (target, context.quiet) {
            say!("no {KALIBR_TARGET} for Kalibr: {why}");
        }
        crate::deliver::print(&format!("{}\n", self.output.display()))
    }
}
