//! What results are stored under.

use calibench_files::folder::digest;
use calibench_scenario::{Study, Subject};
use calibench_store::Key;

use super::arithmetic::arithmetic;
use super::{Reuse, code};
use crate::Plan;

/// Raised when entries are written otherwise, or when what they hold means something else.
const FORMAT: &str = "1";

/// The keys of a plan.
pub struct Keys {
    /// Of what each method makes, or of all together.
    pub methods: Vec<MethodKeys>,
    /// Of the images of the first trial.
    pub images: Key,
}

/// Whether something is wanted, and where it is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// Nobody asks for it.
    No,
    /// It is computed whenever it is asked for.
    Unkept,
    /// Under this key.
    Under(Key),
}

impl Wanted {
    /// Under a key, if it is wanted at all.
    fn under(is_wanted: bool, key: impl FnOnce() -> Key) -> Self {
        if is_wanted { Self::Under(key()) } else { Self::No }
    }

    /// Where it is kept, if it is.
    pub fn key(self) -> Option<Key> {
        match self {
            Self::Under(key) => Some(key),
            Self::No | Self::Unkept => None,
        }
    }
}

/// The keys of what a method makes.
pub struct MethodKeys {
    /// Its place; `None` of all together.
    pub method: Option<usize>,
    /// Of its points, with what is adjusted from them where that is not apart. `None` of a method that nobody knows the code of.
    pub points: Option<Key>,
    /// Of the bounds of its points, where they are asked for; without a key they are computed whenever they are.
    pub bounds: Wanted,
    /// Of what is adjusted, where that is apart, alike.
    pub adjusted: Wanted,
}

/// The keys of `plan`, unless it measures nothing that could be kept.
pub fn of(plan: &Plan<'_>, reuse: &Reuse<'_>) -> Option<Keys> {
    if matches!(&plan.scenario.subject, Subject::Views(views) if matches!(views.study, Study::Calibrators(_))) {
        // Nobody knows when a program changes.
        return None;
    }
    let data = match &plan.scenario.subject {
        Subject::Photographs(subject) => {
            if plan.missing().is_some() {
                return None;
            }
            let folder = plan.folder_of(subject);
            let mut digests = String::new();
            for file in &subject.files {
                digests.push_str(&digest(&folder.join(file)).ok()?);
            }
            digests
        }
        Subject::Scene(_) | Subject::Views(_) | Subject::Printed(_) => String::new(),
    };
    let (seed, span) = (plan.seed.to_string(), plan.span());
    let trials = format!("{} {}", span.from, span.to);
    let points = code::digest(code::POINTS, reuse.program);
    let common = vec![
        ("format", FORMAT),
        ("drawn", &*plan.scenario.drawn),
        ("resolved", &*plan.scenario.resolved.points),
        ("data", &*data),
        ("seed", &*seed),
        ("code", points),
        ("arithmetic", arithmetic()),
    ];
    let apart = plan.is_adjusted_apart();
    let methods = if plan.scenario.subject.is_measured() {
        plan.available().into_iter().map(|method| of_method(plan, reuse, &common, (&trials, apart), method)).collect()
    } else {
        vec![together(plan, reuse, &common, &trials)]
    };
    // Which image is shown depends on what is measured in which, and on what can measure.
    let labels = plan.all_available().into_iter().map(|method| ("method", plan.methods[method].label.as_str()));
    let images = Key::of("images", common.iter().copied().chain(labels));
    Some(Keys { methods, images })
}

fn of_method(plan: &Plan<'_>, reuse: &Reuse<'_>, common: &[(&str, &str)], (trials, apart): (&str, bool), index: usize) -> MethodKeys {
    let method = &plan.methods[index];
    let bounded = plan.bounds && may_be_bounded(&plan.scenario.subject);
    let unkept = |is_wanted| if is_wanted { Wanted::Unkept } else { Wanted::No };
    if method.outside || method.recorded().is_some() {
        return MethodKeys { method: Some(index), points: None, bounds: unkept(bounded), adjusted: unkept(apart) };
    }
    let settings = method.all_settings();
    // Of the crates' own operators alone the whole code is known by their names.
    let program = if method.own { "" } else { reuse.program };
    let own = [
        ("trials", trials),
        ("method", method.label.as_str()),
        ("version", &method.version),
        ("settings", &settings),
        ("operator", code::digest(method.name(), reuse.program)),
        ("program", program),
    ];
    let adjusted = [("adjusted", plan.scenario.resolved.adjusted.as_str()), ("adjustment", code::digest(code::ADJUSTED, reuse.program))];
    let has_adjusted = !plan.scenario.resolved.adjusted.is_empty();
    let parts = |with: bool| common.iter().copied().chain(own).chain(adjusted.into_iter().filter(move |_| with));
    MethodKeys {
        method: Some(index),
        points: Some(Key::of("points", parts(has_adjusted && !apart))),
        bounds: Wanted::under(bounded, || Key::of("bounds", parts(has_adjusted && !apart))),
        adjusted: Wanted::under(apart, || Key::of("adjusted", parts(true))),
    }
}

/// Whether its points are of images that were rendered.
fn may_be_bounded(subject: &Subject) -> bool {
    match subject {
        Subject::Scene(_) => true,
        Subject::Views(views) => views.study.plan().drawn().is_none(),
        Subject::Photographs(_) | Subject::Printed(_) => false,
    }
}

/// Of calibrations that are applied, and of printed figures: all of it is one result.
fn together(plan: &Plan<'_>, reuse: &Reuse<'_>, common: &[(&str, &str)], trials: &str) -> MethodKeys {
    let versions: Vec<String> =
        plan.method_infos().iter().map(|info| format!("{} {} {:?}", info.label, info.version, info.unavailable)).collect();
    let more = [
        ("trials", trials),
        ("adjusted", &plan.scenario.resolved.adjusted),
        ("all", code::digest(code::ALL, reuse.program)),
        ("program", reuse.program),
    ];
    let key = Key::of("together", common.iter().copied().chain(more).chain(versions.iter().map(|version| ("method", version.as_str()))));
    MethodKeys { method: None, points: Some(key), bounds: Wanted::No, adjusted: Wanted::No }
}
