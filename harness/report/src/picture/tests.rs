use std::io::Read;

use calibench_files::OutputFile;
use calibench_model::Image;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::Canvas;
use crate::axes::upright;
use crate::canvas::Mark;

/// One stroke of each kind, and what may not be taken for markup.
fn canvas() -> Canvas {
    let mut canvas = Canvas::new(300, 200);
    canvas.text("a < b", 16, (20, 30));
    canvas.label("rim", 13, (20, 60));
    canvas.frame((10, 10), (50, 40));
    canvas.of(Some("forstner & co"), |canvas| canvas.marks(&[(Mark::Circle, RED, (120.0, 90.0)), (Mark::Triangle, BLUE, (150.0, 90.0))]));
    canvas.enlarge(&Image::from_fn(4, 3, |x, y| (x + y) as f32 / 8.0), (0, 0), (4, 3), 5, (200, 20));
    canvas.paint(|area| {
        area.draw(&PathElement::new([(101, 102), (103, 107)], GREEN)).ok();
        area.draw(&Circle::new((60, 150), 7, BLUE.mix(0.25).filled())).ok();
        area.draw(&Polygon::new([(5, 190), (15, 190), (10, 180)], BLACK)).ok();
        (0..9).for_each(|x| drop(area.draw_pixel((250 + x, 150), &RED)));
        let style = ("sans-serif", 16).into_font().color(&BLACK).pos(Pos::new(HPos::Right, VPos::Center));
        area.draw(&Text::new("σ 95 %", (290, 120), style)).ok();
        upright(area, "upright", (280, 180));
    });
    canvas
}

fn written(ending: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("picture.{ending}"));
    canvas().write(&OutputFile::open(&path).unwrap()).unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn a_file_is_what_its_ending_says_and_the_same_every_time() {
    for (ending, begins) in [("png", &b"\x89PNG"[..]), ("svg", b"<?xml"), ("SVG", b"<?xml"), ("pdf", b"%PDF-"), ("Pdf", b"%PDF-")] {
        let bytes = written(ending);
        assert!(bytes.starts_with(begins), "{ending}");
        assert!(bytes == written(ending), "{ending}");
    }
}

#[test]
fn svg_needs_no_style_sheet_and_holds_every_stroke() {
    let text = String::from_utf8(written("svg")).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let texts: Vec<_> = document.descendants().filter(|node| node.has_tag_name("text")).collect();
    let said: Vec<&str> = texts.iter().filter_map(roxmltree::Node::text).collect();
    assert_eq!(said, ["a < b", "rim", "rim", "σ 95 %", "upright"], "a rim is a text below");
    assert!(texts.iter().all(|node| node.has_attribute("font-size") && node.has_attribute("dy") && !node.has_attribute("class")));
    // 16 px from the highest to the lowest letter are an em of 11.75, and its capitals 8.39 high.
    let first = &texts[0];
    assert_eq!([first.attribute("font-size"), first.attribute("dy")], [Some("11.75"), Some("4.19")]);
    assert_eq!(texts[3].attribute("text-anchor"), Some("end"));
    assert_eq!(texts[4].attribute("transform"), Some("rotate(270 280 180)"));
    let titles: Vec<&str> = document.descendants().filter(|node| node.has_tag_name("title")).filter_map(|node| node.text()).collect();
    assert!(!titles.is_empty() && titles.iter().all(|title| *title == "forstner & co"), "{titles:?}");
    assert_eq!(document.descendants().filter(|node| node.has_tag_name("image")).count(), 2);
    for part in ["M10 10h50v40h-50z", "M101 102l2 5", "M5 190", "M60 150h0"] {
        assert_eq!(text.matches(part).count(), 1, "{part}: {text}");
    }
    assert!(!text.contains("data-"), "what the script of a page reads has no place here");
}

/// The streams of a document that are compressed, in their order.
fn streams(pdf: &[u8]) -> Vec<Vec<u8>> {
    let find = |from: usize, what: &[u8]| pdf[from..].windows(what.len()).position(|window| window == what).map(|place| from + place);
    let mut found = Vec::new();
    let mut from = 0;
    while let Some(begin) = find(from, b"\nstream\n") {
        let (start, end) = (begin + 8, find(begin, b"\nendstream").unwrap());
        let mut bytes = Vec::new();
        if flate2::read::ZlibDecoder::new(&pdf[start..end]).read_to_end(&mut bytes).is_ok() {
            found.push(bytes);
        }
        from = end;
    }
    found
}

#[test]
fn pdf_holds_every_stroke_at_its_place() {
    let pdf = written("pdf");
    let streams = streams(&pdf);
    let content = String::from_utf8(streams[0].clone()).unwrap();
    assert!(content.starts_with("0.75 0 0 -0.75 0 150 cm 1 1 1 rg 0 0 300 200 re f\n"), "{content}");
    for part in
        ["10 10 50 40 re S", "101 102 m 103 107 l  S", "5 190 m", "q 20 0 0 -15 200 35 cm /I0 Do Q", "q 9 0 0 -1 250 151 cm /I1 Do Q"]
    {
        assert_eq!(content.matches(part).count(), 1, "{part}: {content}");
    }
    // A disc a quarter opaque, and what follows opaque again.
    assert_eq!(content.matches("/A25 gs\n0.000 0.000 1.000 rg 67.000 150.000 m").count(), 1, "{content}");
    assert!(content.split("/A25 gs").nth(1).unwrap().contains("/A100 gs"), "{content}");
    // The circle of a mark, with its rim.
    assert_eq!(content.matches("126.000 90.000 m").count(), 2, "{content}");
    // Text from (20, 30): capitals of 8.39 px about its place.
    assert!(content.contains("BT 0 Tr 0.000 0.000 0.000 rg /F 11.747 Tf 1 0 0 -1 20.00 34.19 Tm"), "{content}");
    // Rows, 4 x 3 grey values, and 9 pixels of three colours.
    assert!(streams.iter().any(|bytes| bytes.len() == 12) && streams.iter().any(|bytes| bytes == &[255, 0, 0].repeat(9)));
}

#[test]
fn pdf_embeds_the_letters_that_are_used_and_says_what_they_are() {
    let pdf = written("pdf");
    assert!(pdf.len() < 30_000, "{} bytes: the font is cut", pdf.len());
    let streams = streams(&pdf);
    let font = streams.iter().find(|bytes| bytes.starts_with(&[0, 1, 0, 0])).expect("a font");
    let face = ttf_parser::Face::parse(font, 0).unwrap();
    // Those of "a < b", "rim", "σ 95 %" and "upright", and the one for what there is not.
    let letters: std::collections::BTreeSet<char> = "a < brimσ 95 %upright".chars().collect();
    assert_eq!(usize::from(face.number_of_glyphs()), letters.len() + 1);
    let whole = String::from_utf8_lossy(&pdf);
    assert!(whole.contains("<03C3>"), "sigma can be searched for");

    // "σ 95 %" ends at 290: its letters are as wide as the font says.
    let noto = ttf_parser::Face::parse(ttf_noto_sans::REGULAR, 0).unwrap();
    let wide: f64 = "σ 95 %".chars().map(|letter| f64::from(noto.glyph_hor_advance(noto.glyph_index(letter).unwrap()).unwrap())).sum();
    let from = 290.0 - wide / f64::from(noto.units_per_em()) * 16.0 / 1.362;
    let content = String::from_utf8(streams[0].clone()).unwrap();
    assert!(content.contains(&format!("1 0 0 -1 {from:.2} 124.19 Tm")), "{from}: {content}");
    // It ends at (280, 180) and is read from below: up the picture, its capitals about x = 280.
    assert!(content.contains(" Tf 0 -1 -1 -0 283.41 "), "{content}");
}
