//! The corners of a board where the image has them: what is not seen there is looked for where the others have it, and left out where it is not there either.

use super::AROUND;
use super::board::Board;
use super::crossing::{Crossing, crossing};
use super::forecast::Forecast;
use super::level::{Pyramid, scaled};
use super::peak::saddle;
use super::refine::refined;
use super::sectors::{Steps, contrast};
use crate::plane::{Point, distance};

/// So far apart is one corner seen at most where its edges meet and where the sides of its squares do, px and as a share of the shorter step.
const SAME: f64 = 1.0;
const SAME_SHARE: f64 = 0.03;
/// How far a corner whose sides are not seen may be from where the others have it, as a share of the shorter step, and px more.
const BENT: f64 = 0.08;
const BENT_PX: f64 = 0.75;
/// The same of one whose sides are seen.
const ASTRAY: f64 = 0.3;
/// So far off a corner is where its edges meet whatever its sides tell.
const OFF: f64 = 0.025;
const OFF_PX: f64 = 0.75;
/// Sides are looked at in an image in which the shorter step is so long, px.
const LOOKED_AT: f64 = 20.0;
/// So large a share of the corners may be unseen.
const UNSEEN: f64 = 0.06;

impl Board {
    /// Its corners to where the image has them: each where two of three agree, the edges that meet in it, the sides of the squares around it, and the other corners.
    /// Those that are not seen are put where the others have them, and marked.
    pub(super) fn settle(&mut self, pyramid: &Pyramid, factor: f64) {
        let steps: Vec<f64> = (0..self.corners.len()).map(|index| self.step(index)).collect();
        let met = refined(pyramid, &self.corners, &steps, AROUND, factor);
        let met: Vec<bool> = met
            .into_iter()
            .zip(&mut self.corners)
            .map(|((at, met), corner)| {
                *corner = at;
                met
            })
            .collect();
        let sides: Vec<Crossing> = (0..self.corners.len()).map(|index| self.sides(pyramid, index, self.corners[index])).collect();
        let mut doubtful = Vec::new();
        let mut sided = vec![false; self.corners.len()];
        for (index, sides) in sides.into_iter().enumerate() {
            match sides {
                Crossing::At(at) if met[index] && self.is_same(index, at) => sided[index] = true,
                Crossing::Peak(at) if met[index] && self.is_same(index, at) => {}
                _ => doubtful.push((index, sides, self.corners[index])),
            }
        }
        // Of small squares the saddle is nearer to the truth than where blurred edges meet; of others neither is known.
        for (index, sides, _) in &doubtful {
            match sides {
                Crossing::Peak(at) => self.corners[*index] = *at,
                _ => self.seen[*index] = false,
            }
        }
        for (index, sides, at) in doubtful {
            self.examine(pyramid, index, sides, met[index].then_some(at));
        }
        self.settled = self.is_settled(&sided);
    }

    /// Looks for a corner at which the edges that meet in it, if they do, and its sides do not agree: the other corners decide.
    fn examine(&mut self, pyramid: &Pyramid, index: usize, sides: Crossing, met: Option<Point>) {
        let Some(forecast) = self.forecast(index) else { return };
        let step = self.step(index);
        let limit = BENT * step + BENT_PX;
        let beside = |at: Point| [self.sides(pyramid, index, at).at(), self.peak(pyramid, index, at)];
        let seen = sides.at().into_iter().chain(std::iter::once(self.corners[index]).chain(forecast.places()).flat_map(beside).flatten());
        let seen = seen.map(|at| (at, limit, false)).chain(met.map(|at| (at, OFF * step + OFF_PX, true)));
        let near = seen.map(|(at, limit, met)| (at, forecast.off(at), limit, met)).filter(|(_, off, limit, _)| off < limit);
        let nearest = near.min_by(|a, b| a.1.total_cmp(&b.1));
        self.seen[index] = nearest.is_some();
        match nearest {
            Some((at, _, _, true)) => self.corners[index] = at,
            Some((at, ..)) => self.put(pyramid, index, at),
            None => self.corners[index] = forecast.places().next().unwrap_or(self.corners[index]),
        }
    }

    /// The saddle where a corner is at a place, in the image as it is; of squares that are large beside any blur it tells less than their sides.
    fn peak(&self, pyramid: &Pyramid, index: usize, at: Point) -> Option<Point> {
        let short = self.step(index);
        if short > 2.0 * LOOKED_AT { None } else { saddle(pyramid.image(), at, short) }
    }

    /// What the sides around a corner tell if it is at a place.
    fn sides(&self, pyramid: &Pyramid, index: usize, at: Point) -> Crossing {
        let short = self.step(index);
        let Some((image, of)) = pyramid.up_to((short / LOOKED_AT).max(1.0)).last() else { return Crossing::Unseen };
        let own = scaled(at, 1.0 / of);
        let beside = |by: [i32; 2]| if by == [0, 0] { Some(own) } else { self.beside(index, by).map(|at| scaled(at, 1.0 / of)) };
        let Some(light) = Steps::at(own, beside).and_then(|steps| contrast(image, own, &steps)) else { return Crossing::Unseen };
        match crossing(image, own, light.mean, beside) {
            Crossing::At(at) => Crossing::At(scaled(at, of)),
            // Of squares that are small beside the blur no sides may be seen.
            other => self.peak(pyramid, index, at).map_or(other, Crossing::Peak),
        }
    }

    fn is_same(&self, index: usize, at: Point) -> bool {
        distance(self.corners[index], at) < SAME.max(SAME_SHARE * self.step(index))
    }

    /// A corner to where its sides meet, or near it to where its edges do.
    fn put(&mut self, pyramid: &Pyramid, index: usize, at: Point) {
        let [(near, met)] = refined(pyramid, &[at], &[self.step(index)], AROUND, 1.0)[..] else { return };
        self.corners[index] = at;
        if met && self.is_same(index, near) {
            self.corners[index] = near;
        }
    }

    /// Where those that are seen have a corner.
    fn forecast(&self, index: usize) -> Option<Forecast> {
        Forecast::of(|by| self.seen_beside(index, by))
    }

    /// Whether nearly all corners are seen, about where the others have them: nearer where no sides tell.
    fn is_settled(&self, sided: &[bool]) -> bool {
        let unseen = self.seen.iter().filter(|seen| !**seen).count();
        let astray = |index: usize| {
            let share = if sided[index] { ASTRAY } else { BENT };
            let (at, limit) = (self.corners[index], share * self.step(index) + BENT_PX);
            let is_near = Forecast::off_bent(at, |by| self.seen_beside(index, by)).is_some_and(|off| off <= limit);
            !is_near && self.forecast(index).is_none_or(|all| all.off(at) > limit)
        };
        unseen as f64 <= UNSEEN * self.seen.len() as f64 && !(0..self.corners.len()).any(astray)
    }
}
