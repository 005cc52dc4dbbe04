//! The command line. Exit codes: 0, 1 when a gate failed, 2 for bad input.

// These macros panic where nothing more can be written: `say!` and `deliver` do not.
#![warn(clippy::print_stderr, clippy::print_stdout)]

#[macro_use]
mod say;

mod accept;
mod bless;
mod board;
mod calibrate;
mod camera;
mod camera_files;
mod certificate;
mod check;
mod confined;
mod context;
mod control;
mod convert;
mod deliver;
mod demo;
mod detect;
mod diff;
mod examples;
mod failure;
mod frames;
mod gated;
mod groups;
mod init;
mod inputs;
mod intersect;
mod judge;
mod lanes;
mod league;
mod list;
mod manual;
mod measure;
mod notes;
mod offers;
mod orient;
mod output;
mod pages;
mod part;
mod peers;
mod photos;
mod plot;
mod plugin;
mod point;
mod power;
mod print;
mod progress;
mod reading;
mod records;
mod render;
mod report;
mod resect;
mod run;
mod same_camera;
mod schema;
mod show;
mod speed;
mod stmap;
mod stored;
mod task;
mod twin;
mod undistort;

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

pub use calibench_project::Toolbox;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use confined::CONFINED;
use failure::Failure;

/// Compares camera calibration methods on images whose truth is known exactly, and on photographs.
#[derive(Parser)]
#[command(name = "calibench", version, max_term_width = 110)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// The project's folder, which holds scenarios/ and reference/ [default: found from the current folder upwards]
    #[arg(long, global = true, value_name = "DIR", env = "CALIBENCH_ROOT")]
    root: Option<PathBuf>,
    /// Number of threads [default: all cores]
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// The folder of plug-ins: TOML files, each with programs that are methods [default: methods/ of the project]
    #[arg(long, global = true, value_name = "DIR")]
    plugins: Option<PathBuf>,
    /// No progress, only results and errors
    #[arg(long, short, global = true)]
    quiet: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Show it all once, in a minute: a board, photographs whose truth is known, a page
    Demo(demo::Demo),
    /// List what there is: scenarios, methods, formats, figures, what other tools mean
    List {
        /// What to list
        what: list::What,
        #[command(flatten)]
        answered: deliver::As,
    },
    /// Show a scenario as it is resolved, and write a preview of its image
    Show(show::Show),
    /// Run scenarios and write their records
    Run(run::Run),
    /// Put the parts of runs together, as one run would have written them
    Merge(part::Merge),
    /// Print the records of a run, as they lie compressed in its folder
    Records(records::Records),
    /// Write a scenario's images, with the truth about targets, camera and poses
    Render(render::Render),
    /// Write a board or a scenario's testfield for the printer, at true scale, as PDF and SVG
    Print(print::Print),
    /// Write reports from records alone; runs nothing
    Report(report::Report),
    /// Draw the records of a sweep as curves or maps; runs nothing
    Plot(plot::Plot),
    /// Compare today's accuracy with the blessed one; exit code 1 if it regressed
    Check(check::Check),
    /// Start a project of your own with a gate: a scenario, its baseline, the schema
    Init(init::Init),
    /// Accept today's accuracy as the baseline: lists what gets worse, and asks
    Bless(bless::Bless),
    /// Measure what changes the gate sees, and how often it is wrong
    GatePower(power::Power),
    /// Measure how many points a second methods measure, on one thread
    Speed(speed::SpeedCommand),
    /// Measure a board's points, or points near given positions, in photographs
    Measure(measure::Measure),
    /// Find a board or a coded field in photographs: names and approximate positions
    Detect(detect::Detect),
    /// Make a page to point at targets in photographs by hand
    Point(Box<point::Point>),
    /// Write the control file of a board: the coordinates of its points
    Control(control::Control),
    /// Calibrate a camera from photographs of a board, or from measured points
    Calibrate(Box<calibrate::Calibrate>),
    /// Say which operator and which camera model to trust on your photographs, and how far
    Judge(Box<judge::Judge>),
    /// Make a scenario like your photographs, and say what operators do to it
    Twin(Box<twin::Twin>),
    /// Find where images were taken, from control points; the camera is known
    Resect(resect::Resect),
    /// Intersect object points from images whose camera and poses are known
    Intersect(intersect::Intersect),
    /// Orient two images relatively to each other; the cameras are known
    Orient(orient::Orient),
    /// Say whether measuring keeps what is specified, by lengths or check points
    Accept(Box<accept::Accept>),
    /// Write the certificate of a calibration as PDF, or verify one against its files
    Certificate(Box<certificate::Certificate>),
    /// Say how well something will be measured, at 95 %, and what makes that up
    Task(Box<task::Task>),
    /// Compare whole calibration systems on rendered photographs, class by class
    League(league::League),
    /// Convert a camera file to the format of another tool
    Convert(convert::Convert),
    /// Show what is in a camera file: parameters, field of view, distortion
    Camera(camera::CameraCommand),
    /// Say how far two cameras differ, in px over the frame, after the best rotation
    Diff(diff::Diff),
    /// Write a camera's distortion as an ST-map for compositing programs, or check one
    Stmap(stmap::StMapCommand),
    /// Take the distortion out of photographs or points, or give them another camera's
    Undistort(Box<undistort::Undistort>),
    /// Try a program of your own that is a method: does it do what every plug-in must
    #[command(subcommand)]
    Plugin(plugin::PluginCommand),
    /// Restrict this process, then become another program: how plug-ins are started
    #[command(name = CONFINED, hide = true)]
    Confined(confined::Confined),
    /// Print the JSON Schema of scenario files, published tables or a command's --json
    Schema {
        /// Of what
        #[arg(default_value = "scenarios")]
        of: schema::Schema,
    },
    /// Print the completions of the command line for a shell
    Completions(manual::Completions),
    /// Write the manual pages of all commands
    Man(manual::Man),
}

/// The command line with all that its help says.
fn command_line() -> clap::Command {
    let line = groups::with_groups(examples::with_examples(Arguments::command()));
    line.mut_subcommands(|command| match command.get_name() {
        "convert" => command.mut_arg("size", |size| size.help(convert::SIZE)),
        _ => command,
    })
}

/// Runs the command line of this process.
pub fn main(toolbox: &Toolbox) -> ExitCode {
    ExitCode::from(exit_code(toolbox, std::env::args_os()))
}

/// Runs the command line `words`, of which the first is the program's name, and returns the exit code. Once a process: it sets the number of threads. Ends the process
/// where the words are no command line, or ask for help.
pub fn exit_code(toolbox: &Toolbox, words: impl IntoIterator<Item: Into<OsString> + Clone>) -> u8 {
    let matches = command_line().get_matches_from(words);
    let arguments = Arguments::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    // Before any thread: what restricts itself has one.
    if let Command::Confined(confined) = &arguments.command {
        return confined.execute();
    }
    let threads = usize::from(arguments.threads.unwrap_or(0));
    if let (Some(threads), Some(bind)) = (arguments.threads, toolbox.bind_threads) {
        bind(usize::from(threads));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    match pool.map_err(Failure::from).and_then(|()| dispatch(arguments, toolbox)) {
        Ok(()) => 0,
        Err(Failure::Gate) => 1,
        Err(Failure::Doubt) => 3,
        Err(Failure::Picture(picture)) => {
            say::plain(format_args!("error: {picture}\n"));
            2
        }
        Err(Failure::Input(message)) => {
            say!("error: {message}");
            2
        }
    }
}

fn dispatch(arguments: Arguments, toolbox: &Toolbox) -> Result<(), Failure> {
    // Names of files mean nothing in a folder that is gone.
    calibench_project::here()?;
    let context = context::Context::new(toolbox, arguments.quiet, arguments.root, arguments.plugins);
    match arguments.command {
        Command::Demo(demo) => demo.run(&context),
        Command::List { what, answered } => list::list(&context, what, answered),
        Command::Show(show) => show.run(&context),
        Command::Run(run) => run.run(&context),
        Command::Merge(merge) => merge.run(&context),
        Command::Records(records) => records.run(&context),
        Command::Print(print) => print.run(&context),
        Command::Render(render) => render.run(&context),
        Command::Report(report) => report.run(&context),
        Command::Plot(plot) => plot.run(&context),
        Command::Check(check) => check.run(&context),
        Command::Init(init) => init.run(&context),
        Command::Bless(bless) => bless.run(&context),
        Command::GatePower(power) => power.run(&context),
        Command::Speed(speed) => speed.run(&context),
        Command::League(league) => league.run(&context),
        Command::Measure(measure) => measure.run(&context),
        Command::Detect(detect) => detect.run(&context),
        Command::Point(point) => point.run(&context),
        Command::Control(control) => control.run(),
        Command::Calibrate(calibrate) => calibrate.run(&context),
        Command::Judge(judge) => judge.run(&context),
        Command::Resect(resect) => resect.run(&context),
        Command::Intersect(intersect) => intersect.run(&context),
        Command::Orient(orient) => orient.run(&context),
        Command::Accept(accept) => accept.run(),
        Command::Certificate(certificate) => certificate.run(),
        Command::Task(task) => task.run(),
        Command::Twin(twin) => twin.run(&context),
        Command::Convert(convert) => convert.run(&context),
        Command::Camera(camera) => camera.run(),
        Command::Diff(diff) => diff.run(),
        Command::Stmap(map) => map.run(),
        Command::Undistort(undistort) => undistort.run(&context),
        Command::Plugin(plugin) => plugin.run(&context),
        Command::Confined(confined) => Err(confined.failure()),
        Command::Completions(completions) => completions.run(&offers::with_offers(command_line(), &context.toolbox.registry)),
        Command::Man(man) => man.run(command_line()),
        Command::Schema { of } => deliver::print(&of.text(context.registry()?)),
    }
}

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests {
    use super::command_line;
    use super::examples::EXAMPLES;

    #[test]
    fn every_command_shows_examples_that_it_takes() {
        let line = command_line();
        let named: Vec<&str> = line.get_subcommands().filter(|one| !one.is_hide_set()).map(clap::Command::get_name).collect();
        assert_eq!(EXAMPLES.iter().map(|(name, _)| *name).collect::<Vec<_>>(), named);
        for (name, examples) in EXAMPLES {
            assert!(!examples.is_empty(), "{name}");
            for (example, what) in *examples {
                let words: Vec<&str> = example.split_whitespace().collect();
                assert_eq!(words[..2], ["calibench", *name], "{example}");
                assert!(!what.is_empty() && example.len() <= 96, "{example} is to be copied in one line");
                let taken = command_line().try_get_matches_from(words);
                assert!(taken.is_ok(), "{example}: {}", taken.unwrap_err());
            }
            let help = command_line().find_subcommand_mut(name).unwrap().render_long_help().to_string();
            assert!(help.contains("Examples:\n  calibench ") && help.contains(examples[0].0), "{help}");
        }
    }

    #[test]
    fn the_command_line_is_whole() {
        command_line().debug_assert();
    }
}
