//! Megapixels a second of the sensor's stages, each alone, and of the usual chain. Best of several; one thread unless it says two.

#![allow(clippy::print_stdout)]

use std::time::Instant;

use calibench_model::Image;
use calibench_random::Key;
use calibench_synth::sensor::{
    ColourFilter, Demosaic, DemosaicTo, Design, Electrons, FallOff, Gamma, Gradient, Noise, Pattern, Per, Sensor, Vignetting,
};
use rayon::ThreadPoolBuilder;

const WIDTH: usize = 4272;
const HEIGHT: usize = 2848;
const REPEATS: usize = 7;

fn main() {
    let chessboard = Image::from_fn(WIDTH, HEIGHT, |x, y| if (x / 100 + y / 100) % 2 == 0 { 0.05 } else { 0.85 });
    println!("{:<44}{:>8}", format!("{WIDTH} x {HEIGHT} px"), "Mpx/s");
    for (name, design) in stages() {
        print(name, 1, &design, &chessboard);
    }
    print("photon and read noise, 8 bit, two threads", 2, &usual(), &chessboard);
    let sky = Image::from_fn(WIDTH, HEIGHT, |_, _| 1.0);
    print("the same of an image at the brim", 1, &usual(), &sky);
    let night = Image::from_fn(WIDTH, HEIGHT, |_, _| 0.004);
    print("the same of an image of 40 e-", 1, &usual(), &night);
}

fn print(name: &str, threads: usize, design: &Design, image: &Image<'static>) {
    let Ok(sensor) = Sensor::new(design.clone()) else { return println!("{name:<44}{:>8}", "refused") };
    let Ok(pool) = ThreadPoolBuilder::new().num_threads(threads).build() else { return };
    let key = Key { seed: 1, of: "perf", trial: 0, view: "v", target: "" };
    let seconds = (0..REPEATS).map(|_| {
        let light = image.clone();
        pool.install(|| {
            let start = Instant::now();
            let exposure = sensor.expose(light, key);
            let seconds = start.elapsed().as_secs_f64();
            drop(std::hint::black_box(exposure));
            seconds
        })
    });
    let best = seconds.fold(f64::INFINITY, f64::min);
    println!("{name:<44}{:>8.1}", (WIDTH * HEIGHT) as f64 / best / 1e6);
}

fn usual() -> Design {
    with(Electrons { read: 5.0, ..Electrons::of_well(1e4) })
}

fn with(electrons: Electrons) -> Design {
    Design { noise: Noise::Electrons(electrons), converter: Some(8), ..Design::default() }
}

fn stages() -> Vec<(&'static str, Design)> {
    let read = Electrons { read: 5.0, ..Electrons::of_well(1e4) };
    let bare = Design::default();
    let filter = Some(ColourFilter { pattern: Pattern::Rggb, sensitivity: [0.6, 1.0, 0.7] });
    let demosaic = Some(Demosaic { to: DemosaicTo::Grey, white_balance: None });
    let vignetting = |fall_off| Some(Vignetting { centre: None, fall_off });
    vec![
        ("photon and read noise, 8 bit", usual()),
        ("the same and PRNU", with(Electrons { prnu: 0.01, ..read })),
        (
            "the same, PRNU, DSNU and row noise, 12 bit",
            Design { converter: Some(12), ..with(Electrons { prnu: 0.01, dsnu: 2.0, row: 1.0, ..read }) },
        ),
        ("electrons counted (16 bit, no read noise)", Design { converter: Some(16), ..with(Electrons::of_well(1e4)) }),
        ("white noise", Design { noise: Noise::White { sigma: 0.01, prnu: 0.0 }, ..bare.clone() }),
        ("vignetting, cos^4", Design { vignetting: vignetting(FallOff::Cos4 { c: 4000.0 }), ..bare.clone() }),
        ("vignetting, polynomial", Design { vignetting: vignetting(FallOff::Polynomial([-0.3, 0.05, 0.0])), ..bare.clone() }),
        ("gradient", Design { gradient: Some(Gradient { x: 0.2, y: 0.1, per: Per::Frame }), ..bare.clone() }),
        ("exposure", Design { exposure: 0.9, ..bare.clone() }),
        ("colour filter", Design { filter, ..bare.clone() }),
        ("colour filter and demosaic", Design { filter, demosaic, ..bare.clone() }),
        ("converter", Design { converter: Some(8), ..bare.clone() }),
        ("gamma 2.2", Design { gamma: Some(Gamma::Power(2.2)), ..bare.clone() }),
        ("sRGB of 12 bits to 8", Design { converter: Some(12), gamma: Some(Gamma::Srgb), output: Some(8), ..bare.clone() }),
        ("JPEG 90", Design { jpeg: Some(90), ..bare }),
    ]
}
