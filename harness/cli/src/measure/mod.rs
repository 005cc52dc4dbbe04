//! `calibench measure`: points in a user's own photographs.

use std::path::PathBuf;

use calibench_calibrate::Offset;
use calibench_cameras::inputs_of;
use calibench_exchange::{MeasuredRow, Outcome, write_measured};
use calibench_measure::Configured;
use calibench_measure::coverage::{all_busy, unmeasured};
use calibench_model::boards::Board;
use calibench_model::{Points, TargetKind};
use calibench_photographs::points::{Measured, measure_points, photos_of};
use calibench_photographs::{Finder, Reader};
use calibench_report::json::{MeasurementAnswer, MeasurementCounts};
use clap::Args;

use crate::board::{HELP, board_to_find};
use crate::context::{Context, Pictured, finder};
use crate::deliver::{As, answer, deliver};
use crate::failure::Failure;
use crate::inputs::read_measured;
use crate::notes::say_notes;
use crate::output;
use crate::photos::{AsRead, with_folders};
use crate::progress::Progress;

mod eccentricity;

use eccentricity::Eccentricity;

#[derive(Args)]
pub struct Measure {
    /// Photographs, or a folder of them: PNG, JPEG, TIFF, PNM, BMP or WebP
    #[arg(required = true, value_name = "PHOTO")]
    photos: Vec<PathBuf>,
    /// Approximate positions: CSV with image,target,x,y, and optionally sxx,sxy,syy and kind,axx,axy,ayx,ayy
    #[arg(long, value_name = "CSV", required_unless_present = "board", conflicts_with = "board")]
    points: Option<PathBuf>,
    #[arg(long, visible_alias = "chessboard", value_name = "BOARD", value_parser = board_to_find, help = HELP)]
    board: Option<Board>,
    /// The method, as in forstner:window=15; several are measured one after the other. Kinds of targets before it limit it to these, as in disc+square=centroid [default: forstner; of a board as for `calibrate`]
    #[arg(short, long = "method", value_name = "METHOD")]
    methods: Vec<String>,
    #[command(flatten)]
    read: AsRead,
    #[command(flatten)]
    eccentricity: Eccentricity,
    /// Where the result goes [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
    #[command(flatten)]
    answered: As,
}

impl Measure {
    pub fn run(mut self, context: &Context<'_>) -> Result<(), Failure> {
        self.photos = with_folders(&self.photos)?;
        let inputs = inputs_of(self.photos.iter().chain(&self.points).chain(self.eccentricity.paths()));
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
        let finder = self.board.map(finder).transpose()?;
        let usual = || vec![finder.as_ref().map_or("forstner", Finder::usual_method).to_owned()];
        let asked = if self.methods.is_empty() { usual() } else { self.methods.clone() };
        let methods = context.methods(&asked, Pictured::Photographs)?;
        if let Some((method, why)) = methods.iter().find_map(|m| Some((m, m.operator.as_ref().err()?))) {
            return Err(Failure::input(format!("-m {}: unavailable: {why}", method.label)));
        }
        let (points, reader, is_doubtful) = match (&self.points, &finder) {
            (Some(points), _) => (read_measured(points)?, None, false),
            (None, Some(finder)) => {
                let reader = self.read.reader(&self.photos)?;
                let (points, is_doubtful) = points_of(finder, &reader)?;
                (points, Some(reader), is_doubtful)
            }
            (None, None) => return Err(Failure::input("expected --points or --board")),
        };
        methods.iter().try_for_each(|method| has_kinds(method, &points))?;
        let kinds = || points.rows().filter_map(|row| row.start.kind);
        all_busy(&methods, kinds()).map_err(|gap| Failure::input(format!("-m: {gap}")))?;
        let nobodys = unmeasured(&methods, kinds());
        // What is wrong with the photographs' names is said before any is read.
        let photos = photos_of(&points, &self.photos)?;
        let reader = reader.map_or_else(|| self.read.reader(&self.photos), Ok)?;
        let size = |image: &str| reader.sizes().get(photos[points.images().find(image)?]?).copied();
        let offsets = self.eccentricity.offsets(&points, size)?;
        let progress = Progress::start("measure", self.photos.len() as u64, context.quiet);
        let found = measure_points(&points, &reader, &methods, &|| progress.step())?;
        let rows = || rows(&points, &methods, &found, &offsets).chain(rows_of_nobody(&points, &nobodys));
        if output.is_some() || !self.answered.json {
            deliver(output.as_ref(), |file| write_measured(file, rows()))?;
        }
        if self.answered.json {
            answer(&MeasurementAnswer::new(counts(rows()), rows()))?;
        }
        progress.finish(&summary(&found, &points));
        say_notes(&methods);
        let unknown = offsets.iter().filter(|offset| matches!(offset, Offset::Unknown(_))).count();
        if unknown > 0 {
            say!(
                "{unknown} of {} points are of discs whose eccentricity is not known: they have no position; their rows say why",
                points.len()
            );
        }
        nobodys.iter().for_each(|kind| {
            let count = points.rows().filter(|row| row.start.kind == Some(*kind)).count();
            say!(
                "{count} of {} points are of the kind `{kind}`, which no method measures; give one for it, as in -m {kind}=METHOD",
                points.len()
            );
        });
        if is_doubtful { Err(Failure::Doubt) } else { Ok(()) }
    }
}

/// The points of a board where it is found, and whether that is in doubt; says in which photographs it is not, and why.
fn points_of(finder: &Finder, reader: &Reader) -> Result<(Points, bool), Failure> {
    let found = finder.find_all(reader, &|| ())?;
    for (path, sighting) in reader.photos().iter().zip(&found) {
        sighting.why.iter().for_each(|why| say!("{}: {why}", path.display()));
        sighting.doubts.iter().for_each(|doubt| say!("{}: in doubt: {doubt}", path.display()));
    }
    let points: Points = found.iter().flat_map(|sighting| &sighting.rows).collect();
    if points.is_empty() {
        return Err(Failure::input("no board was found; `calibench detect PHOTO --board unknown` says what board is there"));
    }
    Ok((points, found.iter().any(|sighting| !sighting.doubts.is_empty())))
}

/// One row for every method and point of its kinds, in the order given, less the eccentricity of each point where there is one.
fn rows<'p>(
    points: &'p Points,
    methods: &'p [Configured],
    found: &'p Measured,
    offsets: &'p [Offset],
) -> impl Iterator<Item = MeasuredRow<'p>> {
    let all = move |m| (0..points.len()).map(move |i| (m, i, points.row(i)));
    let own = (0..methods.len()).flat_map(all).filter(|(m, _, given)| methods[*m].measures(given.start.kind));
    own.map(|(m, i, given)| {
        let outcome = found.outcome(m, i).unwrap_or_else(|| not_given(given.image));
        let outcome = eccentricity::less(outcome, offsets.get(i).copied().unwrap_or(Offset::NoDisc));
        MeasuredRow { given, method: &methods[m].label, outcome }
    })
}

/// One row for every point of `kinds`, which no method measures.
fn rows_of_nobody<'p>(points: &'p Points, kinds: &'p [TargetKind]) -> impl Iterator<Item = MeasuredRow<'p>> {
    points.rows().filter_map(|given| {
        let kind = given.start.kind.filter(|kind| kinds.contains(kind))?;
        Some(MeasuredRow { given, method: "", outcome: Outcome::Unavailable(format!("no method measures the kind {kind}")) })
    })
}

fn counts<'p>(rows: impl Iterator<Item = MeasuredRow<'p>>) -> MeasurementCounts {
    let mut counts = MeasurementCounts::default();
    for row in rows {
        *match row.outcome {
            Outcome::Measured(_) => &mut counts.measured,
            Outcome::Rejected(_) => &mut counts.rejected,
            Outcome::Unavailable(_) => &mut counts.unavailable,
        } += 1;
    }
    counts
}

/// Whether the points say what a method must know.
fn has_kinds(method: &Configured, points: &Points) -> Result<(), Failure> {
    let needed = method.kinds.is_some() || method.operator.as_ref().is_ok_and(|operator| operator.needs_kind());
    let Some(bare) = points.rows().find(|row| needed && row.start.kind.is_none()) else { return Ok(()) };
    let or = if method.kinds.is_some() { "leave out the kinds" } else { "the method its `shape`" };
    Err(Failure::input(format!(
        "-m {}: point {} of {} does not say what is pictured, which this method must know; give the column `kind` ({}), or {or}",
        method.label,
        bare.target,
        bare.image,
        TargetKind::ALL.map(TargetKind::name).join(", ")
    )))
}

fn not_given(image: &str) -> Outcome {
    Outcome::Unavailable(format!("photograph {image} was not given"))
}

fn summary(found: &Measured, points: &Points) -> String {
    let mut text = format!("{} measured, {} rejected", found.measured(), found.rejected());
    if found.not_given() > 0 {
        text.push_str(&format!(", {} of {} points are of photographs that were not given", found.not_given(), points.len()));
    }
    text
}
