use calibench_model::PointRow;

use super::*;
use proptest::prelude::*;

fn parse(text: &str) -> Result<Vec<PointRow>, PointFileError> {
    parse_points("p.csv", text.as_bytes()).map(|file| file.points.rows().map(PointRow::from).collect())
}

fn error(text: &str) -> String {
    parse(text).unwrap_err().to_string()
}

#[test]
fn four_columns_are_enough_and_order_does_not_matter() {
    let rows = parse("target,y,x,image\nA,2.5,1.5,left.jpg\n").unwrap();
    assert_eq!(rows.len(), 1);
    assert_eq!((rows[0].image.as_str(), rows[0].target.as_str()), ("left.jpg", "A"));
    assert_eq!(rows[0].start, Start::at(PixelPoint::new(1.5, 2.5)));
    assert_eq!(rows[0].start.covariance, None);
}

#[test]
fn optional_groups_are_read_or_left_empty() {
    let header = "image,target,x,y,sxx,sxy,syy,kind,axx,axy,ayx,ayy\n";
    let rows = parse(&format!("{header}i,1,1,2,.1,0,.2,chess_corner,20,1,-1,19\ni,2,1,2,,,,,,,,\n")).unwrap();
    assert_eq!(rows[0].start.covariance, Some(Covariance { sxx: 0.1, sxy: 0.0, syy: 0.2 }));
    assert_eq!(rows[0].start.kind, Some(TargetKind::ChessCorner));
    assert_eq!(rows[0].start.affine, Some(Affine { axx: 20.0, axy: 1.0, ayx: -1.0, ayy: 19.0 }));
    assert_eq!((rows[1].start.covariance, rows[1].start.kind, rows[1].start.affine), (None, None, None));
}

#[test]
fn mistakes_name_line_and_column() {
    for (text, expected) in [
        ("image,target,x\ni,1,2\n", "p.csv:1, column `y`: missing"),
        ("image,target,x,y,sxx\ni,1,2,3,4\n", "p.csv:1, column `sxy`: missing in the header; these go together"),
        ("image,target,x,y,z\ni,1,2,3,4\n", "p.csv:1, column `z`: unknown"),
        ("image,target,x,y,x\ni,1,2,3,4\n", "p.csv:1, column `x`: stands in the header twice"),
        ("image,target,x,y\ni,1,2\n", "p.csv:2: expected 4 cells as in the header, found 3"),
        ("image,target,x,y\n\ni,1,2,NaN\n", "p.csv:3, column `y`: expected a finite number"),
        ("image,target,x,y\ni,1,\"2,5\",3\n", "p.csv:2, column `x`: expected a finite number with a decimal point, found `2,5`"),
        ("image,target,x,y\ni,1,,3\n", "p.csv:2, column `x`: is empty"),
        ("image,target,x,y\ni,,2,3\n", "p.csv:2, column `target`: is empty"),
        ("image,target,x,y\ni,1,2,3\ni,1,2,3\n", "p.csv:3: target `1` of image `i` is already on line 2"),
        ("image,target,x,y\n", "p.csv: holds no point"),
        ("image,target,x,y,kind\ni,1,2,3,chess\n", "p.csv:2, column `kind`: no kind of target is called `chess`"),
        ("image,target,x,y,sxx,sxy,syy\ni,1,2,3,1,2,1\n", "p.csv:2, column `sxx`: no covariance"),
        ("image,target,x,y,sxx,sxy,syy\ni,1,2,3,1,,1\n", "p.csv:2, column `sxy`: is empty"),
    ] {
        let found = error(text);
        assert!(found.starts_with(expected), "expected: {expected}\n   found: {found}");
    }
    assert!(parse_points("p.csv", &b"image,target,x,y\n\xff\xfe,1,2,3\n"[..]).unwrap_err().to_string().contains("UTF-8"));
    assert!(error("").contains("missing in the header"));
}

#[test]
fn rows_without_a_position_are_counted_and_left_out() {
    let text = "image,target,x,y,method,status,reason\ni,1,2,3,m,measured,\ni,2,,,m,rejected,border\ni,3,,,m,unavailable,no\n";
    let file = parse_points("p.csv", text.as_bytes()).unwrap();
    assert_eq!((file.points.len(), file.lost.len()), (1, 2));
    assert_eq!(file.lost.iter().next(), Some(["i", "2", "rejected", "border"]));
    let twice = error("image,target,x,y,method,status,reason\ni,1,2,3,m,measured,\ni,1,2,3,n,measured,\n");
    assert!(twice.contains("keep those of one"), "{twice}");
}

#[test]
fn the_truth_of_an_image_is_a_point_file() {
    let header = "image,target,kind,x,y,visibility,axx,axy,ayx,ayy,ellipse_x,X,Y,Z,warning\n";
    let text = format!(
        "{header}a.png,1,disc,2.5,3,visible,9,0,0,9,2.6,1,2,3,\na.png,2,disc,,,hidden,,,,,,1,2,3,\na.png,3,disc,4,5,outside,9,0,0,9,,1,2,3,\n"
    );
    let file = parse_points("truth.csv", text.as_bytes()).unwrap();
    assert_eq!((file.points.len(), file.points.row(0).start.kind), (1, Some(TargetKind::Disc)));
    let lost: Vec<_> = file.lost.iter().collect();
    assert_eq!(lost, [["a.png", "2", "unavailable", "hidden"], ["a.png", "3", "unavailable", "outside"]]);
    let unknown = error(&text.replace("visible", "hiden"));
    assert!(unknown.contains(":2, column `visibility`: found `hiden`; expected visible, clipped, hidden, outside"), "{unknown}");
    // Without a visibility it is no truth, and what X is meant for is not known.
    assert!(error("image,target,x,y,X\ni,1,2,3,4\n").contains("column `X`: unknown"));
    // A point given twice is on its own line, whatever was left out above.
    let again = text.replace("a.png,3,disc,4,5,outside", "a.png,1,disc,4,5,visible");
    assert!(error(&again).contains(":4"), "{}", error(&again));
}

#[test]
fn the_columns_are_those_that_are_documented() {
    assert_eq!(KNOWN.to_vec(), [&REQUIRED[..], &COVARIANCE, &SHAPE, &RESULT, &["visibility"]].concat());
}

#[test]
fn names_are_read_as_they_were_before_they_were_made_safe() {
    let rows = parse("image,target,x,y\n'=i,'-a,1,2\n'a,-1,1,2\n").unwrap();
    let names: Vec<[&str; 2]> = rows.iter().map(|row| [row.image.as_str(), row.target.as_str()]).collect();
    assert_eq!(names, [["=i", "-a"], ["'a", "-1"]]);
    assert_eq!(error("image,target,x,y\n\u{1b}[2J,a,1,2\n\u{1b}[2J,a,1,2\n").matches("\\u{1b}[2J").count(), 1);
}

#[test]
fn a_point_that_stands_twice_is_named_with_both_lines() {
    let text = "image,target,x,y,status\ni,1,1,2,measured\n\ni,2,,,rejected\ni,3,1,2,\ni,4,1,2,\ni,3,5,6,\n";
    assert!(error(text).starts_with("p.csv:7: target `3` of image `i` is already on line 5; expected each once"), "{}", error(text));
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(text in "\\PC*") {
        let _ = parse(&text);
        let _ = parse(&format!("image,target,x,y\n{text}"));
    }
}

#[test]
fn a_reader_may_ask_more_of_a_row_and_is_told_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.csv");
    std::fs::write(&path, "target,y,x,image\n1,2,3,i\n\n2,9,3,i\n").unwrap();
    let below = |row: &PointRef<'_>| if row.start.position.y < 5.0 { Ok(()) } else { Err(("y", "too low".to_owned())) };
    let error = read_points_checked(&path, &below).unwrap_err();
    assert_eq!((error.line, error.column.as_deref(), error.problem.as_str()), (Some(4), Some("y"), "too low"));
}
