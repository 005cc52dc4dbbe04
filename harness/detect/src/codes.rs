//! Ring codes.

use calibench_model::Image;
use calibench_model::boards::{Layout, Rings, ring_codes};

use crate::arrange::{self, Mark, arrange};
use crate::corners::found;
use crate::plane::{Homography, Linear, Point, length, minus};
use crate::round::{Round, rounds};
use crate::sectors::{Code, Reader};
use crate::{Doubt, Found, NotFound};

/// So many codes that agree with each other are the board's, whatever else looks like a code.
const LEAST: usize = 4;

/// How many times as long as wide a disc is seen at most.
const ELONGATED: f64 = 2.3;

/// A code of the board.
struct Coded {
    mark: Mark,
    /// Its map, one of several where it may be turned.
    linear: Linear,
    /// An index into the layout's points.
    index: usize,
}

/// What codes there are, of the board and of others.
struct Seen {
    coded: Vec<Coded>,
    foreign: Vec<u32>,
}

impl Seen {
    fn all(&self) -> usize {
        self.coded.len() + self.foreign.len()
    }
}

/// The ring codes of a field; a part is enough.
pub(crate) fn detect(image: &Image, rings: &Rings, layout: &Layout) -> Result<Found, NotFound> {
    let rounds = rounds(image);
    let codes = ring_codes(rings.bits, rings.even);
    let reader = Reader { image, bits: rings.bits, ring: rings.ring, mirrored: false };
    let seen = read(&reader, &rounds, &codes, rings, layout);
    let arranged = arrange(&marks(&seen), rings.diameter);
    let kept = arranged.as_ref().map_or(0, |arranged| arranged.kept.len());
    let sure = kept >= LEAST || (kept >= layout.points.len().min(2) && 2 * kept >= seen.all());
    if !sure || 5 * kept < 4 * seen.coded.len() {
        // Of several fields no more agree with each other than with those of another one.
        let together = if let Err(NotFound::OtherArrangement { together, .. }) = &arranged { *together } else { kept };
        mirrored(&reader, &rounds, &codes, rings, layout, together)?;
    }
    let none = NotFound::NoCode { round: rounds.len(), codes: seen.all(), bits: rings.bits };
    let arranged = match arranged {
        Ok(arranged) if sure => arranged,
        // What agrees with nothing is no code but looks like one.
        Ok(_) | Err(NotFound::OtherArrangement { together: ..2, .. }) => return Err(none),
        Err(error) => return Err(error),
    };
    let mut doubts: Vec<Doubt> = arranged.strays.iter().map(|index| Doubt::Stray { id: seen.coded[*index].mark.id }).collect();
    doubts.extend(seen.foreign.iter().map(|id| Doubt::Foreign { id: *id }));
    let mut found = located(arranged.kept.iter().map(|index| &seen.coded[*index]).collect(), rings, layout);
    doubts.append(&mut found.doubts);
    Ok(Found { doubts, ..found })
}

/// The codes of each of several fields that are alike, if there are several; the largest first, with what is in doubt of all of them.
pub(crate) fn detect_all(image: &Image, rings: &Rings, layout: &Layout) -> Option<Vec<Found>> {
    let rounds = rounds(image);
    let codes = ring_codes(rings.bits, rings.even);
    let seen = read(&Reader { image, bits: rings.bits, ring: rings.ring, mirrored: false }, &rounds, &codes, rings, layout);
    let mut fields = arrange::boards(&marks(&seen), rings.diameter);
    fields.retain(|own| own.len() >= LEAST);
    if fields.len() < 2 {
        return None;
    }
    let is_free = |index: &usize| !fields.iter().any(|own| own.contains(index));
    let mut doubts: Vec<Doubt> =
        (0..seen.coded.len()).filter(is_free).map(|index| Doubt::Stray { id: seen.coded[index].mark.id }).collect();
    doubts.extend(seen.foreign.iter().map(|id| Doubt::Foreign { id: *id }));
    let of_field = |own: &Vec<usize>| located(own.iter().map(|index| &seen.coded[*index]).collect(), rings, layout);
    let mut all: Vec<Found> = fields.iter().map(of_field).collect();
    all[0].doubts.extend(doubts);
    Some(all)
}

/// The points of codes that stand as the field has them, those that are seen twice left out and in doubt.
fn located(mut kept: Vec<&Coded>, rings: &Rings, layout: &Layout) -> Found {
    kept.sort_by_key(|coded| coded.index);
    let twice: Vec<usize> = kept.windows(2).filter(|pair| pair[0].index == pair[1].index).map(|pair| pair[0].index).collect();
    kept.retain(|coded| !twice.contains(&coded.index));
    let doubts = twice.iter().map(|index| Doubt::Twice { id: (rings.first + index) as u32 }).collect();
    let pairs: Vec<(Point, Point)> = kept.iter().map(|coded| (coded.mark.plate, coded.mark.at)).collect();
    let map = Homography::fitted(&pairs).filter(|_| spans(&pairs));
    let point = |coded: &&Coded| {
        let linear = map.map_or(coded.linear, |map| map.linear(coded.mark.plate));
        found(coded.index, &layout.points[coded.index], coded.mark.at, linear)
    };
    Found { points: kept.iter().map(point).collect(), markers: kept.len(), doubts, light: false }
}

/// Whether places on the board determine a homography well: at least two rows and columns, and more than four.
fn spans(pairs: &[(Point, Point)]) -> bool {
    let differ = |axis: usize| pairs.iter().filter(|pair| pair.0[axis] != pairs[0].0[axis]).count() > 1;
    pairs.len() > 4 && differ(0) && differ(1)
}

fn marks(seen: &Seen) -> Vec<Mark> {
    seen.coded.iter().map(|coded| coded.mark).collect()
}

/// Whether more of the codes are the board's when read in a mirror.
fn mirrored(reader: &Reader, rounds: &[Round], codes: &[u32], rings: &Rings, layout: &Layout, kept: usize) -> Result<(), NotFound> {
    let rounds: Vec<Round> = rounds.iter().map(Round::mirrored).collect();
    let seen = read(&Reader { mirrored: true, ..*reader }, &rounds, codes, rings, layout);
    let markers = arrange(&marks(&seen), rings.diameter).map_or(0, |arranged| arranged.kept.len());
    if markers > kept.max(1) { Err(NotFound::Mirrored { markers }) } else { Ok(()) }
}

fn read(reader: &Reader, rounds: &[Round], codes: &[u32], rings: &Rings, layout: &Layout) -> Seen {
    let mut seen = Seen { coded: Vec::new(), foreign: Vec::new() };
    for (round, code, linear) in discs(reader, rounds, rings) {
        let Ok(place) = codes.binary_search(&code.least) else { continue };
        let id = place + 1;
        let Some(index) = id.checked_sub(rings.first).filter(|index| *index < layout.points.len()) else {
            seen.foreign.push(id as u32);
            continue;
        };
        let mark = Mark { id: id as u32, plate: layout.points[index].at, at: round.at, linear: (!code.turnable).then_some(linear) };
        seen.coded.push(Coded { mark, linear, index });
    }
    seen.foreign.sort_unstable();
    seen.foreign.dedup();
    seen
}

/// The discs with a ring of sectors, their codes and maps, but for sectors of others: from a sector the disc looks like one, and it is the rounder.
fn discs<'a>(reader: &Reader, rounds: &'a [Round], rings: &Rings) -> Vec<(&'a Round, Code, Linear)> {
    let reads = rounds.iter().filter(|round| round.elongation() < ELONGATED).filter_map(|round| Some((round, reader.read(round)?)));
    let all: Vec<(&Round, Code, Linear)> = reads.map(|(round, code)| (round, code, linear(round, &code, 0.5 * rings.diameter))).collect();
    let reach = 0.5 * rings.ring[1] * rings.diameter;
    let within =
        |at: Point, (round, _, linear): &(&Round, Code, Linear)| linear.back(minus(at, round.at)).is_some_and(|off| length(off) < reach);
    let part = |own: &Round| all.iter().any(|other| other.0.unlike() < own.unlike() && within(own.at, other));
    all.iter().filter(|(round, ..)| !part(round)).copied().collect()
}

/// The map from the board to the image that a disc of this radius and the beginning of its code tell.
fn linear(round: &Round, code: &Code, radius: f64) -> Linear {
    let (sine, cosine) = code.start.sin_cos();
    let [x, y] = round.axes();
    let column = |turned: Point| [x, y].map(|row| (row[0] * turned[0] + row[1] * turned[1]) / radius);
    let (u, v) = (column([-sine, cosine]), column([cosine, sine]));
    Linear([[u[0], v[0]], [u[1], v[1]]])
}
