#[path = "../tests/campaign/mod.rs"]
mod campaign;
use crate::{grid, ridge, hough, mapping};
#[test]
fn debug() {
    let blur: f64 = std::env::var("BLUR").unwrap().parse().unwrap();
    let tilt: f64 = std::env::var("TILT").unwrap().parse().unwrap();
    let setting = campaign::Setting::paper(1001, blur, 26.0);
    let field = setting.testfield();
    for shot in campaign::shots(&setting, &field, &[(45.0, [0.0, tilt])], &[0.0, 90.0]) {
        let points = ridge::ridges(&shot.image);
        let Ok(points) = points else { println!("{points:?}"); continue };
        let unit = mapping::Unit::of(240, 240);
        let s: Vec<_> = points.iter().map(|p| grid::straightened(p, unit, 0.0)).collect();
        let lines = hough::lines(&s, unit.reach * 1.5, 240.0);
        println!("{} points", points.len());
        for l in &lines { println!("  {:?} r {:.1} span {:.0?} n {} rms {:.2}", l.normal[1].atan2(l.normal[0]).to_degrees().round(), l.r, l.span, l.points, l.rms); }
        match grid::find(&points, [240, 240]) {
            Ok(g) => println!("grid rms {:.3} bend {:.4} n {} share {:.2} sides {:?}", g.adjusted.rms, g.adjusted.mapping.bend, g.adjusted.on.len(), g.sides.share(), g.sides.debug()),
            Err(e) => println!("{e}"),
        }
    }
}
