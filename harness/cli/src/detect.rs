//! `calibench detect`: a board's points, or the targets of a coded field, as approximate positions.

use std::path::PathBuf;

use calibench_cameras::inputs_of;
use calibench_exchange::write_points;
use calibench_measure::Board as Counts;
use calibench_model::boards::Board;
use calibench_model::{PointRef, PointRow};
use calibench_photographs::Chessboard;
use calibench_photographs::coded::{Coded, recognise_coded};
use calibench_photographs::names::once;
use calibench_recognise::{Classifier, NotRecognised, Recogniser};
use calibench_scenario::catalogue::is_toml;
use calibench_scenario::{Scenario, Subject, ViewsSubject};
use clap::{Args, ValueEnum};

use super::context::{Context, finder};
use super::output;
use super::photos::AsRead;
use super::progress::Progress;
use crate::board::board_of;
use crate::deliver::deliver;
use crate::failure::Failure;

#[derive(Args)]
pub struct Detect {
    /// Photographs: PNG, JPEG, TIFF or PNM, 8 or 16 bits
    #[arg(required = true, value_name = "PHOTO")]
    photos: Vec<PathBuf>,
    /// The chessboard's inner corners, as in 9x6
    #[arg(long, value_name = "COLUMNSxROWS", required_unless_present_any = ["board", "testfield"], conflicts_with_all = ["board", "testfield"])]
    chessboard: Option<Counts>,
    /// A board that may be in view in part: charuco:8x5:30:21:DICT_4X4_50, aprilgrid:6x6:0.088:0.3, circles:7x5:20, acircles:4x11:20, rings:12:6x5:50:8, puzzle:23x16:30:50,100, dotted:9x6:25, or a target file of Kalibr's (.yaml)
    #[arg(long, value_name = "BOARD", value_parser = board_of, conflicts_with = "testfield")]
    board: Option<Board>,
    /// The coded field that a scenario describes, by its name or TOML file: the targets of its whole squares in view
    #[arg(long, value_name = "SCENARIO")]
    testfield: Option<String>,
    /// What tells the shapes of a coded field's targets apart
    #[arg(long, value_enum, default_value_t, conflicts_with_all = ["board", "chessboard"])]
    classifier: Shapes,
    #[command(flatten)]
    read: AsRead,
    /// Where the points go [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
}

/// A classifier, as an option.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Shapes {
    /// Drawings of the targets, under the blur of the grid's lines
    #[default]
    Modern,
    /// Angles along the contour and the best of six decisions (Vosselman & Förstner 1988)
    Contours,
}

impl Detect {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let chessboard = self.chessboard.map(|board| Board::from(Chessboard { board, side: 1.0 }));
        match (&self.testfield, self.board.or(chessboard)) {
            (Some(name), _) => self.field(context, name),
            (None, Some(board)) => self.board(context, board),
            (None, None) => Err(Failure::input("expected --board, --chessboard or --testfield")),
        }
    }

    fn board(&self, context: &Context<'_>, board: Board) -> Result<(), Failure> {
        let output = output::table("-o", self.output.as_deref(), &inputs_of(&self.photos))?;
        let finder = finder(board)?;
        let progress = Progress::start("detect", self.photos.len() as u64, context.quiet);
        once(&self.photos)?;
        let found = finder.find_all(&self.read.reader(&self.photos)?, &|| progress.step())?;
        let seen = found.iter().filter(|sighting| !sighting.rows.is_empty()).count();
        progress.finish(&format!("the board was found in {seen} of {} photographs", found.len()));
        let mut doubtful = false;
        for (path, sighting) in self.photos.iter().zip(&found) {
            sighting.why.iter().for_each(|why| say!("{}: {why}", path.display()));
            sighting.doubts.iter().for_each(|doubt| say!("{}: in doubt: {doubt}", path.display()));
            doubtful |= !sighting.doubts.is_empty();
        }
        if seen == 0 {
            return Err(Failure::input(
                "no board was found; expected one as it was described (of a chessboard all inner corners visible, counted as COLUMNSxROWS)",
            ));
        }
        deliver(output.as_ref(), |file| write_points(file, found.iter().flat_map(|sighting| &sighting.rows).map(PointRef::from)))?;
        if doubtful { Err(Failure::Doubt) } else { Ok(()) }
    }

    fn field(&self, context: &Context<'_>, name: &str) -> Result<(), Failure> {
        let scenario = context.scenario(name)?;
        let file = Some(PathBuf::from(name)).filter(|path| is_toml(path));
        let read = inputs_of(self.photos.iter().cloned().chain(file));
        let output = output::table("-o", self.output.as_deref(), &read)?;
        let subject = views(&scenario)?;
        let classifier = match self.classifier {
            Shapes::Modern => Classifier::Modern,
            Shapes::Contours => Classifier::Contours,
        };
        let recogniser = Recogniser::new(&subject.field, classifier)
            .map_err(|error| Failure::input(format!("--testfield {name}: {error}; its [testfield] must have kind = \"coded\"")))?;
        let progress = Progress::start("detect", self.photos.len() as u64, context.quiet);
        once(&self.photos)?;
        let found = recognise_coded(&self.read.reader(&self.photos)?, &subject.field, &recogniser, &|| progress.step())?;
        let rows: Vec<&PointRow> = found.iter().flatten().flat_map(|coded| &coded.rows).collect();
        let seen = found.iter().flatten().count();
        progress.finish(&format!("the field was recognised in {seen} of {} photographs, {} targets", found.len(), rows.len()));
        self.photos.iter().zip(&found).filter_map(|(path, found)| Some((path, remark(found)?))).for_each(|(path, remark)| {
            say!("{}: {remark}", path.display());
        });
        if rows.is_empty() {
            return Err(Failure::input(format!(
                "no target was recognised; expected photographs of the field of `{}` that show at least one whole square with its lines",
                scenario.name
            )));
        }
        deliver(output.as_ref(), |file| write_points(file, rows.into_iter().map(PointRef::from)))
    }
}

/// The views of a scenario that has a testfield.
fn views(scenario: &Scenario) -> Result<&ViewsSubject, Failure> {
    match &scenario.subject {
        Subject::Views(subject) => Ok(subject),
        Subject::Scene(_) | Subject::Photographs(_) | Subject::Printed(_) => Err(Failure::input(format!(
            "--testfield: `{}` has no testfield; expected a scenario with [testfield] kind = \"coded\"",
            scenario.name
        ))),
    }
}

/// What is to be said of a photograph, if anything: why it does not show the field, or what was not recognised of its whole squares.
fn remark(found: &Result<Coded, NotRecognised>) -> Option<String> {
    match found {
        Err(error) => Some(format!("not recognised ({}): {error}", error.name())),
        Ok(coded) if coded.rows.is_empty() && coded.lost.is_empty() => {
            Some(format!("{} whole squares of the field, of which the scenario lists no target", coded.squares))
        }
        Ok(coded) if coded.lost.is_empty() => None,
        Ok(coded) => Some(format!("{} targets of {} whole squares recognised, {}", coded.rows.len(), coded.squares, coded.lost)),
    }
}
