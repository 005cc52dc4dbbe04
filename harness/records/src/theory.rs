//! What theory says of an operator on an image without noise: strengths around each target, and the precision that follows from them. A tidy CSV beside
//! the records of the points.

use std::io::{self, Read, Write};

use calibench_model::PixelPoint;

use crate::cells::{Cells, RecordError, open};
use crate::points::RunInfo;

/// The file's name in a scenario's folder.
pub const THEORY: &str = "theory.csv";

/// The columns of the file.
pub const COLUMNS: [&str; 9] = ["scenario", "method", "target", "figure", "x", "y", "value", "unit", "revision"];

/// Half the side of the square of strengths, px.
pub const HALF: usize = 3;
/// The side of the square of strengths, px.
pub const SIDE: usize = 2 * HALF + 1;

/// What theory says of one method at one target.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Theory {
    /// The label of the method.
    pub method: String,
    /// The target.
    pub target: String,
    /// The strengths around the strongest pixel, where the image reaches far enough.
    pub strengths: Option<Strengths>,
    /// Theoretical standard deviation `sqrt(sigma_x^2 + sigma_y^2)` of the position, px per unit of the standard deviation of the grey values
    /// (fractions of full scale), by form of propagation.
    pub sigmas: Option<Sigmas>,
}

/// Harris strengths, grey values as fractions of full scale, to the fourth power per px^4; scale-adapted ones to the fourth power alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Strengths {
    /// The strongest pixel, column and row.
    pub pixel: (i64, i64),
    /// Row by row, the strongest pixel in the middle.
    pub values: [[f64; SIDE]; SIDE],
    /// The maximum of the paraboloid through the strongest nine, if it has one.
    pub maximum: Option<PixelPoint>,
}

/// Standard deviations by form of propagation, px per unit of the grey values' standard deviation, as in [`Theory::sigmas`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sigmas {
    /// The six samples of the paper's equation as it is printed.
    pub printed: f64,
    /// The same with its misprints corrected.
    pub corrected: f64,
    /// The solution of nine samples that the method delivers.
    pub nine: f64,
    /// The same, samples taken as uncorrelated and of equal variance.
    pub uncorrelated: f64,
}

const STRENGTH: &str = "strength";
const MAXIMUM: &str = "maximum";
const SIGMAS: [&str; 4] = ["sigma_printed", "sigma_corrected", "sigma_nine", "sigma_uncorrelated"];

/// Writes what theory says, every number to its last bit.
///
/// # Errors
/// What the output refuses.
pub fn write(output: impl Write, run: &RunInfo, all: &[Theory]) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(output);
    csv.write_record(COLUMNS)?;
    for theory in all {
        for (figure, at, value, unit) in rows(theory) {
            let [x, y] = at.map_or([String::new(), String::new()], |at| at.map(|v| v.to_string()));
            let value = value.map_or(String::new(), |value| value.to_string());
            let cells = [&run.scenario, &theory.method, &theory.target, figure, &x, &y, &value, unit, &run.revision];
            csv.write_record(cells.map(AsRef::<str>::as_ref))?;
        }
    }
    csv.flush()
}

/// Figure, place (px), value and its unit.
type Row = (&'static str, Option<[f64; 2]>, Option<f64>, &'static str);

fn rows(theory: &Theory) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    if let Some(Strengths { pixel: (x, y), values, maximum }) = &theory.strengths {
        let corner = [x - HALF as i64, y - HALF as i64];
        for (row, column) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column))) {
            let at = [(corner[0] + column as i64) as f64, (corner[1] + row as i64) as f64];
            rows.push((STRENGTH, Some(at), Some(values[row][column]), "px^-4"));
        }
        rows.extend(maximum.map(|at| (MAXIMUM, Some([at.x, at.y]), None, "px")));
    }
    if let Some(Sigmas { printed, corrected, nine, uncorrelated }) = theory.sigmas {
        let values = [printed, corrected, nine, uncorrelated];
        rows.extend(SIGMAS.into_iter().zip(values).map(|(name, value)| (name, None, Some(value), "px")));
    }
    rows
}

/// Reads what [`write()`] wrote.
///
/// # Errors
/// A file of another form.
pub fn read(input: impl Read) -> Result<Vec<Theory>, RecordError> {
    let mut all: Vec<Gathered> = Vec::new();
    for record in open(input, &COLUMNS)?.records() {
        let record = record?;
        let cells = Cells { record: &record, columns: &COLUMNS };
        let (method, target) = (cells.text(1), cells.text(2));
        if all.last().is_none_or(|last| last.method != method || last.target != target) {
            all.push(Gathered { method: method.to_owned(), target: target.to_owned(), ..Gathered::default() });
        }
        if let Some(last) = all.last_mut() {
            last.add(&cells)?;
        }
    }
    Ok(all.into_iter().map(Gathered::theory).collect())
}

/// The rows of one method at one target.
#[derive(Default)]
struct Gathered {
    method: String,
    target: String,
    strengths: Vec<(f64, f64, f64)>,
    maximum: Option<PixelPoint>,
    sigmas: [Option<f64>; 4],
}

impl Gathered {
    fn add(&mut self, cells: &Cells<'_>) -> Result<(), RecordError> {
        match cells.text(3) {
            STRENGTH => self.strengths.push((cells.parse(4)?, cells.parse(5)?, cells.parse(6)?)),
            MAXIMUM => self.maximum = Some(PixelPoint::new(cells.parse(4)?, cells.parse(5)?)),
            name => {
                let place = SIGMAS.iter().position(|known| *known == name).ok_or_else(|| cells.bad(3))?;
                self.sigmas[place] = Some(cells.parse(6)?);
            }
        }
        Ok(())
    }

    fn theory(self) -> Theory {
        let strengths = (self.strengths.len() == SIDE * SIDE).then(|| {
            let (x, y, _) = self.strengths[SIDE * HALF + HALF];
            let values = std::array::from_fn(|row| std::array::from_fn(|column| self.strengths[SIDE * row + column].2));
            Strengths { pixel: (x as i64, y as i64), values, maximum: self.maximum }
        });
        let sigmas = match self.sigmas {
            [Some(printed), Some(corrected), Some(nine), Some(uncorrelated)] => Some(Sigmas { printed, corrected, nine, uncorrelated }),
            _ => None,
        };
        Theory { method: self.method, target: self.target, strengths, sigmas }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let values = std::array::from_fn(|row| std::array::from_fn(|column| 1.0 / (1 + row * SIDE + column) as f64));
        let sigmas = Sigmas { printed: 0.1 + 0.2, corrected: 1e-17, nine: 3.0, uncorrelated: 4.0 };
        let strengths = |maximum| Some(Strengths { pixel: (40, 7), values, maximum });
        let of = |target: &str, strengths, sigmas| Theory { method: "m:a=1,b=2".into(), target: target.into(), strengths, sigmas };
        let all = vec![
            of("a", strengths(Some(PixelPoint::new(40.25, 1.0 / 3.0))), Some(sigmas)),
            of("b", strengths(None), None),
            of("c", None, Some(sigmas)),
        ];
        let run = RunInfo { scenario: "f/s".into(), seed: 7, revision: "r".into(), detector: None };
        let mut bytes = Vec::new();
        write(&mut bytes, &run, &all).unwrap();
        assert_eq!(read(&bytes[..]).unwrap(), all);
        let odd = format!("{}\nf/s,m,a,nonsense,,,1,px,r\n", COLUMNS.join(","));
        assert!(read(odd.as_bytes()).unwrap_err().to_string().contains("line 2: column `figure` holds `nonsense`"));
    }

    /// Strengths of a square of seven pixels around column 40 and row 7: the first is that of column 37 and row 4.
    #[test]
    fn each_strength_stands_beside_its_pixel() {
        let values = std::array::from_fn(|row| std::array::from_fn(|column| (10 * row + column) as f64));
        let strengths = Some(Strengths { pixel: (40, 7), values, maximum: None });
        let mut bytes = Vec::new();
        let theory = Theory { method: "m".into(), target: "t".into(), strengths, sigmas: None };
        write(&mut bytes, &RunInfo { scenario: "f/s".into(), ..RunInfo::default() }, &[theory]).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text.lines().count(), 50);
        for line in ["f/s,m,t,strength,37,4,0,px^-4,", "f/s,m,t,strength,40,7,33,px^-4,", "f/s,m,t,strength,43,5,16,px^-4,"] {
            assert!(text.lines().any(|found| found == line), "{line}\n{text}");
        }
    }

    #[test]
    fn methods_and_targets_are_told_apart() {
        let sigmas = |printed| Some(Sigmas { printed, corrected: 1.0, nine: 2.0, uncorrelated: 3.0 });
        let of = |method: &str, target: &str, printed| Theory {
            method: method.into(),
            target: target.into(),
            strengths: None,
            sigmas: sigmas(printed),
        };
        let all = vec![of("m", "a", 4.0), of("m", "b", 5.0), of("n", "b", 6.0), of("n", "a", 7.0)];
        let mut bytes = Vec::new();
        write(&mut bytes, &RunInfo::default(), &all).unwrap();
        assert_eq!(read(&bytes[..]).unwrap(), all);
        // One of four standard deviations is missing: none is taken.
        let cut: String = String::from_utf8(bytes).unwrap().lines().take(4).map(|line| format!("{line}\n")).collect();
        assert_eq!(read(cut.as_bytes()).unwrap(), [Theory { sigmas: None, ..of("m", "a", 4.0) }]);
    }
}
