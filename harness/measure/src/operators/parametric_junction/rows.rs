//! The observation equations of a junction's pixels, chunk by chunk.

use super::arms::{Field, MOST, Model, OneArm};
use super::gram::{Columns, Gram};
use super::lists::{ALONG, AREAS, Chunk, Lists, NEAR};
use super::unknowns::{Levels, Unknowns, WIDEST};
use crate::gradient::{EACH, EVEN, LIGHT};
use crate::lanes::{WIDE, Wide};

/// The commonest junction.
const CORNER: Unknowns = Unknowns { arms: 2, gradient: EVEN };

/// A junction in a window.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) model: &'a Model<f32>,
    pub(super) levels: &'a Levels,
    /// Where arms meet, px from the window's centre.
    pub(super) centre: [f32; 2],
}

/// Takes from the grey values, in the lists and row by row, what `place` leaves out of the `full` model.
pub(super) fn correct(place: Place<'_>, full: &Model<f32>, lists: &mut Lists, grey: &mut [f32]) {
    if place.levels.unknowns == CORNER { correct_corner(place, full, lists, grey) } else { correct_any(place, full, lists, grey) }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn correct_corner(place: Place<'_>, full: &Model<f32>, lists: &mut Lists, grey: &mut [f32]) {
    // What is known when this is compiled is done side by side.
    let levels = Levels { unknowns: CORNER, ..*place.levels };
    correct_all(Place { levels: &levels, ..place }, (full, CORNER.arms), lists, grey);
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn correct_any(place: Place<'_>, full: &Model<f32>, lists: &mut Lists, grey: &mut [f32]) {
    correct_all(place, (full, place.model.count), lists, grey);
}

#[inline(always)]
fn correct_all(place: Place<'_>, (full, arms): (&Model<f32>, usize), lists: &mut Lists, grey: &mut [f32]) {
    let Place { model, levels, centre } = place;
    for kind in [NEAR, ALONG] {
        for (chunk, count) in lists.chunks_mut(kind) {
            let (x, y) = from_point(chunk, centre);
            let (there, here) = if kind == NEAR {
                (full.shares_of::<WIDE, true>(arms, &x, &y), model.field_of::<WIDE, true>(arms, &x, &y).shares)
            } else {
                let one = model.one_arm(arms, &chunk.which, &x, &y);
                let after = full.after_one(&one.across, &one.cos, &one.sin);
                (shares(&chunk.which, &after, arms), shares(&chunk.which, &one.after, arms))
            };
            let mut left_out = [0.0; WIDE];
            for sector in 0..arms {
                for i in 0..WIDE {
                    let level = levels.of_sector(sector, x[i], y[i]) * (1.0 + levels.common(x[i], y[i]).1);
                    left_out[i] += level * (there[sector][i] - here[sector][i]);
                }
            }
            for i in 0..count {
                let grey = &mut grey[usize::from(chunk.index[i])];
                *grey -= left_out[i];
                chunk.grey[i] = *grey;
            }
        }
    }
}

/// The grey values that a place leaves, row by row.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
pub(super) fn leave(place: Place<'_>, lists: &Lists, into: &mut [f32]) {
    let Place { model, levels, centre } = place;
    for kind in [NEAR, ALONG, AREAS] {
        for (chunk, count) in lists.chunks(kind) {
            let (x, y) = from_point(chunk, centre);
            let shares = match kind {
                NEAR => model.shares::<WIDE, true>(&x, &y),
                ALONG => shares(&chunk.which, &model.one_arm(model.count, &chunk.which, &x, &y).after, model.count),
                _ => whole(&chunk.which, model.count),
            };
            let value = value(levels, (&x, &y), &shares);
            for i in 0..count {
                into[usize::from(chunk.index[i])] = chunk.grey[i] - value[i];
            }
        }
    }
}

/// Adds up the normal equations; without what pixels say that see one sector alone, where nothing changes over the window.
pub(super) fn add(place: Place<'_>, lists: &Lists, gram: &mut Gram) {
    if place.levels.unknowns == CORNER { add_corner(place, lists, gram) } else { add_any(place, lists, gram) }
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn add_corner(place: Place<'_>, lists: &Lists, gram: &mut Gram) {
    let levels = Levels { unknowns: CORNER, ..*place.levels };
    add_all(Place { levels: &levels, ..place }, CORNER, lists, gram);
}

#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn add_any(place: Place<'_>, lists: &Lists, gram: &mut Gram) {
    add_all(place, place.levels.unknowns, lists, gram);
}

#[inline(always)]
fn add_all(place: Place<'_>, unknowns: Unknowns, lists: &Lists, gram: &mut Gram) {
    let Place { model, levels, centre } = place;
    gram.clear(unknowns.count());
    for (chunk, count) in lists.chunks(NEAR) {
        let (x, y) = from_point(chunk, centre);
        let field = model.field_of::<WIDE, true>(unknowns.arms, &x, &y);
        let rows = Rows::new(levels, (&x, &y), count);
        let mut j = [[0.0; WIDE]; WIDEST];
        rows.by_arms(model, &field, &mut j);
        rows.add(chunk, &field.shares, &mut j, gram);
    }
    for (chunk, count) in lists.chunks(ALONG) {
        let (x, y) = from_point(chunk, centre);
        let one = model.one_arm(unknowns.arms, &chunk.which, &x, &y);
        let rows = Rows::new(levels, (&x, &y), count);
        let mut j = [[0.0; WIDE]; WIDEST];
        rows.by_one_arm(model, (&one, &chunk.which), &mut j);
        rows.add(chunk, &shares(&chunk.which, &one.after, unknowns.arms), &mut j, gram);
    }
    if unknowns.gradient == EVEN {
        return;
    }
    for (chunk, count) in lists.chunks(AREAS) {
        let (x, y) = from_point(chunk, centre);
        let mut j = [[0.0; WIDE]; WIDEST];
        Rows::new(levels, (&x, &y), count).add(chunk, &whole(&chunk.which, unknowns.arms), &mut j, gram);
    }
}

/// A chunk's coordinates from the point where arms meet.
#[inline(always)]
fn from_point(chunk: &Chunk, centre: [f32; 2]) -> (Wide, Wide) {
    // Exactly at the point directions have no meaning; a millionth of a pixel beside it they have.
    let beside = |from: f32| if from.abs() < 1e-6 { 1e-6 } else { from };
    let (mut x, mut y) = (chunk.x, chunk.y);
    for i in 0..WIDE {
        (x[i], y[i]) = (beside(x[i] - centre[0]), beside(y[i] - centre[1]));
    }
    (x, y)
}

/// The shares of the sectors where one arm alone is seen: what is after it, and the rest.
#[inline(always)]
fn shares(which: &Wide, after: &Wide, arms: usize) -> [Wide; MOST] {
    let mut shares = [[0.0; WIDE]; MOST];
    for k in 0..arms {
        let before = if k == 0 { arms - 1 } else { k - 1 };
        for i in 0..WIDE {
            let its = which[i] == k as f32;
            shares[k][i] += if its { after[i] } else { 0.0 };
            shares[before][i] += if its { 1.0 - after[i] } else { 0.0 };
        }
    }
    shares
}

/// The shares of the sectors where one alone is seen.
#[inline(always)]
fn whole(which: &Wide, arms: usize) -> [Wide; MOST] {
    let mut shares = [[0.0; WIDE]; MOST];
    for (sector, share) in shares.iter_mut().enumerate().take(arms) {
        for i in 0..WIDE {
            share[i] = if which[i] == sector as f32 { 1.0 } else { 0.0 };
        }
    }
    shares
}

/// The grey values of pixels at (`x`, `y`) from the point.
#[inline(always)]
fn value(levels: &Levels, (x, y): (&Wide, &Wide), shares: &[Wide; MOST]) -> Wide {
    let mut value = [0.0; WIDE];
    for (sector, share) in shares.iter().enumerate().take(levels.unknowns.arms) {
        for i in 0..WIDE {
            value[i] += levels.of_sector(sector, x[i], y[i]) * share[i];
        }
    }
    if levels.unknowns.gradient != EVEN {
        for i in 0..WIDE {
            let (added, brighter) = levels.common(x[i], y[i]);
            value[i] += (value[i] - levels.black) * brighter + added;
        }
    }
    value
}

/// The observation equations of pixels at (`x`, `y`) from the point.
struct Rows<'a> {
    levels: &'a Levels,
    x: &'a Wide,
    y: &'a Wide,
    /// 1, or 0 for what is no pixel; and times the light.
    weight: Wide,
    gain: Wide,
}

impl<'a> Rows<'a> {
    #[inline(always)]
    fn new(levels: &'a Levels, (x, y): (&'a Wide, &'a Wide), count: usize) -> Self {
        let (mut weight, mut gain) = ([0.0; WIDE], [0.0; WIDE]);
        for i in 0..WIDE {
            weight[i] = if i < count { 1.0 } else { 0.0 };
            gain[i] = weight[i] * (1.0 + levels.common(x[i], y[i]).1);
        }
        Self { levels, x, y, weight, gain }
    }

    /// By how much the grey value is larger after an arm than before it.
    #[inline(always)]
    fn jump(&self, k: usize, i: usize) -> f32 {
        let before = if k == 0 { self.levels.unknowns.arms - 1 } else { k - 1 };
        let (x, y) = (self.x[i], self.y[i]);
        self.gain[i] * (self.levels.of_sector(k, x, y) - self.levels.of_sector(before, x, y))
    }

    /// The derivatives by the position, the directions and the blur.
    #[inline(always)]
    fn by_arms(&self, model: &Model<f32>, field: &Field<f32, WIDE>, j: &mut Columns) {
        let unknowns = self.levels.unknowns;
        let by_variance = -0.5 / model.variance();
        let (mut by_x, mut by_y, mut soft) = ([0.0; WIDE], [0.0; WIDE], [0.0; WIDE]);
        for (k, arm) in model.arms().iter().enumerate().take(unknowns.arms) {
            let direction = &mut j[unknowns.direction(k)];
            let (slopes, turns, across) = (&field.slopes[k], &field.turns[k], &field.across[k]);
            for i in 0..WIDE {
                let jump = self.jump(k, i);
                let slope = jump * slopes[i];
                by_x[i] += slope * arm.y;
                by_y[i] -= slope * arm.x;
                soft[i] += by_variance * slope * across[i];
                direction[i] -= jump * turns[i];
            }
        }
        (j[0], j[1], j[unknowns.variance()]) = (by_x, by_y, soft);
    }

    /// The same where one arm alone is seen.
    #[inline(always)]
    fn by_one_arm(&self, model: &Model<f32>, (one, which): (&OneArm<f32, WIDE>, &Wide), j: &mut Columns) {
        let unknowns = self.levels.unknowns;
        let by_variance = -0.5 / model.variance();
        let mut jumps = [0.0; WIDE];
        for k in 0..unknowns.arms {
            let direction = &mut j[unknowns.direction(k)];
            for i in 0..WIDE {
                let jump = if which[i] == k as f32 { self.jump(k, i) } else { 0.0 };
                jumps[i] += jump;
                direction[i] -= jump * one.turns[i];
            }
        }
        for i in 0..WIDE {
            let slope = jumps[i] * one.slopes[i];
            j[0][i] = slope * one.sin[i];
            j[1][i] = -slope * one.cos[i];
            j[unknowns.variance()][i] = by_variance * slope * one.across[i];
        }
    }

    /// Adds them, with the derivatives by the grey values and what changes them.
    #[inline(always)]
    fn add(&self, chunk: &Chunk, shares: &[Wide; MOST], j: &mut Columns, gram: &mut Gram) {
        let unknowns = self.levels.unknowns;
        for sector in 0..unknowns.arms {
            for i in 0..WIDE {
                j[unknowns.grey(sector)][i] = self.gain[i] * shares[sector][i];
            }
        }
        let value = value(self.levels, (self.x, self.y), shares);
        if unknowns.gradient != EVEN {
            self.change((&value, shares), j);
        }
        let mut r = [0.0; WIDE];
        for i in 0..WIDE {
            r[i] = self.weight[i] * (chunk.grey[i] - value[i]);
        }
        gram.add(j, &r, unknowns.count());
    }

    /// The derivatives by what changes linearly, and by the position what it does through that.
    #[inline(always)]
    fn change(&self, (value, shares): (&Wide, &[Wide; MOST]), j: &mut Columns) {
        let (levels, weight) = (self.levels, &self.weight);
        let unknowns = levels.unknowns;
        for (axis, place) in [self.x, self.y].into_iter().enumerate() {
            if unknowns.gradient == EACH {
                for sector in 0..unknowns.arms {
                    for i in 0..WIDE {
                        let share = weight[i] * shares[sector][i];
                        j[axis][i] -= share * levels.slopes[sector][axis];
                        j[unknowns.slope() + 2 * sector + axis][i] = share * place[i];
                    }
                }
            } else {
                for i in 0..WIDE {
                    let light = 1.0 + levels.common(self.x[i], self.y[i]).1;
                    // The grey value above black, in the light at the point.
                    let scale = if unknowns.gradient == LIGHT { (value[i] - levels.black) / light } else { 1.0 };
                    j[axis][i] -= weight[i] * scale * levels.common[axis];
                    j[unknowns.slope() + axis][i] = weight[i] * scale * place[i];
                }
            }
        }
    }
}
