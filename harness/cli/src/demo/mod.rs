//! `calibench demo`: everything once, from nothing: a board, photographs whose truth is known, the verdict, the calibration, and a page that tells it. Each step is a
//! command as a user types it, run by this program in the folder of the demonstration.

use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Instant;

use calibench_files::Inputs;
use calibench_files::atomic::write_atomically;
use calibench_images::{PhotoFolder, encode_png, read_photo};
use calibench_model::Image;
use clap::Args;

use super::context::Context;
use super::output;
use crate::deliver::print;
use crate::failure::Failure;

mod told;

/// What is rendered, and the camera that renders it: the truth.
const SCENARIO: (&str, &str) = ("board.toml", include_str!("board.toml"));
pub const TRUTH: (&str, &str) = ("camera-truth.yaml", include_str!("camera.yaml"));
/// The calibrated camera, the points that were found, and the page.
pub const CAMERA: &str = "camera.yaml";
pub const CORNERS: &str = "corners.csv";
pub const PAGE: &str = "report.html";
/// Where the photographs are.
pub const PHOTOGRAPHS: &str = "photographs";

/// The photograph that is blurred, and by how many px along its rows; the one that is there twice. Counted from 1.
pub const BLURRED: usize = 5;
const BLUR: usize = 13;
pub const TWICE: usize = 3;

#[derive(Args)]
pub struct Demo {
    /// The folder: made if it is not there, and what an earlier demonstration wrote into it is replaced
    #[arg(value_name = "DIR", default_value = "calibench-demo")]
    folder: PathBuf,
}

/// A step of the demonstration.
pub struct Step {
    /// What it is about.
    pub title: &'static str,
    /// What is done, and what is to be seen.
    pub about: &'static str,
    /// The command, without the program's name.
    pub command: &'static str,
}

/// A step that was done.
pub struct Done {
    pub step: &'static Step,
    /// What the command said and answered.
    pub said: String,
    pub code: i32,
}

const STEPS: [Step; 6] = [
    Step {
        title: "A board",
        about: "A chessboard for the printer. `9x6:25` is its name in every command: 9 x 6 inner corners, squares with sides of 25 mm.",
        command: "print --board 9x6:25 --paper A4 -o board",
    },
    Step {
        title: "Photographs",
        about: "Here a camera that is known exactly takes twelve photographs of this board, which is bent by 1.5 mm as paper is. Then one of them is blurred as by a \
                moving hand, and one is put beside the others once more, under another name.",
        command: "render board.toml -o truth",
    },
    Step {
        title: "What is found in them",
        about: "`--draw` writes each photograph with what was found: the first corners by name, so that one sees which way they are counted.",
        command: "detect photographs --board 9x6:25 --draw drawn -o corners.csv",
    },
    Step {
        title: "Which operator and which model to trust",
        about: "`judge` compares ways to measure the corners and camera models by what they predict of photographs that took no part. It needs no truth. Without `-m` it \
                compares all operators.",
        command: "judge photographs --board 9x6:25 -m forstner -m parametric_corner --report judged",
    },
    Step {
        title: "The camera",
        about: "`calibrate` finds the camera and how well it is known. It tests whether the board is flat, names the photograph that is there twice, and ends with exit \
                code 3 where something is in doubt.",
        command: "calibrate photographs --board 9x6:25 -o camera.yaml --report calibrated",
    },
    Step {
        title: "The truth beside it",
        about: "With your own photographs nobody has the truth. Here it is known: how far is the calibrated camera from the one that took the photographs, and is that what \
                it said of itself?",
        command: "diff camera.yaml camera-truth.yaml",
    },
];

impl Demo {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let started = Instant::now();
        self.is_ours()?;
        std::fs::create_dir_all(&self.folder).map_err(|error| calibench_files::at(&self.folder, &error))?;
        for (name, text) in [SCENARIO, TRUTH] {
            write_atomically::<std::io::Error>(&self.folder.join(name), |file| file.write_all(text.as_bytes()))?;
        }
        let mut done = Vec::new();
        for (place, step) in STEPS.iter().enumerate() {
            say!("{} of {}: {}", place + 1, STEPS.len(), step.title);
            if !context.quiet {
                print(&format!("$ calibench {}\n", step.command))?;
            }
            let one = self.done(step)?;
            if !context.quiet {
                print(&told::shortened(&one.said))?;
            }
            if step.command.starts_with("render") {
                self.photographs()?;
            }
            done.push(one);
        }
        let page = told::page(&self.folder, &done)?;
        write_atomically::<std::io::Error>(&self.folder.join(PAGE), |file| file.write_all(page.as_bytes()))?;
        say!("done in {:.0} s; the page tells what was done and what came out:", started.elapsed().as_secs_f64());
        print(&format!("{}\n", self.folder.join(PAGE).display()))
    }

    /// Nothing but a demonstration is replaced.
    fn is_ours(&self) -> Result<(), Failure> {
        let is_empty = || self.folder.read_dir().is_ok_and(|mut entries| entries.next().is_none());
        let has_ours = std::fs::read_to_string(self.folder.join(SCENARIO.0)).is_ok_and(|text| text == SCENARIO.1);
        if !self.folder.exists() || has_ours || is_empty() {
            return Ok(());
        }
        let folder = self.folder.display();
        Err(Failure::input(format!(
            "{folder}: is there already and is no folder of a demonstration; name another one, as in `calibench demo elsewhere`"
        )))
    }

    /// Runs the command of a step as a user would. A doubt is no failure: it is to be seen.
    fn done(&self, step: &'static Step) -> Result<Done, Failure> {
        let program = std::env::current_exe().map_err(|error| Failure::input(format!("this program does not find itself: {error}")))?;
        let mut command = Command::new(program);
        command.args(step.command.split(' ')).current_dir(&self.folder).stdin(Stdio::null());
        let output = command.output()?;
        let [said, answered] = [&output.stderr, &output.stdout].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
        match output.status.code() {
            Some(code @ (0 | 3)) => Ok(Done { step, said: said + &answered, code }),
            _ => Err(Failure::input(format!("`calibench {}` failed in {}:\n{said}", step.command, self.folder.display()))),
        }
    }

    /// The photographs from what was rendered: one of them blurred, one there twice.
    fn photographs(&self) -> Result<(), Failure> {
        let rendered = PhotoFolder::of(&self.folder.join("truth"))?.photos;
        let folder = output::folder("demo", &self.folder.join(PHOTOGRAPHS), &Inputs::default(), ("demo", None))?;
        folder.replace(|folder| {
            let numbered = rendered.iter().enumerate().map(|(place, path)| (place + 1, path));
            let again = rendered.get(TWICE - 1).map(|path| (rendered.len() + 1, path));
            for (number, path) in numbered.chain(again) {
                let name = photograph(number);
                if number == BLURRED {
                    let image = blurred(&read_photo(path)?.image);
                    folder.write(&name, |file| encode_png(file, &image, false))?;
                } else {
                    let bytes = std::fs::read(path)?;
                    folder.write::<std::io::Error>(&name, |file| file.write_all(&bytes))?;
                }
            }
            Ok::<_, Failure>(())
        })
    }
}

/// What a photograph is called.
pub fn photograph(number: usize) -> String {
    format!("IMG_{number:02}.png")
}

/// As a camera that moves along its rows takes it.
fn blurred(image: &Image) -> Image<'static> {
    let half = BLUR / 2;
    Image::from_fn(image.width(), image.height(), |x, y| {
        let around = x.saturating_sub(half)..(x + half + 1).min(image.width());
        let count = around.len() as f32;
        around.map(|x| image.at(x, y)).sum::<f32>() / count
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn a_moving_camera_smears_along_the_rows_and_keeps_the_light() {
        let dot = Image::from_fn(41, 5, |x, y| f32::from(u8::from(x == 20 && y == 2)));
        let smeared = blurred(&dot);
        let sum: f32 = smeared.grey().iter().sum();
        assert!((sum - 1.0).abs() < 1e-5 && smeared.at(20, 1) == 0.0, "{sum}");
        assert!((smeared.at(14, 2) - 1.0 / 13.0).abs() < 1e-6 && smeared.at(13, 2) == 0.0);
    }

    #[test]
    fn only_what_a_demonstration_wrote_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let ours = |path: &Path| Demo { folder: path.to_owned() }.is_ours().is_ok();
        assert!(ours(folder.path()) && ours(&folder.path().join("new")));
        std::fs::write(folder.path().join("report.html"), "a letter").unwrap();
        assert!(!ours(folder.path()));
        std::fs::write(folder.path().join(SCENARIO.0), SCENARIO.1).unwrap();
        assert!(ours(folder.path()));
        std::fs::write(folder.path().join(SCENARIO.0), "mine").unwrap();
        assert!(!ours(folder.path()));
    }
}
