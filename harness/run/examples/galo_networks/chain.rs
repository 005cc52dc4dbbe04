//! A walk from network to network, all of which agree with the print.

use calibench_random::{Key, Purpose, stream};
use rand::Rng;

use crate::drawn::Drawn;
use crate::kept::{Kept, kept};
use crate::screened::{Screened, screened};

/// Steps of a chain after its first network that agrees.
const STEPS: u64 = 300;
/// One in so many of them is written: those between are much alike.
const EVERY: u64 = 50;

/// Below this difference of logarithms any network is as good a start as another.
const NEAR: f64 = 0.2;

/// What a chain found.
pub struct Walked {
    /// Networks drawn until one agreed.
    pub before: u64,
    /// Steps thereafter.
    pub steps: u64,
    /// Steps that led to another network.
    pub taken: u64,
    /// The networks where it was, every now and then.
    pub kept: Vec<Kept>,
}

/// Chain `chain`: the same on any thread.
pub fn walk(chain: u64) -> Walked {
    let mut rng = stream(Key { seed: 2011, of: "galo-2011/networks", trial: chain, view: "", target: "" }, Purpose::Station);
    // Every network has a number of its own, and with it noise of its own.
    let mut number = chain * 100_000_000;
    let (mut here, mut found) = start(&mut rng, &mut number);
    let before = number - chain * 100_000_000;
    let (mut taken, mut all) = (0, Vec::new());
    for step in 1..=STEPS {
        number += 1;
        let there = here.redrawn(number, &mut rng);
        if let Some(other) = agreeing(&there) {
            (here, found) = (there, other);
            taken += 1;
        }
        if step % EVERY == 0 {
            all.push(found.clone());
        }
    }
    Walked { before, steps: STEPS, taken, kept: all }
}

/// The first network that agrees: parts are drawn anew as long as standard deviations come no further from the print, and freely near it.
fn start(rng: &mut impl Rng, number: &mut u64) -> (Drawn, Kept) {
    let mut next = || {
        *number += 1;
        *number
    };
    let (mut here, mut off) = loop {
        let drawn = Drawn::new(next(), rng);
        if let Some(screened) = screened(&drawn) {
            break (drawn, screened.off());
        }
    };
    loop {
        let there = here.redrawn(next(), rng);
        let Some(screened) = screened(&there).filter(|screened| screened.off() <= off.max(NEAR)) else { continue };
        (here, off) = (there, screened.off());
        if screened.is_like_the_print()
            && let Some(found) = kept(&here, &screened)
        {
            return (here, found);
        }
    }
}

fn agreeing(drawn: &Drawn) -> Option<Kept> {
    let screened = screened(drawn).filter(Screened::is_like_the_print)?;
    kept(drawn, &screened)
}
