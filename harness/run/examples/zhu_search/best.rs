//! Which settings are kept of millions, and what chance alone would have reached.

use calibench_random::{Key, Purpose, stream};
use rand::seq::SliceRandom;

/// |v| of (a) to (h) as it follows from the printed coordinates.
pub const PRINTED: [f64; 8] = [0.001, 0.0957, 0.0662, 0.1217, 0.2281, 0.2584, 0.1948, 0.0596];
/// Orders of the printed figures that are tried.
const ORDERS: usize = 2000;
/// Settings of which a list has room.
const ROOM: usize = 12;

/// A setting that measures all eight points.
#[derive(Clone, Debug)]
pub struct Found<S> {
    pub setting: S,
    pub v: [f64; 8],
}

impl<S> Found<S> {
    /// The RMS of |v|, px.
    pub fn m(&self) -> f64 {
        off(&self.v, &[0.0; 8])
    }

    /// The RMS difference from the print, px.
    pub fn off(&self) -> f64 {
        off(&self.v, &PRINTED)
    }
}

fn off(v: &[f64; 8], printed: &[f64; 8]) -> f64 {
    (v.iter().zip(printed).map(|(v, p)| (v - p).powi(2)).sum::<f64>() / 8.0).sqrt()
}

/// The least of a list by some figure.
#[derive(Clone, Debug)]
pub struct Least<S> {
    by: fn(&Found<S>) -> f64,
    pub list: Vec<Found<S>>,
}

impl<S: Clone> Least<S> {
    pub fn new(by: fn(&Found<S>) -> f64) -> Self {
        Self { by, list: Vec::new() }
    }

    pub fn add(&mut self, found: &Found<S>) {
        let value = (self.by)(found);
        if self.list.len() == ROOM && value >= (self.by)(&self.list[ROOM - 1]) {
            return;
        }
        let place = self.list.partition_point(|other| (self.by)(other) <= value);
        self.list.insert(place, found.clone());
        self.list.truncate(ROOM);
    }

    pub fn merge(&mut self, other: &Self) {
        other.list.iter().for_each(|found| self.add(found));
    }
}

/// What the search would reach if the printed figures stood at the images in another order: the least RMS difference over all settings, for many orders.
///
/// An operator that was found has the least for the order in print; where other orders are reached as well, the search fits anything.
#[derive(Clone, Debug)]
pub struct Chance {
    least: Vec<f64>,
}

/// The printed figures in many orders, none of them that of the print.
pub struct Orders(Vec<[f64; 8]>);

impl Orders {
    pub fn new() -> Self {
        let mut rng = stream(Key { seed: 2007, of: "zhu-2007/search", trial: 0, view: "", target: "" }, Purpose::Phase);
        let mut orders = Vec::new();
        while orders.len() < ORDERS {
            let mut order = PRINTED;
            order.shuffle(&mut rng);
            if order != PRINTED {
                orders.push(order);
            }
        }
        Self(orders)
    }
}

impl Chance {
    pub fn new() -> Self {
        Self { least: vec![f64::INFINITY; ORDERS] }
    }

    pub fn add(&mut self, orders: &Orders, v: &[f64; 8]) {
        for (least, order) in self.least.iter_mut().zip(&orders.0) {
            let sum: f64 = v.iter().zip(order).map(|(v, p)| (v - p) * (v - p)).sum();
            *least = least.min(sum);
        }
    }

    pub fn merge(&mut self, other: &Self) {
        self.least.iter_mut().zip(&other.least).for_each(|(least, other)| *least = least.min(*other));
    }

    /// The share of orders that come as near as `off`, px, and the least, the middle and the largest RMS difference, px.
    pub fn as_near_as(&self, off: f64) -> (f64, [f64; 3]) {
        let mut all: Vec<f64> = self.least.iter().map(|sum| (sum / 8.0).sqrt()).collect();
        all.sort_by(f64::total_cmp);
        let near = all.partition_point(|least| *least <= off);
        (near as f64 / ORDERS as f64, [all[0], all[ORDERS / 2], all[ORDERS - 1]])
    }
}
