//! `calibench detect`: a board's points, or the targets of a coded field, as approximate positions.

use std::path::PathBuf;

use calibench_cameras::inputs_of;
use calibench_exchange::write_points;
use calibench_files::{Inputs, OutputFolder};
use calibench_model::boards::Board;
use calibench_model::{PointRef, PointRow};
use calibench_photographs::coded::{Coded, recognise_coded};
use calibench_photographs::names::once;
use calibench_photographs::unknown::{Shown, identify, shown, with_lengths};
use calibench_photographs::{Identified, Reader};
use calibench_recognise::{Classifier, NotRecognised, Recogniser};
use calibench_scenario::catalogue::is_toml;
use calibench_scenario::{Scenario, Subject, ViewsSubject};
use clap::{Args, ValueEnum};

use super::context::{Context, finder};
use super::frames::{Frames, Wanted};
use super::output;
use super::photos::AsRead;
use super::progress::Progress;
use crate::board::{Asked, HELP_OR_UNKNOWN, board_or_unknown};
use crate::deliver::{deliver, print};
use crate::failure::Failure;

mod doubtful;
mod draw;

use draw::Drawn;

/// So many photographs in which a board was not found are asked what they show.
const LOOKED_AT: usize = 3;

#[derive(Args)]
pub struct Detect {
    /// Photographs, or a folder of them: PNG, JPEG, TIFF, PNM, BMP or WebP; or a video
    #[arg(required = true, value_name = "PHOTO")]
    photos: Vec<PathBuf>,
    #[arg(long, visible_alias = "chessboard", value_name = "BOARD", value_parser = board_or_unknown, help = HELP_OR_UNKNOWN,
          required_unless_present = "testfield", conflicts_with = "testfield")]
    board: Option<Asked>,
    /// Each of several such boards in a photograph, from the left: its points stand under the view PHOTO#1, PHOTO#2, ..., which `measure` and `calibrate` take as an image with a pose of its own
    #[arg(long, conflicts_with = "testfield")]
    all: bool,
    /// The coded field that a scenario describes, by its name or TOML file: the targets of its whole squares in view
    #[arg(long, value_name = "SCENARIO")]
    testfield: Option<String>,
    /// What tells the shapes of a coded field's targets apart
    #[arg(long, value_enum, default_value_t, conflicts_with = "board")]
    classifier: Shapes,
    /// Folder for the photographs with what was found drawn on them: the first points and those in doubt with their names; of one that is there, only what calibench wrote is replaced
    #[arg(long, value_name = "DIR")]
    draw: Option<PathBuf>,
    #[command(flatten)]
    frames: Frames,
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
    pub fn run(mut self, context: &Context<'_>) -> Result<(), Failure> {
        let board = if let Some(Asked::Board(board)) = self.board { Some(board) } else { None };
        let wanted = Wanted { command: "detect", board, each: self.all, read: &self.read, only_size: None };
        let taken = self.frames.taken(&self.photos, &wanted, context)?;
        self.photos.clone_from(&taken.photos);
        taken.doubts.iter().for_each(|doubt| say!("in doubt: {doubt}"));
        let done = match (&self.testfield, self.board) {
            (Some(name), _) => self.field(context, name),
            (None, Some(Asked::Board(board))) => self.board(context, board),
            (None, Some(Asked::Unknown)) => self.unknown(context),
            (None, None) => Err(Failure::input("expected --board or --testfield")),
        };
        done.and(if taken.doubts.is_empty() { Ok(()) } else { Err(Failure::Doubt) })
    }

    fn board(&self, context: &Context<'_>, board: Board) -> Result<(), Failure> {
        let inputs = inputs_of(&self.photos);
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
        let draw = self.draw_into(&inputs)?;
        let finder = finder(board)?.of_each(self.all);
        let progress = Progress::start("detect", self.photos.len() as u64, context.quiet);
        once(&self.photos)?;
        let reader = self.read.reader(&self.photos)?;
        let found = finder.find_all(&reader, &|| progress.step())?;
        let seen = found.iter().filter(|sighting| !sighting.rows.is_empty()).count();
        let light = found.iter().filter(|sighting| sighting.light).count();
        let lights = if light > 0 { format!(", its circles light on dark in {light}") } else { String::new() };
        let boards: usize = found.iter().map(|sighting| sighting.boards.len()).sum();
        let several = if self.all { format!(", {boards} times") } else { String::new() };
        progress.finish(&format!("the board was found in {seen} of {} photographs{several}{lights}", found.len()));
        let mut doubtful = false;
        for (path, sighting) in self.photos.iter().zip(&found) {
            sighting.why.iter().for_each(|why| say!("{}: {why}", path.display()));
            sighting.doubts.iter().for_each(|doubt| say!("{}: in doubt: {doubt}", path.display()));
            doubtful |= !sighting.doubts.is_empty();
        }
        say_several(self.all, found.iter().any(|sighting| !sighting.boards.is_empty()));
        if let Some(folder) = draw {
            let drawn: Vec<Drawn<'_>> =
                found.iter().map(|sighting| Drawn { rows: sighting.rows.iter().collect(), why: sighting.why.clone() }).collect();
            let said = draw::draw(&folder, &reader, &drawn, &finder.control())?;
            said.iter().for_each(|line| say!("{line}"));
            doubtful |= !said.is_empty();
        }
        if seen == 0 {
            return Err(Failure::input(format!(
                "no board was found; expected one as it was described (of a chessboard all inner corners visible, counted as COLUMNSxROWS){}",
                instead(&reader, &board)?
            )));
        }
        deliver(output.as_ref(), |file| write_points(file, found.iter().flat_map(|sighting| &sighting.rows).map(PointRef::from)))?;
        if doubtful { Err(Failure::Doubt) } else { Ok(()) }
    }

    /// The folder of --draw, if one is named.
    fn draw_into(&self, inputs: &Inputs) -> Result<Option<OutputFolder>, Failure> {
        self.draw.as_deref().map(|path| output::folder("--draw", path, inputs, ("detect", None))).transpose()
    }

    /// What board is there, and by which words it is found.
    fn unknown(&self, context: &Context<'_>) -> Result<(), Failure> {
        if self.output.is_some() || self.all || self.draw.is_some() {
            return Err(Failure::input(
                "--board unknown names the board and has no points: leave -o, --all and --draw out, then ask for the board by its words",
            ));
        }
        let progress = Progress::start("detect", self.photos.len() as u64, context.quiet);
        let Shown { each, best, others } = shown(&self.read.reader(&self.photos)?, &|| progress.step())?;
        let lines = self.photos.iter().zip(&each).map(|(path, found)| {
            let words = found.as_ref().map_or_else(|| "no board that is known".to_owned(), in_words);
            format!("{}: {words}\n", path.display())
        });
        print(&lines.collect::<String>())?;
        let Some((board, photos, points)) = best else {
            return Err(Failure::input("no board that is known was found; markers by themselves and ring codes are none"));
        };
        progress.finish(&format!("{board} is found in {photos} of {} photographs, {points} points", self.photos.len()));
        print(&format!("--board {board}\n"))?;
        say!("its lengths are in {}: put your own in their place", unit(&board));
        let Some(other) = others.first() else { return Ok(()) };
        say!("in doubt: {} and {} more show another board", self.photos[*other].display(), others.len() - 1);
        Err(Failure::Doubt)
    }

    fn field(&self, context: &Context<'_>, name: &str) -> Result<(), Failure> {
        let scenario = context.scenario(name)?;
        let file = Some(PathBuf::from(name)).filter(|path| is_toml(path));
        let read = inputs_of(self.photos.iter().cloned().chain(file));
        let output = output::table("-o", self.output.as_deref(), &read)?;
        let draw = self.draw_into(&read)?;
        let subject = views(&scenario)?;
        let classifier = match self.classifier {
            Shapes::Modern => Classifier::Modern,
            Shapes::Contours => Classifier::Contours,
        };
        let recogniser = Recogniser::new(&subject.field, classifier)
            .map_err(|error| Failure::input(format!("--testfield {name}: {error}; its [testfield] must have kind = \"coded\"")))?;
        let progress = Progress::start("detect", self.photos.len() as u64, context.quiet);
        once(&self.photos)?;
        let reader = self.read.reader(&self.photos)?;
        let found = recognise_coded(&reader, &subject.field, &recogniser, &|| progress.step())?;
        let rows: Vec<&PointRow> = found.iter().flatten().flat_map(|coded| &coded.rows).collect();
        let seen = found.iter().flatten().count();
        progress.finish(&format!("the field was recognised in {seen} of {} photographs, {} targets", found.len(), rows.len()));
        self.photos.iter().zip(&found).filter_map(|(path, found)| Some((path, remark(found)?))).for_each(|(path, remark)| {
            say!("{}: {remark}", path.display());
        });
        if let Some(folder) = draw {
            // What is not flat has no neighbours that say where a target must be.
            let drawn: Vec<Drawn<'_>> = found.iter().map(of_field).collect();
            draw::draw(&folder, &reader, &drawn, &[])?;
        }
        if rows.is_empty() {
            return Err(Failure::input(format!(
                "no target was recognised; expected photographs of the field of `{}` that show at least one whole square with its lines",
                scenario.name
            )));
        }
        deliver(output.as_ref(), |file| write_points(file, rows.into_iter().map(PointRef::from)))
    }
}

/// What a photograph shows, in words.
fn in_words(found: &Identified) -> String {
    match found {
        Identified::Board { board, points, .. } => format!("{}; {points} points by --board {board}", found.words()),
        Identified::Markers { .. } => found.words(),
    }
}

/// What the lengths of a board are counted in of which none is known.
const fn unit(board: &Board) -> &'static str {
    match board {
        Board::Circles(_) | Board::Rings(_) => "distances of circles (whose diameter is taken for half of it)",
        Board::AprilGrid(_) | Board::GridBoard(_) => "sides of a marker",
        _ => "sides of a square",
    }
}

/// What the first photographs show in place of a board that is in none of them.
fn instead(reader: &Reader, asked: &Board) -> Result<String, Failure> {
    for path in reader.photos().iter().take(LOOKED_AT) {
        if let Some(found @ Identified::Board { board, .. }) = &identify(&reader.read(path)?) {
            let board = with_lengths(*board, asked);
            return Ok(format!(". {} shows {}: try --board {board}", path.display(), found.words()));
        }
    }
    Ok(String::new())
}

/// What was recognised of a field in a photograph, to be drawn.
fn of_field(found: &Result<Coded, NotRecognised>) -> Drawn<'_> {
    match found {
        Ok(coded) => Drawn { rows: coded.rows.iter().collect(), why: None },
        Err(why) => Drawn { rows: Vec::new(), why: Some(why.to_string()) },
    }
}

/// Says how each of several boards is measured, where several are seen and one was asked for.
fn say_several(all: bool, are_seen: bool) {
    if are_seen && !all {
        say!("several boards are seen in one photograph: --all takes each of them, as a view with a pose of its own");
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
