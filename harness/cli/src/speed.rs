//! `calibench speed`: points per second of methods, for reports to read.

use std::hint::black_box;
use std::path::PathBuf;
use std::time::Instant;

use calibench_cameras::inputs_of;
use calibench_measure::coverage::all_busy;
use calibench_measure::{Configured, Operator, Sought};
use calibench_model::{Image, Start};
use calibench_report::speeds::{SPEEDS, Speed, Speeds};
use calibench_run::prepared::first_image;
use calibench_scenario::catalogue::is_toml;
use calibench_scenario::{Scenario, Subject};
use clap::Args;

use super::context::{Context, Pictured};
use super::output;
use super::progress::Progress;
use crate::deliver::{deliver, print};
use crate::failure::Failure;

/// The scenarios whose methods and images are taken if none is named.
const USUAL: [&str; 8] = [
    "atlas/corners",
    "atlas/discs",
    "atlas/wedges",
    "targets/chessboard",
    "targets/charuco",
    "targets/aprilgrid",
    "targets/circles",
    "targets/rings",
];
/// How long a method is timed in each round, seconds.
const SLICE: f64 = 0.02;

#[derive(Args)]
pub struct SpeedCommand {
    /// Scenarios whose first image is measured [default: those of atlas/ that the atlas shows, and the boards of targets/]
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// Methods in place of the scenarios' own, as in forstner:window=15; may be repeated
    #[arg(short, long = "method", value_name = "METHOD")]
    methods: Vec<String>,
    /// How many rounds, each with all methods in turn
    #[arg(long, value_name = "N", default_value_t = 15, value_parser = clap::value_parser!(u16).range(3..=1000))]
    rounds: u16,
    /// Where the figures go [default: reference/speeds.csv of the project]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
}

impl SpeedCommand {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let names: Vec<&str> = if self.scenarios.is_empty() { USUAL.to_vec() } else { self.scenarios.iter().map(String::as_str).collect() };
        let scenarios = names.iter().map(|name| context.scenario(name)).collect::<Result<Vec<_>, _>>()?;
        let inputs = inputs_of(self.scenarios.iter().filter(|name| is_toml(name.as_ref())));
        let path = self.output.clone().map_or_else(|| Ok::<_, Failure>(context.root()?.join(SPEEDS)), Ok)?;
        let output = output::table("-o", Some(&path), &inputs)?;
        let methods = context.methods(&self.methods, Pictured::Renders)?;
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
        let mut speeds = Speeds { machine: machine(), rows: Vec::new() };
        for scenario in &scenarios {
            let Subject::Views(subject) = &scenario.subject else {
                return Err(Failure::input(format!("`{}` has no [testfield]; expected a scenario with views of one", scenario.name)));
            };
            if subject.study.transfer().is_some() && methods.is_empty() {
                let message = format!("`{}` applies calibrations and measures nothing: name methods with -m", scenario.name);
                return Err(Failure::input(message));
            }
            let (image, starts) = first_image(scenario, subject)?;
            let board = subject.sheet.and_then(|board| Sought::new(board).ok());
            let methods = if methods.is_empty() { &scenario.methods } else { &methods };
            all_busy(methods, starts.iter().filter_map(|start| start.kind))
                .map_err(|gap| Failure::input(format!("`{}`: {gap}", scenario.name)))?;
            let progress = Progress::start(&scenario.name, u64::from(self.rounds), context.quiet);
            speeds.rows.extend(one.install(|| self.time(scenario, methods, (&image, board.as_ref()), &starts, &|| progress.step())));
            progress.finish(&format!("{} methods on {} points", methods.len(), starts.len()));
        }
        deliver(output.as_ref(), |file| speeds.write(file))?;
        print(&format!("{}\n", path.display()))
    }

    /// Every method in every round; what the machine does beside it hits all of them.
    fn time(
        &self,
        scenario: &Scenario,
        methods: &[Configured],
        (image, board): (&Image, Option<&Sought>),
        starts: &[Start],
        step: &dyn Fn(),
    ) -> Vec<Speed> {
        let of = |method: &Configured| starts.iter().copied().filter(|start| method.measures(start.kind)).collect::<Vec<_>>();
        // What was recorded takes no time.
        let measures = |method: &&Configured| method.recorded().is_none() && finds_here(method, board);
        let operators: Vec<(&Configured, &dyn Operator, Vec<Start>)> =
            methods.iter().filter(measures).filter_map(|method| Some((method, method.operator.as_deref().ok()?, of(method)))).collect();
        let mut found: Vec<Vec<f64>> = vec![Vec::new(); operators.len()];
        for _ in 0..self.rounds {
            for ((_, operator, starts), rates) in operators.iter().zip(&mut found) {
                rates.push(rate(*operator, (image, board), starts));
            }
            step();
        }
        let row = |((method, _, starts), rates): (&(&Configured, &dyn Operator, Vec<Start>), &mut Vec<f64>)| {
            rates.sort_by(f64::total_cmp);
            let at = |part: usize| three_digits(rates[(rates.len() - 1) * part / 4]);
            Speed {
                scenario: scenario.name.clone(),
                method: method.label.clone(),
                version: method.version.clone(),
                points_per_second: at(2),
                low: at(1),
                high: at(3),
                points: starts.len(),
                rounds: rates.len(),
                image: format!("{}x{}", image.width(), image.height()),
            }
        };
        operators.iter().zip(&mut found).map(row).collect()
    }
}

/// Whether a method that finds boards knows the one that is pictured.
fn finds_here(method: &Configured, board: Option<&Sought>) -> bool {
    method.board_finder().is_none_or(|finder| board.is_some_and(|board| finder.unfit(&board.board).is_none()))
}

/// Points per second over at least [`SLICE`] seconds.
fn rate(operator: &dyn Operator, (image, board): (&Image, Option<&Sought>), starts: &[Start]) -> f64 {
    let (started, mut points) = (Instant::now(), 0_usize);
    loop {
        match operator.board_finder().zip(board) {
            Some((finder, board)) => drop(black_box(finder.find(black_box(image), board))),
            None => drop(black_box(operator.measure_all(black_box(image), black_box(starts)))),
        }
        points += starts.len();
        let seconds = started.elapsed().as_secs_f64();
        if seconds >= SLICE {
            return points as f64 / seconds;
        }
    }
}

/// More digits than three would claim too much.
fn three_digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// What was measured on, in a line.
fn machine() -> String {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let lanes = if cfg!(target_arch = "x86_64") { x86() } else { "default instructions" };
    format!("{} with {threads} hardware threads, {lanes}; measured on one thread", std::env::consts::ARCH)
}

#[cfg(target_arch = "x86_64")]
fn x86() -> &'static str {
    if is_x86_feature_detected!("avx512f") {
        "AVX-512"
    } else if is_x86_feature_detected!("avx2") {
        "AVX2"
    } else {
        "SSE2"
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn x86() -> &'static str {
    ""
}
