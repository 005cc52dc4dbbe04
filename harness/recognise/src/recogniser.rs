//! From an image to labelled positions.

use calibench_model::testfield::PlatePoint;
use calibench_model::{Image, Testfield};

use crate::bank::Bank;
use crate::design::{Design, NotCoded};
use crate::error::NotRecognised;
use crate::found::Recognition;
use crate::ground::Ground;
use crate::identify::Places;
use crate::level::{Level, factors};
use crate::table::ContourTable;

/// The shortest side of an image that may hold a square, px.
const LEAST: usize = 32;
/// Squares smaller than this, px, are looked at in more detail if there is more.
const COARSE: f64 = 45.0;

/// How shapes are told apart and squares identified.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Classifier {
    /// As in the paper: features of the contour, a table of likelihoods, the best of six decisions in each size group; squares by the code of their large
    /// pairs, numbers by topology. What the design has elsewhere is rejected.
    ///
    /// Source: Vosselman & Förstner 1988, section 3.3.
    Contours,
    /// Correlation with drawings under the blur of the grid's lines for the decisions; squares and targets by all places of the design at once, each target
    /// held against its drawing.
    #[default]
    Modern,
}

/// Recognises one coded field in images.
#[derive(Clone, Debug)]
pub struct Recogniser {
    pub(crate) design: Design,
    pub(crate) places: Vec<Places>,
    pub(crate) bank: Bank,
    pub(crate) classifier: Classifier,
    pub(crate) table: ContourTable,
}

impl Recogniser {
    /// A recogniser of `field`, from what is printed on it.
    ///
    /// # Errors
    /// A testfield that is not a coded one.
    pub fn new(field: &Testfield, classifier: Classifier) -> Result<Self, NotCoded> {
        let design = Design::of(field)?;
        let (places, bank) = (Places::of(&design), Bank::of(&design));
        Ok(Self { design, places, bank, classifier, table: ContourTable::learned() })
    }

    /// The same with another table of likelihoods of contours.
    #[must_use]
    pub fn with_table(self, table: ContourTable) -> Self {
        Self { table, ..self }
    }

    /// Where the middles of the grid's lines meet: (column, row) from the field's top left corner, counted from 0, and the place on the plate.
    pub fn nodes(&self) -> impl Iterator<Item = ([usize; 2], PlatePoint)> + '_ {
        let Design { squares, corner: [left, top], spacing, .. } = self.design;
        let node = move |column: usize, row: usize| ([column, row], [left + column as f64 * spacing, top - row as f64 * spacing]);
        (0..=squares).flat_map(move |row| (0..=squares).map(move |column| node(column, row)))
    }

    /// The field in `image`. Deterministic; whole squares only.
    ///
    /// # Errors
    /// An image that does not show the field, or not a whole square of it.
    pub fn recognise(&self, image: &Image) -> Result<Recognition, NotRecognised> {
        recognise_each(std::slice::from_ref(self), image).swap_remove(0)
    }
}

/// What each of several recognisers finds in `image`, in their order. The grid is looked for once for those of one design.
#[must_use]
pub fn recognise_each(recognisers: &[Recogniser], image: &Image) -> Vec<Result<Recognition, NotRecognised>> {
    let (width, height) = (image.width(), image.height());
    let too_small = NotRecognised::TooSmall { width, height, least: LEAST };
    if width.min(height) < LEAST {
        return recognisers.iter().map(|_| Err(too_small.clone())).collect();
    }
    if !image.grey().iter().all(|grey| grey.is_finite()) {
        return recognisers.iter().map(|_| Err(NotRecognised::NotFinite)).collect();
    }
    let mut kept: Vec<Kept<'_>> = recognisers.iter().map(|recogniser| Kept { recogniser, best: None, enough: false }).collect();
    for factor in factors(image) {
        let level = Level::of(image, factor);
        if level.image.width().min(level.image.height()) >= LEAST {
            look(&mut kept, &level);
        }
    }
    kept.into_iter().map(|kept| kept.best.unwrap_or_else(|| Err(too_small.clone()))).collect()
}

/// A recogniser and the best that it has found so far.
struct Kept<'a> {
    recogniser: &'a Recogniser,
    best: Option<Result<Recognition, NotRecognised>>,
    /// More detail is not asked for.
    enough: bool,
}

/// One look of all that have not seen enough.
fn look(kept: &mut [Kept<'_>], level: &Level<'_>) {
    let mut grounds: Vec<(&Design, Result<Ground<'_>, NotRecognised>)> = Vec::new();
    for kept in kept.iter_mut().filter(|kept| !kept.enough) {
        let design = &kept.recogniser.design;
        let known = grounds.iter().position(|(other, _)| *other == design);
        let place = known.unwrap_or_else(|| {
            grounds.push((design, kept.recogniser.ground(level.clone())));
            grounds.len() - 1
        });
        let found = grounds[place].1.as_ref().map_err(Clone::clone).and_then(|ground| kept.recogniser.on(ground));
        kept.enough = found.as_ref().is_ok_and(|(_, square)| *square >= COARSE);
        let found = found.map(|(found, _)| found);
        // Of equals the one that was seen in more detail.
        if kept.best.as_ref().is_none_or(|best| rank(&found) >= rank(best)) {
            kept.best = Some(found);
        }
    }
}

/// How much is known: more targets, then how far it came.
fn rank(found: &Result<Recognition, NotRecognised>) -> usize {
    match found {
        Ok(found) => 10 + found.squares.iter().filter(|square| square.place.is_some()).count() * 16 + found.targets.len(),
        Err(error) => error.stage(),
    }
}
