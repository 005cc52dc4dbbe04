//! Milliseconds an image of the recognition, one thread: the paper's 36 images of 240 x 240 px, larger ones, and images that are refused. Least of several.

#![allow(clippy::print_stdout)]

#[path = "../tests/campaign/mod.rs"]
mod campaign;

use std::time::Instant;

use calibench_model::Image;
use calibench_recognise::{Classifier, Recogniser};
use campaign::{Setting, paper_tilts, shots};

const REPEATS: usize = 5;

fn main() {
    println!("{:<52}{:>9}{:>9}", "ms an image: asked 20 of 240 x 240 px", "modern", "contours");
    let mut field = None;
    for (blur, decibel) in [(0.6, 46.0), (0.6, 26.0), (1.0, 26.0)] {
        let setting = Setting::paper(7001, blur, decibel);
        let own = setting.testfield();
        let images: Vec<Image<'static>> =
            shots(&setting, &own, &paper_tilts(), &[0.0, 90.0, 180.0, 270.0]).into_iter().map(|shot| shot.image).collect();
        let recognisers =
            [Classifier::Modern, Classifier::Contours].map(|classifier| Recogniser::new(&own, classifier).expect("a coded field"));
        print(&format!("36 images, blur {blur} px, {decibel} dB"), &recognisers, &images);
        field = Some((setting, own, recognisers));
    }
    let Some((setting, own, recognisers)) = field else { return };
    for times in [4, 16] {
        let mut large = setting.clone();
        large.camera.size.width *= times;
        large.camera.size.height *= times;
        large.camera.pitch_um /= f64::from(times);
        let images: Vec<Image<'static>> = shots(&large, &own, &[(30.0, [0.0, 30.0])], &[12.0]).into_iter().map(|shot| shot.image).collect();
        print(&format!("the field in {0} x {0} px", 240 * times), &recognisers, &images);
    }
    let refused = |name: &str, image: Image<'static>| print(name, &recognisers, &[image]);
    refused("blank, 240 x 240 px", Image::from_fn(240, 240, |_, _| 0.5));
    refused("noise, 240 x 240 px", noise(240, 240));
    refused("noise, 4000 x 3000 px", noise(4000, 3000));
    refused("chessboard, 4000 x 3000 px", Image::from_fn(4000, 3000, |x, y| if (x / 170 + y / 170).is_multiple_of(2) { 0.1 } else { 0.9 }));
}

fn noise(width: usize, height: usize) -> Image<'static> {
    let mut state = 1_u32;
    Image::from_fn(width, height, |_, _| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    })
}

fn print(name: &str, recognisers: &[Recogniser; 2], images: &[Image]) {
    let best = |recogniser: &Recogniser| {
        let run = || {
            let start = Instant::now();
            images.iter().for_each(|image| drop(std::hint::black_box(recogniser.recognise(image))));
            start.elapsed().as_secs_f64()
        };
        (0..REPEATS).map(|_| run()).fold(f64::INFINITY, f64::min) * 1e3 / images.len() as f64
    };
    println!("{name:<52}{:>9.1}{:>9.1}", best(&recognisers[0]), best(&recognisers[1]));
}
