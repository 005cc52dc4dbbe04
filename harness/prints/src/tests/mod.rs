use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;

use calibench_files::OutputFolder;
use calibench_model::testfield::{Area, Curve, Outline, PlatePoint};
use calibench_model::{Plate, Testfield};

use super::*;

mod paper;

/// A sheet of 300 x 200 mm with a triangle, a disc inside a square, and a sector of 200 degrees that turns from v towards u.
fn field() -> Testfield {
    let area = |outline, level, ground| Area { outline, level, ground };
    let (radius, start, sweep) = (20.0, 3.5, -200_f64.to_radians());
    let arc = Curve::Arc { centre: [200.0, 50.0], radius, start, sweep };
    let sector = Outline(vec![arc, Curve::Line { from: arc.at(1.0), to: arc.at(0.0) }]);
    let areas = vec![
        area(Outline::disc([40.0, 40.0], 15.0), 0.85, 0.05),
        area(Outline::rectangle([10.0, 10.0], [70.0, 70.0]), 0.05, 0.85),
        area(Outline::polygon(&[[100.123_456_7, 150.0], [130.0, 160.0], [110.0, 180.0]]), 0.3, 0.85),
        area(sector, 0.05, 0.85),
    ];
    let plate = Plate {
        id: "a/ä<1>".into(),
        origin: nalgebra::Point3::origin(),
        u: nalgebra::Vector3::x(),
        v: nalgebra::Vector3::y(),
        bend: None,
        corners: [[-10.0, -20.0], [290.0, 180.0]],
        level: 0.85,
        areas,
    };
    Testfield { plates: vec![plate], targets: Vec::new(), background: 0.2 }
}

fn options(paper: Paper) -> PrintOptions {
    PrintOptions { name: "test & field".into(), mm_per_unit: 1.0, paper }
}

/// The numbers of a path with the letters between them.
fn tokens(path: &str) -> Vec<(char, Vec<f64>)> {
    let mut found: Vec<(char, String)> = Vec::new();
    for c in path.chars() {
        if c.is_ascii_alphabetic() {
            found.push((c, String::new()));
        } else if let Some(last) = found.last_mut() {
            last.1.push(c);
        }
    }
    found.into_iter().map(|(c, numbers)| (c, numbers.split_whitespace().map(|n| n.parse().unwrap()).collect())).collect()
}

fn near(a: PlatePoint, b: PlatePoint, off: f64) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) < off
}

#[test]
fn an_svg_holds_every_vertex_at_true_scale() {
    let field = field();
    let pages = sheets(&field, &options(Paper::Whole)).unwrap();
    let sheet = &pages[0];
    let text = svg(sheet);
    let document = roxmltree::Document::parse(&text).unwrap();
    let root = document.root_element();
    let [width, height] = sheet.size;
    assert_eq!(root.attribute("width"), Some(format!("{width}mm").as_str()));
    assert_eq!(root.attribute("viewBox"), Some(format!("0 0 {width} {height}").as_str()));
    assert_eq!((width, height), (320.0, 234.0));
    let paths: Vec<_> = document.descendants().filter(|node| node.has_tag_name("path")).collect();
    let areas = sheet.areas();
    assert_eq!(paths.len(), 4);
    for (path, (area, _)) in paths.iter().zip(areas) {
        let steps = tokens(path.attribute("d").unwrap());
        let back = |numbers: &[f64]| {
            let [x, y] = [numbers[numbers.len() - 2], height - numbers[numbers.len() - 1]];
            [x - sheet.origin[0], y - sheet.origin[1]]
        };
        assert!(near(back(&steps[0].1), area.outline.0[0].at(0.0), 2e-6));
        let mut drawn = steps[1..steps.len() - 1].iter();
        for curve in &area.outline.0 {
            let pieces = if let Curve::Arc { sweep, .. } = curve { (sweep.abs() / FRAC_PI_2 - 1e-9).ceil() } else { 1.0 };
            for i in 1..=pieces as usize {
                let (letter, numbers) = drawn.next().unwrap();
                assert!(near(back(numbers), curve.at(i as f64 / pieces), 2e-6));
                if let Curve::Arc { radius, sweep, .. } = curve {
                    assert_eq!((*letter, numbers[0], numbers[1], numbers[3]), ('A', *radius, *radius, 0.0));
                    assert_eq!(numbers[4], f64::from(u8::from(*sweep < 0.0)));
                } else {
                    assert_eq!(*letter, 'L');
                }
            }
        }
        assert!(drawn.next().is_none() && steps.last().unwrap().0 == 'Z');
    }
    let bar = document.descendants().find(|node| node.attribute("id") == Some("scale")).unwrap();
    assert_eq!(bar.attribute("width"), Some("100"));
    assert!(document.descendants().any(|node| node.text() == Some("test & field, plate a/ä<1>")));
}

#[test]
fn greys_reach_from_black_to_white_and_outer_areas_come_first() {
    let field = field();
    let pages = sheets(&field, &options(Paper::Whole)).unwrap();
    let areas = pages[0].areas();
    let levels: Vec<f64> = areas.iter().map(|(area, _)| area.level).collect();
    assert!(levels[0] == 0.05 && areas[0].1 == 0.0 && (pages[0].ground() - 1.0).abs() < 1e-12);
    let place = |outline: &Outline| areas.iter().position(|(area, _)| area.outline == *outline).unwrap();
    assert!(place(&field.plates[0].areas[1].outline) < place(&field.plates[0].areas[0].outline), "the disc is painted over the square");
    let grey = areas[place(&field.plates[0].areas[2].outline)].1;
    // (0.3 - 0.05) / 0.8 in sRGB.
    assert!((grey - (1.055 * 0.3125_f64.powf(1.0 / 2.4) - 0.055)).abs() < 1e-12);
}

/// The content of a PDF's pages.
fn contents(bytes: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(bytes).into_owned();
    text.split("\nstream\n").skip(1).map(|rest| rest.split("\nendstream").next().unwrap().to_owned()).collect()
}

#[test]
fn a_pdf_holds_every_vertex_and_its_arcs_are_round_to_a_ten_thousandth() {
    let mut field = field();
    field.plates[0].areas.push(Area { outline: Outline::disc([0.0, 0.0], 900.0), level: 0.5, ground: 0.85 });
    let pages = sheets(&field, &options(Paper::Whole)).unwrap();
    let bytes = pdf(&pages).unwrap();
    assert!(bytes.starts_with(b"%PDF-"));
    assert_eq!(bytes, pdf(&pages).unwrap());
    let content = contents(&bytes).remove(0);
    assert!(content.contains("10 10 100 1.5 re f"));
    let lines: Vec<&str> = content.lines().filter(|line| line.ends_with(" h f")).collect();
    let areas = pages[0].areas();
    assert_eq!(lines.len(), areas.len());
    for (line, (area, _)) in lines.iter().zip(areas) {
        let mut numbers: Vec<f64> = Vec::new();
        let mut at = [0.0; 2];
        let mut curves = area.outline.0.iter().peekable();
        let back = |numbers: &[f64]| [numbers[0] - pages[0].origin[0], numbers[1] - pages[0].origin[1]];
        for word in line.split_whitespace() {
            match word {
                "g" | "h" | "f" => {}
                "m" => assert!(near(back(&numbers), curves.peek().unwrap().at(0.0), 2e-6)),
                "l" => assert!(near(back(&numbers), curves.next().unwrap().at(1.0), 2e-6)),
                "c" => {
                    let Some(curve @ Curve::Arc { centre, radius, .. }) = curves.peek() else { panic!("no arc") };
                    let [a, b, c] = [0, 2, 4].map(|i| back(&numbers[i..]));
                    for t in (0..=50).map(|t| f64::from(t) / 50.0) {
                        let s = 1.0 - t;
                        let [u, v] = [0, 1].map(|i| s * s * s * at[i] + 3.0 * s * s * t * a[i] + 3.0 * s * t * t * b[i] + t * t * t * c[i]);
                        let off = (u - centre[0]).hypot(v - centre[1]) - radius;
                        assert!(off.abs() < 1e-4, "{off} mm off an arc of {radius} mm");
                    }
                    if near(c, curve.at(1.0), 2e-6) {
                        curves.next();
                    }
                }
                number => {
                    numbers.push(number.parse().unwrap());
                    continue;
                }
            }
            if numbers.len() >= 2 {
                at = back(&numbers[numbers.len() - 2..]);
            }
            numbers.clear();
        }
        assert!(curves.next().is_none(), "all curves are drawn");
    }
}

#[test]
fn tiles_cover_a_plate_without_gap_or_overlap() {
    let field = field();
    let pages = sheets(&field, &options(Paper::A4)).unwrap();
    // 300 x 200 mm: upright 190 x 263 mm are usable, across 277 x 176 mm.
    assert_eq!(pages.len(), 2);
    assert_eq!(pages[0].size, [210.0, 297.0]);
    let shown: Vec<[[f64; 2]; 2]> = pages.iter().map(|p| p.window.map(|at| [at[0] - p.origin[0], at[1] - p.origin[1]])).collect();
    assert!(near(shown[0][0], [-10.0, -20.0], 1e-9) && near(shown[0][1], [180.0, 180.0], 1e-9), "{shown:?}");
    assert!(near(shown[1][0], [180.0, -20.0], 1e-9) && near(shown[1][1], [290.0, 180.0], 1e-9));
    assert_eq!((pages[0].file_stem.as_str(), pages[1].file_stem.as_str()), ("test___field-a_ä_1_-r1c1", "test___field-a_ä_1_-r1c2"));
    assert!(pages[1].label.ends_with("row 1 of 1, column 2 of 2"));
    let large = sheets(&field, &PrintOptions { mm_per_unit: 10.0, ..options(Paper::A3) }).unwrap();
    let area: f64 = large.iter().map(|p| (p.window[1][0] - p.window[0][0]) * (p.window[1][1] - p.window[0][1])).sum();
    assert!((area - 3000.0 * 2000.0).abs() < 1e-3);
    assert!(large.iter().all(|p| p.window[0][0] >= 10.0 - 1e-9 && p.window[0][1] >= 24.0 - 1e-9));
    assert!(large.iter().any(|p| p.areas().is_empty()), "a tile lists what it shows");
    let one = sheets(&field, &options(Paper::A3)).unwrap();
    assert_eq!((one.len(), one[0].size), (1, [420.0, 297.0]));
}

#[test]
fn files_are_written_whole() {
    let folder = tempfile::tempdir().unwrap();
    let output = OutputFolder::open(&folder.path().join("out")).unwrap();
    output.replace(|folder| write_sheets(folder, &field(), &options(Paper::A4))).unwrap();
    let paths: Vec<PathBuf> = std::fs::read_dir(folder.path().join("out")).unwrap().map(|entry| entry.unwrap().path()).collect();
    let with = |ending: &str| paths.iter().filter(|path| path.extension().is_some_and(|e| e == ending)).collect::<Vec<_>>();
    let (svgs, pdfs) = (with("svg"), with("pdf"));
    assert_eq!((svgs.len(), pdfs.len()), (2, 1));
    assert!(svgs.iter().all(|path| std::fs::read_to_string(path).unwrap().ends_with("</svg>\n")));
    assert_eq!(contents(&std::fs::read(pdfs[0]).unwrap()).len(), 2);
}

#[test]
fn what_cannot_be_printed_is_refused() {
    let field = field();
    let scaled = |mm_per_unit, paper| sheets(&field, &PrintOptions { mm_per_unit, ..options(paper) }).map(|pages| pages.len());
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(scaled(scale, Paper::A4), Err(PrintError::Scale(_))));
    }
    for (width, height) in [(50.0, 500.0), (200.0, 60.0), (f64::NAN, 200.0), (9000.0, 200.0)] {
        assert!(matches!(scaled(1.0, Paper::Sheets { width, height }), Err(PrintError::Paper(..))), "{width} x {height}");
    }
    assert!(matches!(scaled(1000.0, Paper::A4), Err(PrintError::Pages { .. })));
    let large = sheets(&field, &PrintOptions { mm_per_unit: 100.0, ..options(Paper::Whole) }).unwrap();
    assert!(matches!(pdf(&large), Err(PrintError::TooLarge { .. })));
    let none = Testfield { plates: Vec::new(), ..field.clone() };
    assert!(matches!(sheets(&none, &options(Paper::A4)), Err(PrintError::Nothing)));
    let mut broken = field.clone();
    broken.plates[0].corners[1][0] = f64::NAN;
    assert!(matches!(sheets(&broken, &options(Paper::A4)), Err(PrintError::NotFinite(_))));
}
