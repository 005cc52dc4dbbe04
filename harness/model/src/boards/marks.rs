//! Circles unlike the others of their grid: an origin.

use std::fmt;

/// So many may be unlike the others,
const MOST: usize = 8;
/// in so many ways.
const FORMS: usize = 3;

/// What is at a place of a grid of circles in place of its circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A disc of this diameter, object units.
    Disc(f64),
    /// A ring of these diameters, outside and inside, object units.
    Ring(f64, f64),
    /// No circle, and no point of the board: nothing, or a sign of another shape.
    Gap,
}

/// A circle unlike the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Its column and row, from 0 at the upper left.
    pub place: [usize; 2],
    /// What is there.
    pub form: Form,
}

/// The circles of a grid that are unlike the others, at most eight of at most three forms. They tell which circle is which, however the grid is turned, and which part is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Marks {
    forms: [Option<Form>; FORMS],
    /// Columns and rows, from 0 at the upper left, and the places of the forms: a board is copied as it is passed on.
    places: [Option<[u8; 3]>; MOST],
}

impl Marks {
    /// These; `None` if they or their forms are too many, or one is beyond the 256th row or column.
    pub fn new(marks: &[Mark]) -> Option<Self> {
        let mut all = Self::default();
        for (own, Mark { place: [column, row], form }) in all.places.get_mut(..marks.len())?.iter_mut().zip(marks) {
            let known = all.forms.iter().position(|other| *other == Some(*form) || other.is_none())?;
            all.forms[known] = Some(*form);
            *own = Some([u8::try_from(*column).ok()?, u8::try_from(*row).ok()?, known as u8]);
        }
        Some(all)
    }

    /// The marks, in the order that they were given in.
    pub fn iter(&self) -> impl Iterator<Item = Mark> + '_ {
        let mark = |[column, row, form]: [u8; 3]| Some(Mark { place: [column.into(), row.into()], form: self.forms[usize::from(form)]? });
        self.places.iter().flatten().copied().filter_map(mark)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.places[0].is_none()
    }

    /// What is at a place, if it is unlike the others.
    pub fn at(&self, place: [usize; 2]) -> Option<Form> {
        self.iter().find(|mark| mark.place == place).map(|mark| mark.form)
    }

    /// Reads `FORM@POINT,...`: `20@r1c1` a disc, `20/10@r1c1` a ring, `gap@r1c1` no circle.
    ///
    /// # Errors
    /// What is not understood.
    pub fn read(parts: &[&str]) -> Result<Self, String> {
        let mut marks = Vec::new();
        for part in parts {
            let (form, points) = part.split_once('@').ok_or_else(|| format!("`{part}` is no mark FORM@POINT,..."))?;
            let form = form.parse()?;
            for point in points.split(',') {
                let place = place(point).ok_or_else(|| format!("`{point}` is no point of the grid, as in r1c1"))?;
                marks.push(Mark { place, form });
            }
        }
        Self::new(&marks).ok_or_else(|| format!("{} circles are unlike the others: expected at most {MOST}, of {FORMS} forms", marks.len()))
    }
}

/// Column and row of `r1c1`, from 0.
fn place(point: &str) -> Option<[usize; 2]> {
    let (row, column) = point.strip_prefix('r')?.split_once('c')?;
    let number = |text: &str| text.parse::<usize>().ok()?.checked_sub(1);
    Some([number(column)?, number(row)?])
}

impl std::str::FromStr for Form {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let length = |part: &str| part.parse::<f64>().map_err(|_| format!("`{text}` is no diameter, no ring as in 20/10, and not gap"));
        match (text, text.split_once('/')) {
            ("gap", _) => Ok(Self::Gap),
            (_, Some((outside, inside))) => Ok(Self::Ring(length(outside)?, length(inside)?)),
            _ => Ok(Self::Disc(length(text)?)),
        }
    }
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Disc(diameter) => write!(f, "{diameter}"),
            Self::Ring(outside, inside) => write!(f, "{outside}/{inside}"),
            Self::Gap => f.write_str("gap"),
        }
    }
}

/// As options write them: each form in turn with its points, `:` before each.
impl fmt::Display for Marks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut before = None;
        for Mark { place: [column, row], form } in self.iter() {
            if before == Some(form) {
                f.write_str(",")?;
            } else {
                write!(f, ":{form}@")?;
            }
            write!(f, "r{}c{}", row + 1, column + 1)?;
            before = Some(form);
        }
        Ok(())
    }
}
