//! Why markers that were read are not the board's.

use calibench_model::Image;
use calibench_model::boards::Dictionary;

use crate::NotFound;
use crate::arrange::Arranged;
use crate::cells::{Form, Sight};
use crate::markers::{Markers, Seen, arranged, frames, identified};
use crate::plane::Point;

/// A single marker is believed among so many frames, itself with them.
const ALONE: usize = 3;

/// Which of the markers to keep; or, where they are not the board's or most frames are no markers of it, what else they are.
///
/// # Errors
/// Every reason that a board with markers is not found, but for its corners.
pub(crate) fn checked(
    image: &Image,
    quadrangles: &[[Point; 4]],
    sights: &[Sight],
    seen: &[Seen],
    foreign: &[u32],
    of: &Markers,
) -> Result<Arranged, NotFound> {
    let found = arranged(seen, of);
    let kept = found.as_ref().map_or(0, |found| found.kept.len());
    // A single one is believed only without a fault, and not among many frames of something else.
    let sure = kept > 1 || (sights.len() <= ALONE && seen.iter().any(|marker| marker.wrong == 0));
    if kept > 0 && sure && 2 * kept >= sights.len() {
        return found;
    }
    mirrored(sights, kept, of)?;
    if foreign.len() > seen.len() {
        return Err(other_ids(foreign, of));
    }
    others(image, quadrangles, seen.len() + foreign.len(), of)?;
    match found {
        Ok(found) if kept > 0 && sure => Ok(found),
        Err(error) => Err(error),
        Ok(_) => Err(NotFound::NoMarker { dictionary: of.dictionary.name, frames: sights.len() }),
    }
}

/// Whether more of the frames are the board's when read in a mirror.
fn mirrored(sights: &[Sight], kept: usize, of: &Markers) -> Result<(), NotFound> {
    let there: Vec<Sight> = sights.iter().map(|sight| sight.mirrored(of.form.side)).collect();
    let (seen, _) = identified(&there, of);
    let markers = arranged(&seen, of).map_or(0, |found| found.kept.len());
    let sure = markers > 1 || seen.iter().any(|marker| marker.wrong == 0);
    if markers > kept && sure { Err(NotFound::Mirrored { markers }) } else { Ok(()) }
}

fn other_ids(seen: &[u32], of: &Markers) -> NotFound {
    let ids = || of.layout.markers.iter().map(|marker| marker.id);
    let (first, last) = (ids().min().unwrap_or(0), ids().max().unwrap_or(0));
    NotFound::OtherIds { dictionary: of.dictionary.name, seen: seen.to_vec(), first, last, instead: None }
}

/// Whether more of the quadrangles are markers of another dictionary, or have other frames.
fn others(image: &Image, quadrangles: &[[Point; 4]], fitting: usize, of: &Markers) -> Result<(), NotFound> {
    let forms: Vec<(Form, Vec<Sight>)> =
        (4..=7).flat_map(|side| [1, 2].map(|border| Form { side, border })).map(|form| (form, frames(image, quadrangles, form))).collect();
    let mut best = (2 * fitting + 1, None);
    // The board's own first: a smaller dictionary may hold the same markers.
    for dictionary in std::iter::once(of.dictionary).chain(Dictionary::names().filter_map(Dictionary::named)) {
        for (form, sights) in forms.iter().filter(|(form, _)| form.side == dictionary.side) {
            let seen = sights.iter().filter(|sight| dictionary.identify(sight.cells, 0).is_some()).count();
            if seen > best.0 {
                best = (seen, Some((dictionary, *form)));
            }
        }
    }
    let (seen, Some((dictionary, form))) = best else { return Ok(()) };
    if dictionary.name == of.dictionary.name {
        return Err(NotFound::OtherFrames { dictionary: dictionary.name, seen, border: form.border, expected: of.form.border });
    }
    Err(NotFound::OtherDictionary { other: dictionary.name, seen, dictionary: of.dictionary.name, fitting })
}
