#[path = "../tests/campaign/mod.rs"]
mod campaign;
use crate::{grid, hough, mapping, ridge};
#[test]
fn debug() {
    let blur: f64 = std::env::var("BLUR").unwrap().parse().unwrap();
    let tilt: f64 = std::env::var("TILT").unwrap().parse().unwrap();
    let setting = campaign::Setting::paper(1001, blur, 26.0);
    let field = setting.testfield();
    for shot in campaign::shots(&setting, &field, &[(45.0, [0.0, tilt])], &[0.0, 90.0]) {
        let points = ridge::ridges(&shot.image);
        let Ok(points) = points else {
            println!("{points:?}");
            continue;
        };
        let unit = mapping::Unit::of(240, 240);
        let s: Vec<_> = points.iter().map(|p| grid::straightened(p, unit, 0.0)).collect();
        let lines = hough::lines(&s, unit.reach * 1.5, 240.0);
        println!("{} points", points.len());
        for l in &lines {
            println!(
                "  {:?} r {:.1} span {:.0?} n {} rms {:.2}",
                l.normal[1].atan2(l.normal[0]).to_degrees().round(),
                l.r,
                l.span,
                l.points,
                l.rms
            );
        }
        match grid::find(&points, [240, 240]) {
            Ok(g) => println!(
                "grid rms {:.3} bend {:.4} n {} share {:.2} sides {:?}",
                g.adjusted.rms,
                g.adjusted.mapping.bend,
                g.adjusted.on.len(),
                g.sides.share(),
                g.sides.debug()
            ),
            Err(e) => println!("{e}"),
        }
    }
}
#[test]
fn dump() {
    use std::io::Write;
    let mut out = std::fs::File::create("/tmp/contours.txt").unwrap();
    for (blur, db) in [(0.6, 46.0), (0.8, 30.0), (1.0, 26.0)] {
        let setting = campaign::Setting::paper(501, blur, db);
        let field = setting.testfield();
        let recogniser = crate::Recogniser::new(&field, crate::Classifier::Modern).unwrap();
        for shot in campaign::shots(&setting, &field, &campaign::paper_tilts(), &[0.0, 90.0]) {
            let Ok(points) = ridge::ridges(&shot.image) else { continue };
            let Ok(grid) = grid::find(&points, [240, 240]) else { continue };
            let mapping = &grid.adjusted.mapping;
            let whole = grid.whole(0.019, [240, 240]);
            let level = crate::level::Level::of(&shot.image, 1);
            for square in recogniser.squares(&level, mapping, &whole, 2) {
                let Some(groups) = crate::groups::groups(&square.areas.areas) else { continue };
                for (i, p) in square.places().iter().enumerate() {
                    let at = mapping.image([square.at[0] as f64 + p[0], square.at[1] as f64 + p[1]]).unwrap();
                    let Some(t) = campaign::nearest(&shot, calibench_model::PixelPoint::new(at[0], at[1])) else { continue };
                    let c = crate::contour::follow(&square.areas, i);
                    let s: Vec<String> = c.iter().map(|p| format!("{},{}", p[0], p[1])).collect();
                    writeln!(
                        out,
                        "{blur} {} {} {} {} {}",
                        shot.phi,
                        groups[i] as usize,
                        field.targets[t].kind,
                        square.areas.areas[i].size,
                        s.join(";")
                    )
                    .unwrap();
                }
            }
        }
    }
}
