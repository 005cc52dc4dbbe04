//! From an image to labelled positions.

use calibench_model::{Image, Testfield};

use crate::bank::Bank;
use crate::design::{Design, NotCoded};
use crate::error::NotRecognised;
use crate::found::Recognition;
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

    /// The field in `image`. Deterministic; whole squares only.
    ///
    /// # Errors
    /// An image that does not show the field, or not a whole square of it.
    pub fn recognise(&self, image: &Image) -> Result<Recognition, NotRecognised> {
        let (width, height) = (image.width(), image.height());
        if width.min(height) < LEAST {
            return Err(NotRecognised::TooSmall { width, height, least: LEAST });
        }
        if !image.grey().iter().all(|grey| grey.is_finite()) {
            return Err(NotRecognised::NotFinite);
        }
        let mut best: Option<Result<Recognition, NotRecognised>> = None;
        for factor in factors(image) {
            let level = Level::of(image, factor);
            if level.image.width().min(level.image.height()) < LEAST {
                continue;
            }
            let found = self.at(&level);
            let enough = found.as_ref().is_ok_and(|(_, square)| *square >= COARSE);
            let found = found.map(|(found, _)| found);
            // Of equals the one that was seen in more detail.
            if best.as_ref().is_none_or(|best| rank(&found) >= rank(best)) {
                best = Some(found);
            }
            if enough {
                break;
            }
        }
        best.unwrap_or(Err(NotRecognised::TooSmall { width, height, least: LEAST }))
    }
}

/// How much is known: more targets, then how far it came.
fn rank(found: &Result<Recognition, NotRecognised>) -> usize {
    match found {
        Ok(found) => 10 + found.squares.iter().filter(|square| square.place.is_some()).count() * 16 + found.targets.len(),
        Err(error) => error.stage(),
    }
}
