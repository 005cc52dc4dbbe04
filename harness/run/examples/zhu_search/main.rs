//! A search for the drawing and the detector behind Zhu, Wu & Wan 2007, Table I: `cargo run --release --example zhu_search`.
//!
//! It shares no code with the operator but the fit of the paraboloid: gradients by explicit kernels, integration by explicit weights, everything in double
//! precision. As in the scenario, a point starts at the detection nearest to it and the operator takes the strongest pixel around that.
//!
//! The criterion is the RMS difference of the eight |v| from the printed ones; m, the RMS of the |v| themselves, stands beside it. A setting in which the
//! operator rejects one of the eight points, or takes a stronger detection than the nearest, measures other points than the table: it is discarded, and counted.
//! As the best of so many settings is flattered, the same search is made for the printed figures in other orders.

mod best;
mod detector;
mod drawing;
mod grid;

use best::{Chance, Found, Least, Orders};
use calibench_measure::paraboloid::Weights;
use calibench_synth::testfield::{Figure4, Join};
use detector::{Derivative, Discarded, Integration, Peak, Products};
use drawing::{Drawing, Picturing};
use rayon::prelude::*;

const ALPHAS: [f64; 5] = [0.0, 0.04, 0.05, 0.06, 0.15];
const KS: [f64; 4] = [0.2, 0.5, 1.0, 10.0];

#[derive(Clone, Debug)]
struct Setting {
    picturing: Picturing,
    join: Join,
    derivative: Derivative,
    integration: Integration,
    alpha: f64,
    k: f64,
}

type List = (&'static str, fn(&Setting) -> bool, Least<Setting>);

/// What is kept of the search.
#[derive(Clone)]
struct Summary {
    settings: u64,
    rejected: u64,
    another: u64,
    lists: Vec<List>,
    chance: Chance,
}

impl Summary {
    fn new() -> Self {
        let by_print = || Least::new(Found::off);
        let blurred: fn(&Setting) -> bool = |s| s.picturing.drawing != Drawing::Hard;
        let lists: Vec<List> = vec![
            ("Nearest to the print", |_| true, by_print()),
            ("Nearest to the truth", |_| true, Least::new(Found::m)),
            ("Nearest to the print, as the paper says: alpha 0.04, k 0.2", |s| s.alpha == 0.04 && s.k == 0.2, by_print()),
            ("Nearest to the print, Sobel", |s| s.derivative == Derivative::Sobel, by_print()),
            ("Nearest to the print, lines that are not mitred", |s| s.join != Join::Mitre, by_print()),
            ("Nearest to the print, with partial coverage", blurred, by_print()),
        ];
        Self { settings: 0, rejected: 0, another: 0, lists, chance: Chance::new() }
    }

    fn add(&mut self, orders: &Orders, setting: Setting, v: Result<[f64; 8], Discarded>) {
        self.settings += 1;
        match v {
            Err(Discarded::Rejected) => self.rejected += 1,
            Err(Discarded::AnotherPoint) => self.another += 1,
            Ok(v) => {
                self.chance.add(orders, &v);
                let found = Found { setting, v };
                self.lists.iter_mut().filter(|(_, keep, _)| keep(&found.setting)).for_each(|(_, _, least)| least.add(&found));
            }
        }
    }

    fn merge(mut self, other: &Self) -> Self {
        self.settings += other.settings;
        self.rejected += other.rejected;
        self.another += other.another;
        self.lists.iter_mut().zip(&other.lists).for_each(|((_, _, least), (_, _, more))| least.merge(more));
        self.chance.merge(&other.chance);
        self
    }

    fn print(&self) {
        let Self { settings, rejected, another, .. } = self;
        println!("{settings} settings: in {rejected} a point is rejected, in {another} another point is taken,");
        println!("in {} all eight points are measured. Printed: m = 0.153", settings - rejected - another);
        let best = self.lists[0].2.list.first().map_or(f64::NAN, Found::off);
        let (share, [least, middle, largest]) = self.chance.as_near_as(best);
        println!(
            "The figures in other orders: {:.1} % come as near as {best:.3} px; {least:.3} px the nearest, {middle:.3} the median, {largest:.3} the farthest.",
            100.0 * share
        );
        self.lists.iter().for_each(|(title, _, least)| print(title, least));
    }
}

/// The peaks of one image for every detector.
fn peaks(picturing: &Picturing, figure: Figure4, join: Join) -> Vec<Result<Peak, Discarded>> {
    let picture = picturing.picture(figure, join);
    let mut all = Vec::new();
    for derivative in Derivative::ALL {
        let products = Products::of(&picture, derivative);
        for integration in Integration::ALL {
            let moments = products.integrated(integration);
            all.extend(ALPHAS.map(|alpha| moments.peak(alpha)));
        }
    }
    all
}

/// All settings of the detector for one way of picturing, and for every way in which two lines join.
fn search(picturing: Picturing, orders: &Orders) -> Summary {
    let mitred = Figure4::ALL.map(|figure| peaks(&picturing, figure, Join::Mitre));
    let mut summary = Summary::new();
    for join in Join::ALL {
        let own = Figure4::ALL.map(|figure| (join != Join::Mitre && figure.is_of_lines()).then(|| peaks(&picturing, figure, join)));
        let of = |figure: usize, index: usize| own[figure].as_ref().unwrap_or(&mitred[figure])[index];
        let mut index = 0;
        for derivative in Derivative::ALL {
            for integration in Integration::ALL {
                for alpha in ALPHAS {
                    for k in KS {
                        let weights = Weights::new(k);
                        let v: Result<Vec<f64>, Discarded> = (0..8).map(|figure| of(figure, index)?.distance(&weights)).collect();
                        let v = v.map(|v| std::array::from_fn(|figure| v[figure]));
                        summary.add(orders, Setting { picturing, join, derivative, integration, alpha, k }, v);
                    }
                    index += 1;
                }
            }
        }
    }
    summary
}

fn print(title: &str, least: &Least<Setting>) {
    println!("\n{title}\n");
    println!(
        "| m | rms from printed | drawing | corner | stroke | join | pen | edge | derivative | integration | alpha | k | a b c d e f g h |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for found in &least.list {
        let (s, p) = (&found.setting, &found.setting.picturing);
        let place = if p.at_centre { "pixel centre" } else { "pixel corner" };
        let edge = if p.edge_along_x { "edge along x" } else { "bisector along x" };
        let v: Vec<String> = found.v.iter().map(|v| format!("{v:.3}")).collect();
        println!(
            "| {:.3} | {:.3} | {:?} | {place} | {} | {:?} | {} | {edge} | {:?} | {:?} | {} | {} | {} |",
            found.m(),
            found.off(),
            p.drawing,
            p.stroke,
            s.join,
            p.pen,
            s.derivative,
            s.integration,
            s.alpha,
            s.k,
            v.join(" ")
        );
    }
}

fn main() {
    let orders = Orders::new();
    let whole = Picturing::all().into_par_iter().map(|picturing| search(picturing, &orders));
    whole.reduce(Summary::new, |all, other| all.merge(&other)).print();
}
