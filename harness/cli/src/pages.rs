//! Pages as soon as they can be made: those of a family of scenarios once the last of it was run, and how long the rest takes.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::context::Context;
use super::report::Report;
use crate::failure::Failure;

/// How long scenarios take beside each other: a table of the project, by which alone the rest is estimated.
const SECONDS: &str = "reference/seconds.csv";

/// Writes pages between runs.
pub struct Pages {
    started: Instant,
    seconds: BTreeMap<String, f64>,
    left: Mutex<Left>,
}

/// What is yet to be run.
struct Left {
    /// Scenarios by family.
    families: BTreeMap<String, usize>,
    scenarios: usize,
    seconds: f64,
    done: f64,
}

fn family(name: &str) -> &str {
    name.split('/').next().unwrap_or(name)
}

impl Pages {
    /// For runs of these scenarios, which are put in the order in which they are to be run: families that are done soon come first.
    pub fn of(context: &Context<'_>, names: &mut [String]) -> Result<Self, Failure> {
        let table = std::fs::read_to_string(context.root()?.join(SECONDS)).unwrap_or_default();
        let seconds = read(&table);
        let of = |name: &str| seconds.get(name).copied().unwrap_or(1.0);
        let mut families: BTreeMap<String, (usize, f64)> = BTreeMap::new();
        for name in &*names {
            let (count, sum) = families.entry(family(name).to_owned()).or_default();
            (*count, *sum) = (*count + 1, *sum + of(name));
        }
        let whole = |name: &String| families.get(family(name)).map_or(0.0, |(_, sum)| *sum);
        names.sort_by(|a, b| whole(a).total_cmp(&whole(b)).then_with(|| family(a).cmp(family(b))));
        let left = Left {
            scenarios: names.len(),
            seconds: names.iter().map(|name| of(name)).sum(),
            done: 0.0,
            families: families.into_iter().map(|(family, (count, _))| (family, count)).collect(),
        };
        Ok(Self { started: Instant::now(), seconds, left: Mutex::new(left) })
    }

    /// The scenario was run: writes the pages of its family if it was the last of it.
    pub fn done(&self, context: &Context<'_>, name: &str) -> Result<(), Failure> {
        let seconds = self.seconds.get(name).copied().unwrap_or(1.0);
        let (complete, rest) = {
            let mut left = self.left.lock().unwrap_or_else(PoisonError::into_inner);
            left.scenarios -= 1;
            left.seconds -= seconds;
            left.done += seconds;
            let count = left.families.entry(family(name).to_owned()).or_default();
            *count = count.saturating_sub(1);
            (*count == 0, rest(&left, self.started.elapsed(), rayon::current_num_threads()))
        };
        if !complete {
            return Ok(());
        }
        Report::of_family(family(name)).run(context)?;
        if !context.quiet {
            say!("{rest}");
        }
        Ok(())
    }
}

/// Of so many seconds of the table it is taken that they take as long here, shared by the threads: what was done first is too little to tell.
const BEFORE: f64 = 20.0;

/// How much is left, and how long that takes if it goes on as it went.
fn rest(left: &Left, elapsed: Duration, threads: usize) -> String {
    let families = left.families.values().filter(|count| **count > 0).count();
    if left.scenarios == 0 {
        return "all scenarios are done".into();
    }
    let seconds = left.seconds * (elapsed.as_secs_f64() + BEFORE / threads as f64) / (left.done + BEFORE);
    let time = if seconds < 90.0 { format!("{seconds:.0} s") } else { format!("{:.0} min", seconds / 60.0) };
    let of = |count: usize, one: &str, many: &str| if count == 1 { format!("1 {one}") } else { format!("{count} {many}") };
    format!("left: {} of {}, about {time}", of(left.scenarios, "scenario", "scenarios"), of(families, "family", "families"))
}

/// Lines of `scenario,seconds`; others are passed over, for nothing but an estimate depends on them.
fn read(table: &str) -> BTreeMap<String, f64> {
    let line = |line: &str| {
        let (name, seconds) = line.split_once(',')?;
        Some((name.to_owned(), seconds.trim().parse().ok().filter(|seconds: &f64| *seconds > 0.0)?))
    };
    table.lines().filter_map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_is_estimated_by_what_is_known_of_scenarios() {
        let seconds = read("# on some machine\nscenario,seconds\na/x,2\na/y,6.5\nb/z,nothing\nc/z,-1\n");
        assert_eq!(seconds, [("a/x".to_owned(), 2.0), ("a/y".to_owned(), 6.5)].into());
        let left = |scenarios, seconds, done| Left {
            families: [("a".to_owned(), scenarios), ("b".to_owned(), 0)].into(),
            scenarios,
            seconds,
            done,
        };
        let after = |left: &Left| rest(left, Duration::from_secs(5), 2);
        assert_eq!(after(&left(3, 30.0, 10.0)), "left: 3 scenarios of 1 family, about 15 s");
        assert_eq!(after(&left(3, 360.0, 10.0)), "left: 3 scenarios of 1 family, about 3 min");
        assert_eq!(after(&left(0, 0.0, 10.0)), "all scenarios are done");
    }
}
