//! What a printer draws of a PDF: its content run through its own transformation, in points of 1/72 inch.

use super::*;

/// Corners of rectangles, ends of lines and curves, as they are painted on the page, in points.
fn painted(content: &str) -> Vec<[f64; 2]> {
    let (mut matrix, mut kept) = ([1.0, 0.0, 0.0, 1.0, 0.0, 0.0], Vec::new());
    let (mut numbers, mut found): (Vec<f64>, Vec<[f64; 2]>) = (Vec::new(), Vec::new());
    for word in content.split_whitespace() {
        if let Ok(number) = word.parse() {
            numbers.push(number);
            continue;
        }
        let at = |m: [f64; 6], x: f64, y: f64| [m[0] * x + m[2] * y + m[4], m[1] * x + m[3] * y + m[5]];
        match word {
            // PDF 32000-1, 8.3.4: the new matrix comes before the old one.
            "cm" => {
                let (m, n) = (matrix, &numbers);
                let [e, f] = at(m, n[4], n[5]);
                matrix = [n[0] * m[0] + n[1] * m[2], n[0] * m[1] + n[1] * m[3], n[2] * m[0] + n[3] * m[2], n[2] * m[1] + n[3] * m[3], e, f];
            }
            "q" => kept.push(matrix),
            "Q" => matrix = kept.pop().expect("a graphics state"),
            "re" => {
                let [x, y, width, height] = numbers[..] else { panic!("a rectangle of {numbers:?}") };
                found.extend([at(matrix, x, y), at(matrix, x + width, y + height)]);
            }
            "m" | "l" | "c" => found.push(at(matrix, numbers[numbers.len() - 2], numbers[numbers.len() - 1])),
            _ => {}
        }
        numbers.clear();
    }
    found
}

/// The page sizes of a document, in points.
fn media_boxes(bytes: &[u8]) -> Vec<Vec<f64>> {
    let text = String::from_utf8_lossy(bytes).into_owned();
    let boxes = text.split("/MediaBox [").skip(1).map(|rest| rest.split(']').next().unwrap().to_owned());
    boxes.map(|numbers| numbers.split_whitespace().map(|n| n.parse().unwrap()).collect()).collect()
}

fn holds(points: &[[f64; 2]], wanted: [f64; 2]) -> bool {
    points.iter().any(|point| near(*point, wanted, 1e-5))
}

/// Numbers from a pocket calculator, 1 mm = 2.834645669 points: the page is 320 x 234 mm, the plate's (0, 0) lies at 20 and 44 mm on it.
#[test]
fn a_pdf_measures_what_the_plate_measures() {
    let field = field();
    let bytes = pdf(&sheets(&field, &options(Paper::Whole)).unwrap()).unwrap();
    let boxes = media_boxes(&bytes);
    assert_eq!(boxes.len(), 1);
    for (found, expected) in boxes[0].iter().zip([0.0, 0.0, 907.086_614, 663.307_087]) {
        assert!((found - expected).abs() < 1e-3, "{found} is not {expected} points");
    }
    let points = painted(&contents(&bytes)[0]);
    assert!(holds(&points, [28.346_456_7, 28.346_456_7]), "the left end of the scale bar");
    assert!(holds(&points, [28.346_456_7 + 283.464_566_9, 28.346_456_7 + 4.251_968_5]), "its right end, 100 mm further");
    // The square from (10, 10) to (70, 70) and the triangle's corner at (130, 160) on the plate.
    for wanted in [[85.039_370_1, 153.070_866_1], [255.118_110_2, 323.149_606_3], [425.196_850_4, 578.267_716_5]] {
        assert!(holds(&points, wanted), "nothing at {wanted:?}");
    }
    // The sheet itself: 300 x 200 mm.
    assert!(holds(&points, [28.346_456_7, 68.031_496_1]) && holds(&points, [878.740_157_5, 634.960_629_9]));
}

#[test]
fn a_pdf_in_metres_on_a4_is_a4() {
    let mut field = field();
    field.plates[0].corners = [[0.0, 0.0], [0.1, 0.05]];
    field.plates[0].areas.truncate(1);
    field.plates[0].areas[0].outline = Outline::rectangle([0.01, 0.01], [0.03, 0.02]);
    let options = PrintOptions { mm_per_unit: 1000.0, ..options(Paper::A4) };
    let bytes = pdf(&sheets(&field, &options).unwrap()).unwrap();
    let boxes = media_boxes(&bytes);
    assert!((boxes[0][2] - 595.275_591).abs() < 1e-3 && (boxes[0][3] - 841.889_764).abs() < 1e-3, "{boxes:?}");
    let points = painted(&contents(&bytes)[0]);
    // The plate's lower left corner is at 10 and 237 mm; the rectangle begins 10 mm from it and is 20 x 10 mm large.
    assert!(holds(&points, [56.692_913_4, 700.157_480_3]) && holds(&points, [113.385_826_8, 728.503_937]), "{points:?}");
}
