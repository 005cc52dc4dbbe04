//! Declarations, requests and answers; what processes do is tried with the whole program.

use calibench_model::{Image, PixelPoint, Rejection, Start, TargetKind};

use crate::answer::{Answer, read};
use crate::declaration::{Declaration, Grey};
use crate::file::{Declared, parse};
use crate::request::{Wanted, body, greeting, head, rounds};
use crate::starts::Starts;

const GOOD: &str = r#"
[[plugin]]
name = "mine"
command = ["python3", "mine.py"]
parameters = { window = { default = 11, min = 3, max = 31, odd = true }, reach = { default = 0.5, min = 0.0, max = 2.0 } }
memory = "1.5 GB"
"#;

/// The first plug-in that a text declares.
fn program(text: &str) -> Declaration {
    let Declared::Program(program) = parse("mine.toml", text).unwrap().remove(0) else { panic!("a program") };
    program
}

#[test]
fn a_declaration_is_read_with_its_defaults() {
    let found = program(GOOD);
    assert_eq!((found.name.as_str(), found.grey, found.starts, found.seconds), ("mine", Grey::Gray8, Starts::Given, 30.0));
    assert_eq!(found.memory, 1_500_000_000);
    let named: Vec<_> = found.parameters.iter().map(|p| (p.name, p.default, p.domain.describe())).collect();
    assert_eq!(named[0], ("reach", 0.5, "a number from 0 to 2".to_owned()));
    assert_eq!(named[1], ("window", 11.0, "an odd number from 3 to 31".to_owned()));
}

#[test]
fn how_far_points_lie_outwards_is_stated_for_all_kinds_or_for_each() {
    for (text, expected) in [("-0.5", [-0.5, -0.5]), ("{ aprilgrid = -2.7 }", [-2.7, 0.0])] {
        let found = program(&GOOD.replace("memory = \"1.5 GB\"", &format!("starts = \"board\"\noutwards = {text}")));
        let Starts::Board(boards) = found.starts else { panic!("{text}") };
        let of = |kind: &str| boards.outwards.get(kind).copied().unwrap_or(0.0);
        assert_eq!([of("aprilgrid"), of("chessboard")], expected, "{text}");
    }
}

#[test]
fn every_mistake_in_a_declaration_has_its_place() {
    for (old, new, place, expected) in [
        ("name = \"mine\"", "name = \"Mine\"", "3:8", "no name of a method"),
        ("command = [\"python3\", \"mine.py\"]", "command = []", "4:11", "expected the program"),
        ("default = 11", "default = 12", "5:", "the default must be an odd number from 3 to 31, found 12"),
        ("default = 11", "default = \"x\"", "5:", "`default` must be a number"),
        ("min = 3", "min = -3", "5:", "not negative"),
        ("1.5 GB", "1.5", "6:10", "`1.5` is no memory"),
        ("memory", "memry", "6:1", "unknown field `memry`"),
        ("memory = \"1.5 GB\"", "starts = \"some\"", "6:10", "expected \"given\", \"none\" or \"board\""),
        ("memory = \"1.5 GB\"", "radius = 3.0", "6:10", "`radius` is for starts"),
        ("memory = \"1.5 GB\"", "origin = \"corner\"", "6:10", "`origin` is for starts = \"board\""),
        ("memory = \"1.5 GB\"", "starts = \"board\"\norigin = \"edge\"", "7:10", "expected \"centre\""),
        ("memory = \"1.5 GB\"", "outwards = 0.5", "6:12", "`outwards` is for starts = \"board\""),
        ("memory = \"1.5 GB\"", "starts = \"board\"\noutwards = -11.0", "7:12", "expected px from -10 to 10"),
        ("memory = \"1.5 GB\"", "starts = \"board\"\noutwards = { tags = 1 }", "7:12", "`tags` is no kind of board"),
        ("memory = \"1.5 GB\"", "starts = \"board\"\noutwards = \"far\"", "7:12", "expected a number of px"),
        ("memory = \"1.5 GB\"", "starts = \"board\"\nboards = [\"charucco\"]", "7:10", "`charucco` is no kind of board"),
        ("memory = \"1.5 GB\"", "seconds = 0.0", "6:11", "expected seconds"),
        ("memory = \"1.5 GB\"", "mode = \"files\"", "6:8", "mode `files` is not known"),
        ("memory = \"1.5 GB\"", "version = \"1\"", "6:11", "`version` is for mode"),
        ("memory = \"1.5 GB\"", "image = \"rgb\"", "6:9", "unknown variant `rgb`"),
    ] {
        assert!(GOOD.contains(old));
        let message = parse("mine.toml", &GOOD.replacen(old, new, 1)).expect_err(new).to_string();
        assert!(message.starts_with(&format!("mine.toml:{place}")) && message.contains(expected), "{new}: {message}");
    }
    assert!(parse("empty.toml", "").unwrap_err().to_string().contains("declares no plug-in"));
}

#[test]
fn requests_are_a_line_and_the_grey_values() {
    let parameters = [("window", 11.0), ("reach", 0.5)];
    assert_eq!(greeting(parameters.into_iter()), b"{\"calibench\":1,\"parameters\":{\"reach\":0.5,\"window\":11}}\n");
    let image = Image::new(2, 1, vec![0.0, 128.0 / 255.0]);
    let start = Start { kind: Some(TargetKind::ChessCorner), ..Start::at(PixelPoint::new(0.25, 0.0)) };
    let line = String::from_utf8(head(1, &image, Grey::Gray16le, Wanted::Each(&[start]))).unwrap();
    let expected = r#"{"bytes":4,"format":"gray16le","height":1,"image":1,"kinds":["chess_corner"],"starts":[[0.25,0.0]],"width":2}"#;
    assert_eq!(line, format!("{expected}\n"));
    assert!(!String::from_utf8(head(1, &image, Grey::Gray8, Wanted::Anything)).unwrap().contains("starts"));
    assert_eq!(body(&image, Grey::Gray8), [0, 128]);
    assert_eq!(body(&image, Grey::Gray16le), [0, 0, 0x80, 0x80]);
    assert_eq!(body(&Image::new(1, 1, vec![0.25]), Grey::Gray16le), [0x00, 0x40], "the lower byte first");
    assert_eq!(body(&image, Grey::Gray32f), [0.0_f32.to_le_bytes(), (128.0_f32 / 255.0).to_le_bytes()].concat());
    assert_eq!([Grey::Gray8, Grey::Gray16le, Grey::Gray32f].map(|grey| rounds(&image, grey)), [false; 3]);
    let deep = Image::new(2, 1, vec![0.5, 1.2]);
    assert_eq!([Grey::Gray8, Grey::Gray16le, Grey::Gray32f].map(|grey| rounds(&deep, grey)), [true, true, false]);
}

#[test]
fn answers_are_read_point_by_point() {
    let line = r#"{"image": 3, "xy": [[1.5, 2], null, [NaN, 3], [Infinity, 0], [1], [4, 5], [6, 7]],
        "cov": [[1e-4, 0, 2e-4], null, null, null, null, [1, 2, 1], [null, null, null]],
        "reasons": [null, "NaN \"here\"", null, null, null, null, null]}"#;
    let Answer { points, told, .. } = read(line, 3, Some(7), 100).unwrap();
    let first = points[0].unwrap();
    assert_eq!((first.position.x, first.position.y, first.covariance.unwrap().syy), (1.5, 2.0, 2e-4));
    let reasons: Vec<_> = points[1..6].iter().map(|point| point.unwrap_err()).collect();
    let (declined, malformed) = (Rejection::Declined, Rejection::Malformed);
    assert_eq!(reasons, [declined, declined, malformed, malformed, malformed]);
    assert_eq!(points[6].unwrap().covariance, None);
    assert_eq!(told[0], "NaN \"here\"", "a text is not touched");
    assert!(told[1].contains("infinite") && told[2].contains("not [x, y]") && told[3].contains("covariance"), "{told:?}");
}

#[test]
fn answers_that_are_none_say_why() {
    for (line, asked, expected) in [
        ("", Some(1), "an empty line"),
        ("7", Some(1), "`7`"),
        ("{\"xy\": [[1, 2]", Some(1), "expected a line of JSON"),
        ("{}", Some(1), "no `xy`"),
        ("{\"xy\": [[1, 2]]}", Some(1), "`image` must be that of the request, found none"),
        ("{\"image\": 2, \"xy\": [[1, 2]]}", Some(1), "found another"),
        ("{\"image\": 3, \"xy\": [[1, 2], [3, 4]]}", Some(1), "2 positions, asked for were 1"),
        ("{\"image\": 3, \"xy\": [[1, 2]], \"cov\": []}", Some(1), "`cov` has 0 entries"),
        ("{\"image\": 3, \"xy\": [[1, 2], [3, 4], [5, 6]]}", None, "3 positions in one image"),
    ] {
        let fault = read(line, 3, asked, 2).unwrap_err();
        assert_eq!(fault.rejection, Rejection::Malformed);
        assert!(fault.message.contains(expected), "{line}: {}", fault.message);
    }
    let raised = read("{\"error\": \"no memory\"}", 3, Some(1), 2).unwrap_err();
    assert_eq!((raised.rejection, raised.message.as_str()), (Rejection::Raised, "no memory"));
}

/// The shell example returns its starts, so that each answer tells whose it is.
#[test]
fn answers_go_to_the_starts_that_they_are_about() {
    let text = "[[plugin]]\nname = \"start_sh\"\ncommand = [\"sh\", \"start.sh\"]\n";
    let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/plugins"));
    let launcher = crate::Launcher { confiner: None, project: None };
    let registry = calibench_measure::Registry::default().with(crate::method(program(text), folder, &launcher));
    let configured = registry.parse("start_sh").unwrap();
    let operator = configured.operator.unwrap();
    let at = |x: f64| Start::at(PixelPoint::new(x, 7.25));
    let image = Image::from_fn(40, 30, |_, _| 1.0);
    for (round, bad) in [(0.0, f64::NAN), (0.5, f64::INFINITY)] {
        let starts: Vec<Start> =
            (0..20).map(|i| at(f64::from(i) + round)).chain([at(bad)]).chain((20..30).map(|i| at(f64::from(i) + round))).collect();
        for (start, found) in starts.iter().zip(operator.measure_all(&image, &starts)) {
            let expected = if start.position.is_finite() { Ok(start.position) } else { Err(Rejection::NotFinite) };
            assert_eq!(found.map(|found| found.position), expected);
        }
        assert!(operator.measure_all(&image, &[]).is_empty() && operator.measure_all(&image, &[at(bad)]) == [Err(Rejection::NotFinite)]);
    }
    assert!(operator.notes().concat().contains("not kept from"), "who is not restricted is told");
}

/// What is read of `measured.csv` below a header, about three points.
fn by_file(header: &str, rows: &str, asked: Option<usize>) -> Result<Answer, crate::answer::Fault> {
    crate::folder::read(format!("{header}\n{rows}").as_bytes(), "0001.png", asked, 2)
}

#[test]
fn files_are_read_by_the_numbers_of_their_points() {
    let rows = "0001.png,3,5,6,,,,measured,\n0001.png,1,1.5,2.5,1e-4,0,2e-4,measured,\n0001.png,2,,,,,,rejected,no corner\n";
    let header = "image,target,x,y,sxx,sxy,syy,status,reason";
    let Answer { points, told, .. } = by_file(header, rows, Some(4)).unwrap();
    let at = |place: usize| points[place].map(|found| (found.position.x, found.position.y));
    let declined = Err(Rejection::Declined);
    assert_eq!([0, 1, 2, 3].map(at), [Ok((1.5, 2.5)), declined, Ok((5.0, 6.0)), declined], "in the order in which they were asked");
    assert_eq!(
        (points[0].unwrap().covariance.unwrap().syy, points[2].unwrap().covariance, told),
        (2e-4, None, vec!["no corner".to_owned()])
    );
    assert_eq!(by_file(header, "", Some(2)).unwrap().points, [Err(Rejection::Declined); 2]);
    let found = by_file("image,target,x,y", "0001.png,left,1,2\n0001.png,right,3,4\n", None).unwrap().points;
    assert_eq!(found.iter().map(|one| one.unwrap().position.x).collect::<Vec<_>>(), [1.0, 3.0]);
}

#[test]
fn files_that_are_no_answer_say_why() {
    for (rows, asked, expected) in [
        ("0001.png,4,1,2\n", Some(3), "measured.csv:2, column `target`: expected one of 1 to 3 as in points.csv, found `4`"),
        ("0001.png,0,1,2\n", Some(3), "found `0`"),
        ("left.png,1,1,2\n", Some(3), "measured.csv:2, column `image`: expected `0001.png`, found `left.png`"),
        ("0001.png,1,1,2\n0001.png,1,1,2\n", Some(3), "measured.csv:3: target `1` of image `0001.png` is already on line 2"),
        ("0001.png,1,1\n", Some(3), "measured.csv:2: expected 4 cells"),
        ("0001.png,1,inf,1\n", Some(3), "column `x`: expected a finite number"),
        ("0001.png,a,1,1\n0001.png,b,1,1\n0001.png,c,1,1\n", None, "3 rows; expected 2 at most"),
    ] {
        let fault = by_file("image,target,x,y", rows, asked).unwrap_err();
        assert_eq!(fault.rejection, Rejection::Malformed);
        assert!(fault.message.contains(expected), "{rows}: {}", fault.message);
    }
    let both = by_file("image,target,x,y,status", "0001.png,1,1,2,measured\n0001.png,1,,,rejected\n", Some(1)).unwrap_err();
    assert!(both.message.contains("has a position beside"), "{}", both.message);
}
