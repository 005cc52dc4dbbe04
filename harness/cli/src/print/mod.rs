//! `calibench print`.

use std::path::{Path, PathBuf};

use calibench_cameras::kalibr_target;
use calibench_files::Inputs;
use calibench_model::Testfield;
use calibench_model::boards::Board;
use calibench_prints::{Paper, PrintError, PrintOptions, write_sheets};
use calibench_scenario::Subject;
use clap::{Args, ValueEnum};

use super::context::Context;
use super::output;
use crate::board::{HELP, board_of};
use crate::failure::Failure;

mod board;

/// The file that describes a board for Kalibr.
const KALIBR_TARGET: &str = "target.yaml";
/// The folder of a board where none is named.
const FOLDER: &str = "board";

/// Writes a board, or a scenario's testfield, at true scale, as SVG and PDF, and of a board that Kalibr knows its target.yaml.
#[derive(Args)]
pub struct Print {
    /// Name of a scenario, or a TOML file
    #[arg(conflicts_with = "board")]
    scenario: Option<String>,
    #[arg(long, visible_alias = "chessboard", value_name = "BOARD", value_parser = board_of, help = HELP)]
    board: Option<Board>,
    /// What the lengths of --board are in
    #[arg(long, value_enum, default_value_t, requires = "board")]
    unit: Unit,
    /// The folder; of one that is there, only what calibench wrote is replaced, and if it holds anything else it is refused [default: with --board the folder `board`]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Pages as large as each plate, or this paper: a board must fit on one sheet, the plates of a scenario become tiles with marks to join them
    #[arg(long, value_enum, default_value_t = Size::Whole, ignore_case = true)]
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
    /// 8.5 x 11 inches
    Letter,
}

impl Size {
    const fn paper(self) -> (Paper, &'static str) {
        match self {
            Self::Whole => (Paper::Whole, "whole"),
            Self::A4 => (Paper::A4, "A4"),
            Self::A3 => (Paper::A3, "A3"),
            Self::Letter => (Paper::LETTER, "Letter"),
        }
    }
}

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Unit {
    /// Millimetres
    #[default]
    Mm,
    /// Metres
    M,
}

/// What is printed.
struct Sheets {
    field: Testfield,
    options: PrintOptions,
    board: Option<Board>,
    inputs: Inputs,
    project: Option<PathBuf>,
}

impl Print {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let Sheets { field, options, board, inputs, project } = match (self.board, &self.scenario) {
            (Some(board), _) => self.of_board(board)?,
            (None, Some(scenario)) => self.of_scenario(context, scenario)?,
            (None, None) => return Err(Failure::input("expected --board BOARD, as in 9x6:25, or the name of a scenario")),
        };
        let folder = match (&self.output, self.board) {
            (Some(output), _) => output.as_path(),
            (None, Some(_)) => Path::new(FOLDER),
            (None, None) => return Err(Failure::input("expected -o DIR: the folder for the sheets")),
        };
        let output = output::folder("-o", folder, &inputs, ("print", project.as_deref()))?;
        let target = board.map(|board| kalibr_target(&board, 1e-3 * options.mm_per_unit));
        output.replace(|folder| {
            write_sheets(folder, &field, &options)?;
            if let Some(Ok(text)) = &target {
                folder.write(KALIBR_TARGET, |file| file.write_all(text.as_bytes()))?;
            }
            Ok::<_, PrintError>(())
        })?;
        if let (Some(Err(why)), false) = (target, context.quiet) {
            say!("no {KALIBR_TARGET} for Kalibr: {why}");
        }
        if self.board.is_some() && !context.quiet {
            say!("print {} at 100 %, not fitted to the page; its bar must measure 100 mm", folder.join(options.name + ".pdf").display());
        }
        crate::deliver::print(&format!("{}\n", folder.display()))
    }

    fn of_board(&self, board: Board) -> Result<Sheets, Failure> {
        let mm_per_unit = match self.unit {
            Unit::Mm => 1.0,
            Unit::M => 1000.0,
        };
        let (paper, called) = self.paper.paper();
        let field = board::field(board, mm_per_unit, (&paper, called))?;
        let options = PrintOptions { name: board::name(&board), mm_per_unit, paper };
        Ok(Sheets { field, options, board: Some(board), inputs: Inputs::default(), project: None })
    }

    fn of_scenario(&self, context: &Context<'_>, name: &str) -> Result<Sheets, Failure> {
        let scenario = context.scenario(name)?;
        let inputs = context.inputs(name, &scenario);
        let stem = scenario.name.replace('/', "-");
        let Subject::Views(subject) = scenario.subject else {
            return Err(Failure::input(format!(
                "`{}` has no testfield to print; expected a scenario with [testfield], or --board",
                scenario.name
            )));
        };
        let options = PrintOptions { name: stem, mm_per_unit: subject.unit.mm(), paper: self.paper.paper().0 };
        Ok(Sheets { field: subject.field, options, board: subject.sheet, inputs, project: context.folder()? })
    }
}
