//! `calibench twin`: a scenario that looks like photographs, and what operators do to it.

use std::ffi::OsStr;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use calibench_calibrate::choice::{HALF, ModelChoice};
use calibench_cameras::inputs_of;
use calibench_files::NewFolder;
use calibench_images::photo::quantisation;
use calibench_images::{encode_png, head_of};
use calibench_judge::{Field, JudgementError, Material, field_of, usual_methods};
use calibench_measure::Configured;
use calibench_model::boards::{Board, Chessboard};
use calibench_model::camera::ImageSize;
use calibench_model::{BoardCorner, Image, TargetKind};
use calibench_photographs::names::names;
use calibench_photographs::{Asked, MeasuredBoards, Reader, measured_boards, method_info};
use calibench_records::results::Trial;
use calibench_report::json::TwinAnswer;
use calibench_report::twin::{page, pictures, verdict};
use calibench_twin::score::Rms;
use calibench_twin::{Design, Fitted, Geometry, Scene, ViewLook, fitted};
use clap::Args;
use rayon::prelude::*;

use super::context::{Context, finder};
use super::output;
use super::photos::{AsRead, of_one_camera, with_folders};
use super::progress::Progress;
use super::reading;
use crate::board::board_of;
use crate::deliver::{As, answer, print};
use crate::failure::Failure;

mod changed;
mod modelled;
mod rendered;
mod scores;
mod told;

use changed::{Change, USUAL, change};
use modelled::Modelled;
use rendered::{BOARD, CAMERA, IMAGES, SCENARIO, Studio, files};
use scores::{Truth, held_out, true_errors};
use told::{Scored, told};

/// The operator whose points make camera, poses and board.
const MAKER: &str = "parametric_corner:window=15";
/// How often what is left of the hold-out is looked for.
const REST: usize = 2;
/// Camera models that are tried in turn where none is asked for.
const MODELS: [&str; 3] = ["opencv5", "opencv4", "opencv4:fx,fy,cx,cy,k1"];
/// The number of the trial that is compared with the photographs.
const COMPARED: u64 = 100;

#[derive(Args)]
pub struct Twin {
    /// Photographs of a chessboard, or a folder of them, all by one camera: at least six
    #[arg(value_name = "PHOTO", required = true)]
    photos: Vec<PathBuf>,
    /// The board: 9x6:25 (a chessboard: inner corners, side of a square, object units)
    #[arg(long, visible_alias = "chessboard", value_name = "BOARD", value_parser = board_of)]
    board: Board,
    #[command(flatten)]
    read: AsRead,
    /// Leave out photographs of another size, px
    #[arg(long, value_name = "WxH", value_parser = reading::size)]
    only_size: Option<ImageSize>,
    /// Methods to compare, as in forstner:window=15 [default: all that make sense on chess corners]
    #[arg(short, long = "method", value_name = "METHOD")]
    methods: Vec<String>,
    /// The camera model of the twin [default: opencv5, or fewer coefficients where its camera folds within the frame]
    #[arg(long, value_name = "MODEL")]
    model: Option<String>,
    /// The twin with something changed: light=4 (times), blur=0.5 (times), raw (no JPEG, no processing), or a key of its scenario with a value, as in optics.blur=0.5; may be repeated [default: light=4, blur=0.5, raw]
    #[arg(long = "what-if", value_name = "CHANGE", value_parser = change)]
    changes: Vec<Change>,
    /// Folder for the scenario, its camera and board, its images and the page; of one that is there, only what calibench wrote is replaced
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    answered: As,
}

/// With fewer photographs of the board nothing can be left out.
const FEWEST_PHOTOGRAPHS: usize = 2 * HALF;

/// What operators measured in images of the board.
struct Measured {
    trial: Trial,
    material: Material,
    doubts: Vec<String>,
}

impl Twin {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let board = self.chessboard()?;
        let models = self.models()?;
        let photos = with_folders(&self.photos)?;
        let output = output::folder("-o", &self.output, &inputs_of(&photos), ("twin", None))?;
        let methods = context.methods_of_boards(&self.method_names(), TargetKind::ChessCorner)?;
        let reader = self.read.of_one_camera(&photos, self.only_size)?;
        let mut real = self.measured(context, Some("photographs"), &reader, &methods)?;
        let mut answered = None;
        output.replace(|folder| {
            let modelled = by_models(context, &models, (&real.material, &board), &reader)?;
            let geometry = modelled.geometry(&board);
            real.material.field = self.field(&modelled.corners)?;
            let scene = scene_of(&modelled, &board, &reader, &geometry)?;
            let studio = Studio::new(&modelled, &geometry, scene, context.registry()?)?;
            let changes = self.changes()?;
            // A change that cannot be is said before anything is rendered.
            let plain = Design::plain(modelled.stations.len());
            changes.iter().try_for_each(|change| studio.scenario(&change.text(&studio, &plain)?).map(drop))?;
            for (name, content) in files(&modelled)? {
                folder.write::<Failure>(name, |file| Ok(file.write_all(&content)?))?;
            }
            let look = studio.look_of(&looks(&reader, &modelled, &geometry)?).ok_or_else(no_edge)?;
            let found = fitted(&look, |design, trial| studio.look(design, trial))?.ok_or_else(no_edge)?;
            let real_held_out = held_out(&real.material, &modelled.model)?;
            let found = self.with_the_rest(context, &studio, (found, &modelled), &real_held_out, &methods)?;
            let scored = self.scored(context, folder, &studio, (&found, &modelled), (real_held_out, &changes), &methods)?;
            let doubts = real.doubts.iter().chain(&modelled.doubts).cloned().collect();
            let answer = told(&scored, (&look, &found), (&modelled.model.label, board.square), doubts);
            write_page(folder, &answer)?;
            answered = Some(answer);
            Ok::<(), Failure>(())
        })?;
        let Some(found) = answered else { return Ok(()) };
        if self.answered.json {
            answer(&found)?;
        } else {
            print(&verdict(&found))?;
        }
        if found.doubts.is_empty() { Ok(()) } else { Err(Failure::Doubt) }
    }

    /// The camera models that are tried in turn.
    fn models(&self) -> Result<Vec<ModelChoice>, Failure> {
        let texts: Vec<&str> = self.model.as_deref().map_or_else(|| MODELS.to_vec(), |model| vec![model]);
        let parsed =
            texts.into_iter().map(|text| ModelChoice::parse(text).map_err(|error| Failure::input(format!("--model {text}: {error}"))));
        parsed.collect()
    }

    /// What is judged by: corners that were measured.
    fn field(&self, corners: &[BoardCorner]) -> Result<Field, Failure> {
        let field = field_of(&self.board).map_err(|error| Failure::input(error.to_string()))?;
        field.measured(corners).map_err(|error| Failure::input(error.to_string()))
    }

    /// The twin with what is left of the hold-out of the operator that makes it, beyond that operator's own errors.
    fn with_the_rest(
        &self,
        context: &Context<'_>,
        studio: &Studio<'_>,
        (mut found, modelled): (Fitted, &Modelled),
        real_held_out: &[Rms],
        methods: &[Configured],
    ) -> Result<Fitted, Failure> {
        let place = methods.iter().position(|method| method.label == MAKER);
        let Some(wanted) = place.and_then(|place| real_held_out[place].px()) else { return Ok(found) };
        let maker = context.methods_of_boards(&[MAKER.to_owned()], TargetKind::ChessCorner)?;
        for _ in 0..REST {
            let passing = tempfile::tempdir()?;
            let save = |name: &str, image: &Image<'_>| saved(passing.path(), name, image, studio.is_deep());
            let quiet = Shown { what: "twin", save: &save, is_said: false };
            let (mut twin, truth) = self.pictured(context, &quiet, studio, &studio.text(&found.design), &maker)?;
            twin.material.field = self.field(&truth.corners)?;
            let Some(has) = held_out(&twin.material, &modelled.model)?[0].px() else { break };
            // Both axes have a part of it, and poses take up some.
            let variance = found.design.local.powi(2) + 0.5 * (wanted * wanted - has * has);
            found.design.local = variance.max(0.0).sqrt();
        }
        Ok(found)
    }

    /// What operators do to photographs, to the twin, and to the twin with something changed.
    fn scored<'m>(
        &self,
        context: &Context<'_>,
        folder: &NewFolder,
        studio: &Studio<'_>,
        (found, modelled): (&Fitted, &Modelled),
        (real_held_out, changes): (Vec<Rms>, &[Change]),
        methods: &'m [Configured],
    ) -> Result<Scored<'m>, Failure> {
        let model = &modelled.model;
        let text = studio.text(&found.design);
        folder.write::<Failure>(SCENARIO, |file| Ok(file.write_all(text.as_bytes())?))?;
        let images = folder.folder(IMAGES)?;
        let save = |name: &str, image: &Image<'_>| {
            images.write::<Failure>(name, |out| Ok(encode_png(out, image, studio.is_deep())?))?;
            Ok(images.path().join(name))
        };
        let (mut twin, truth) = self.pictured(context, &Shown { what: "twin", save: &save, is_said: true }, studio, &text, methods)?;
        twin.material.field = self.field(&truth.corners)?;
        let mut scored = Scored {
            methods,
            held_out: real_held_out,
            twin_held_out: held_out(&twin.material, model)?,
            errors: true_errors(&twin.trial, methods.len(), &truth),
            cases: Vec::new(),
        };
        for change in changes {
            let passing = tempfile::tempdir()?;
            let text = change.text(studio, &found.design)?;
            let save = |name: &str, image: &Image<'_>| saved(passing.path(), name, image, studio.is_deep());
            let shown = Shown { what: &change.words(), save: &save, is_said: true };
            let (case, truth) = self.pictured(context, &shown, studio, &text, methods)?;
            scored.cases.push((change.asked.clone(), change.words(), true_errors(&case.trial, methods.len(), &truth)));
        }
        Ok(scored)
    }

    /// What is asked for, or what usually is.
    fn changes(&self) -> Result<Vec<Change>, Failure> {
        if self.changes.is_empty() {
            USUAL.iter().map(|text| change(text).map_err(Failure::input)).collect()
        } else {
            Ok(self.changes.clone())
        }
    }

    fn chessboard(&self) -> Result<Chessboard, Failure> {
        match self.board {
            Board::Chessboard(board) => Ok(board),
            _ => Err(Failure::input(
                "--board: a twin is made of photographs of a chessboard, as in 9x6:25; of other boards `judge` says which operator to trust",
            )),
        }
    }

    /// The methods that are compared; the one that makes the twin is among them.
    fn method_names(&self) -> Vec<String> {
        let mut names = if self.methods.is_empty() { usual_methods(TargetKind::ChessCorner, false) } else { self.methods.clone() };
        if !names.iter().any(|name| name == MAKER) {
            names.push(MAKER.to_owned());
        }
        names
    }

    fn measured(&self, context: &Context<'_>, what: Option<&str>, reader: &Reader, methods: &[Configured]) -> Result<Measured, Failure> {
        let finder = finder(self.board)?;
        let progress = Progress::start(what.unwrap_or("twin"), reader.photos().len() as u64, context.quiet || what.is_none());
        let MeasuredBoards { trial, size, doubts } =
            measured_boards(reader, &finder, methods, &|| progress.step()).map_err(of_one_camera)?;
        let seen = reader.photos().len() - trial.missed_views.len();
        if what.is_some() {
            progress.finish(&format!("the board was found in {seen} of {}", reader.photos().len()));
        }
        if seen < FEWEST_PHOTOGRAPHS {
            return Err(JudgementError::TooFewViews { found: seen, needed: FEWEST_PHOTOGRAPHS }.into());
        }
        let infos: Vec<_> = methods.iter().map(method_info).collect();
        let field = field_of(&self.board).map_err(|error| Failure::input(error.to_string()))?;
        Ok(Measured { material: Material::new(&trial, &infos, field, size), trial, doubts })
    }

    /// What operators measure in images of a scenario, which `save` writes, and the truth.
    fn pictured(
        &self,
        context: &Context<'_>,
        shown: &Shown<'_>,
        studio: &Studio<'_>,
        text: &str,
        methods: &[Configured],
    ) -> Result<(Measured, Truth), Failure> {
        let scenario = studio.scenario(text)?;
        let images = studio.each(&scenario, COMPARED, |shot| {
            let stem = Path::new(&shot.name).file_stem().map_or_else(|| shot.name.as_str().into(), OsStr::to_string_lossy);
            let name = format!("{stem}.png");
            Ok::<_, Failure>(((shown.save)(&name, &shot.image)?, name, shot.targets.clone()))
        })?;
        let (mut photos, mut truth) = (Vec::new(), Truth::default());
        for one in images {
            let (path, name, targets) = one?;
            photos.push(path);
            truth.add(&name, &targets);
        }
        let reader = Reader::of(&photos, Asked { one_camera: true, ..Asked::default() })?;
        Ok((self.measured(context, shown.is_said.then_some(shown.what), &reader, methods)?, truth))
    }
}

/// Where images of a twin go, and whether anything is said of them.
struct Shown<'a> {
    what: &'a str,
    save: &'a Save<'a>,
    is_said: bool,
}

/// Writes an image that passes.
fn saved(folder: &Path, name: &str, image: &Image<'_>, deep: bool) -> Result<PathBuf, Failure> {
    let path = folder.join(name);
    encode_png(&mut BufWriter::new(File::create(&path)?), image, deep)?;
    Ok(path)
}

/// What writes an image under a name, and says where.
type Save<'a> = dyn Fn(&str, &Image<'_>) -> Result<PathBuf, Failure> + Sync + 'a;

/// The page with its pictures.
fn write_page(folder: &NewFolder, answer: &TwinAnswer) -> Result<(), Failure> {
    for (name, _, picture) in pictures(answer) {
        folder.write::<std::io::Error>(name, |file| picture.encode(file))?;
    }
    let text = page(answer, SCENARIO);
    Ok(folder.write::<std::io::Error>("README.md", |file| file.write_all(text.as_bytes()))?)
}

/// Camera, board and poses by the first model whose camera pictures all of its frame.
fn by_models(
    context: &Context<'_>,
    models: &[ModelChoice],
    (material, board): (&Material, &Chessboard),
    reader: &Reader,
) -> Result<Modelled, Failure> {
    let mut refused = None;
    for model in models {
        let modelled = Modelled::of(material, model)?;
        let geometry = modelled.geometry(board);
        let scene = scene_of(&modelled, board, reader, &geometry)?;
        match Studio::new(&modelled, &geometry, scene, context.registry()?)?.pictures_all() {
            Ok(()) => return Ok(modelled),
            Err(why) => {
                say!("{}: {why}", model.label);
                refused = Some(Failure::input(format!("no twin by the model {}: {why}; expected another --model", model.label)));
            }
        }
    }
    Err(refused.unwrap_or_else(no_edge))
}

/// What a twin pictures.
fn scene_of(modelled: &Modelled, board: &Chessboard, reader: &Reader, geometry: &Geometry) -> Result<Scene, Failure> {
    let sides = modelled.stations.iter().map(|(_, pose)| geometry.side(pose)).filter(|side| side.is_finite());
    let tables = quantisation(&reader.photos()[0]).map_err(|error| Failure::input(format!("{}: {error}", reader.photos()[0].display())))?;
    Ok(Scene {
        why: "The twin of photographs: what each operator does to them.".into(),
        source: format!("{} photographs", modelled.stations.len()),
        camera: CAMERA.into(),
        board: BOARD.into(),
        rows: board.rows,
        columns: board.columns,
        square: board.square,
        stations: modelled.stations.clone(),
        tables,
        bits: if head_of(&reader.photos()[0])?.is_deep { 16 } else { 8 },
        side: calibench_model::median(sides).ok_or_else(no_edge)?,
        seed: 1,
    })
}

fn no_edge() -> Failure {
    Failure::input("no edge of the board can be looked at: its squares are smaller than 8 px, or its photographs too few")
}

/// What the photographs of the model's stations look like.
fn looks(reader: &Reader, modelled: &Modelled, geometry: &Geometry) -> Result<Vec<ViewLook>, Failure> {
    let names = names(reader.photos());
    let one = |(station, pose): &(String, calibench_model::Pose)| {
        let place = names.iter().position(|name| name == station);
        let path =
            place.map(|place| &reader.photos()[place]).ok_or_else(|| Failure::input(format!("no photograph is called {station}")))?;
        Ok(ViewLook::of(&reader.read(path)?, geometry, pose))
    };
    modelled.stations.par_iter().map(one).collect()
}
