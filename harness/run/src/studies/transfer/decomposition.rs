//! The error of check points split by its causes.

use calibench_records::figures::{FigureName, Quantity};
use calibench_records::results::Figure;
use calibench_scenario::studies::transfer::{Decomposition, Switch};
use nalgebra::Vector2;

/// Errors in the plane of X and Y, check point by check point, object units.
pub type Errors = Vec<Vector2<f64>>;

/// Planimetric errors under every combination of switches that a split takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// The switches.
    pub switches: Vec<Switch>,
    /// With all switches off.
    pub none: Errors,
    /// With all of them on.
    pub all: Errors,
    /// With each on alone.
    pub alone: Vec<Errors>,
    /// With each off alone.
    pub without: Vec<Errors>,
    /// With each two on, in the order (0, 1), (0, 2), ..., (1, 2), ...
    pub pairs: Vec<Errors>,
}

impl Split {
    /// Splits by `of`, which returns the errors under conditions.
    ///
    /// # Errors
    /// Of `of`, with what was switched.
    pub fn new(
        plan: &Decomposition,
        mut of: impl FnMut(&calibench_scenario::studies::transfer::Conditions) -> Result<Errors, String>,
    ) -> Result<Self, String> {
        let (off, on, switches) = (plan.off, plan.on, plan.switches.clone());
        let mut named = |what: &str, conditions| of(&conditions).map_err(|why| format!("{what}: {why}"));
        let none = named("all switches off", off)?;
        let all = named("all switches on", on)?;
        let (mut alone, mut without, mut pairs) = (Vec::new(), Vec::new(), Vec::new());
        for (i, &switch) in switches.iter().enumerate() {
            alone.push(named(switch.name(), off.with(switch, &on))?);
            without.push(named(&format!("all but {}", switch.name()), on.with(switch, &off))?);
            for &second in &switches[i + 1..] {
                pairs.push(named(&format!("{} and {}", switch.name(), second.name()), off.with(switch, &on).with(second, &on))?);
            }
        }
        Ok(Self { switches, none, all, alone, without, pairs })
    }

    /// What each switch adds alone, check point by check point.
    fn effects(&self) -> Vec<Errors> {
        self.alone.iter().map(|alone| less(alone, &self.none)).collect()
    }

    /// What all together make beyond the sum of each alone: `e(all) - e(none) - sum(e(alone) - e(none))`.
    pub fn interaction(&self) -> Errors {
        self.effects().iter().fold(less(&self.all, &self.none), |left, effect| less(&left, effect))
    }

    /// What two together make beyond the sum of both alone, in the order of [`Self::pairs`].
    fn pair_interactions(&self) -> Vec<Errors> {
        let effects = self.effects();
        let places = (0..effects.len()).flat_map(|i| (i + 1..effects.len()).map(move |j| (i, j)));
        places.zip(&self.pairs).map(|((i, j), both)| less(&less(&less(both, &self.none), &effects[i]), &effects[j])).collect()
    }

    /// Shares of the mean square of the whole error: of each switch `<e(alone) - e(none), e(all)> / <e(all), e(all)>`, then of what is there with all
    /// switches off, then of the interactions. They sum to 1.
    pub fn shares(&self) -> Vec<f64> {
        let whole = dot(&self.all, &self.all);
        let parts = self.effects().into_iter().chain([self.none.clone(), self.interaction()]);
        parts.map(|part| dot(&part, &self.all) / whole).collect()
    }

    /// Root mean square errors, `unit`, and shares, numbers.
    pub fn figures(&self, unit: &'static str) -> Vec<Figure> {
        let rms = |name: FigureName, errors: &Errors| Figure::plain(name, rms(errors), unit);
        let whole = |quantity: Quantity, errors: &Errors| rms(quantity.into(), errors);
        let mut figures = vec![
            whole(Quantity::NoCause, &self.none),
            whole(Quantity::AllCauses, &self.all),
            whole(Quantity::Interactions, &self.interaction()),
        ];
        for (i, switch) in self.switches.iter().enumerate() {
            figures.push(rms(Quantity::Alone.of(&[switch.name()]), &self.alone[i]));
            figures.push(rms(Quantity::Without.of(&[switch.name()]), &self.without[i]));
        }
        let rest = [Quantity::NoCause, Quantity::Interactions].map(|quantity| quantity.entry().pattern);
        let names = self.switches.iter().map(|switch| switch.name()).chain(rest);
        figures.extend(names.zip(self.shares()).map(|(name, share)| Figure::plain(Quantity::Share.of(&[name]), share, "")));
        let pairs = self.switches.iter().enumerate().flat_map(|(i, a)| self.switches[i + 1..].iter().map(move |b| (a, b)));
        let named = pairs.map(|(a, b)| Quantity::PairOfCauses.of(&[a.name(), b.name()]));
        figures.extend(named.zip(self.pair_interactions()).map(|(name, errors)| rms(name, &errors)));
        figures
    }

    /// How often check points were intersected for it.
    pub fn runs(&self) -> usize {
        2 + self.alone.len() + self.without.len() + self.pairs.len()
    }
}

fn less(a: &Errors, b: &Errors) -> Errors {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn dot(a: &Errors, b: &Errors) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

fn rms(errors: &Errors) -> f64 {
    (dot(errors, errors) / errors.len().max(1) as f64).sqrt()
}
