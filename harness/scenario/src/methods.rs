//! The `[[method]]` tables: their keys are the method's own parameters.

use std::ops::Range;

use calibench_diagnostics::Problem;
use calibench_measure::coverage::{all_busy, cover, distinct, unmeasured};
use calibench_measure::registry::KINDS;
use calibench_measure::{BoardFinder, Configured, Kinds, KindsError, KindsGap, MethodError, Registry, Setting};
use calibench_model::TargetKind;
use toml::Spanned;
use toml::de::DeValue;

use super::section::Section;
use super::subject::Subject;

/// All methods of a scenario; mistakes are added to `problems`.
pub fn methods(sections: Vec<Section<'_>>, registry: &Registry, problems: &mut Vec<Problem>) -> Vec<Configured> {
    let mut found: Vec<Configured> = Vec::new();
    for section in sections {
        let span = section.span.clone();
        let Some(configured) = method(section, registry, problems) else { continue };
        if found.iter().any(|earlier| earlier.label == configured.label) {
            problems.push(Problem::new(span, format!("method `{}` is listed twice; expected each once", configured.label)));
        } else if let Err(gap) = distinct(&found, &configured) {
            problems.push(Problem::new(span, gap.to_string()));
        } else {
            found.push(configured);
        }
    }
    found
}

/// Whether `methods`, whose tables stand at `spans`, and targets of these `kinds` go together; what does not is added to `problems`. In a cell of a sweep a
/// method may be idle: it may have something to measure in others.
pub fn check_kinds(methods: &[Configured], spans: &[Range<usize>], kinds: &[TargetKind], in_sweep: bool, problems: &mut Vec<Problem>) {
    let gap = if in_sweep {
        Some(unmeasured(methods, kinds.iter().copied())).filter(|left| !left.is_empty()).map(KindsGap::Unmeasured)
    } else {
        cover(methods, kinds, kinds).err()
    };
    problems.extend(gap.map(|gap| at(&gap, spans)));
}

/// Why methods have no board to find: of each one that finds boards and has none, the reason.
pub type Lacking = Vec<Option<String>>;

/// Of which of `methods` the images of `subject` hold no board that they find.
pub fn without_board(methods: &[Configured], subject: &Subject) -> Lacking {
    methods.iter().map(|method| no_board(subject, method.board_finder()?)).collect()
}

/// Whether each of `methods`, whose tables stand at `spans`, has a board to find in one of the cells, if it finds boards.
pub fn check_boards(methods: &[Configured], spans: &[Range<usize>], cells: &[Lacking], problems: &mut Vec<Problem>) {
    let unfit = |(index, (method, span)): (usize, (&Configured, &Range<usize>))| {
        let why = cells.iter().map(|lacking| lacking.get(index)?.as_ref()).collect::<Option<Vec<_>>>()?;
        Some(Problem::new(span.clone(), format!("`{}` finds boards, and {}", method.label, why.first()?)))
    };
    problems.extend(methods.iter().zip(spans).enumerate().filter_map(unfit));
}

/// Why `finder` has nothing to find in the images of `subject`, if so.
pub fn no_board(subject: &Subject, finder: &dyn BoardFinder) -> Option<String> {
    match subject {
        Subject::Views(views) => match &views.sheet {
            Some(board) => finder.unfit(board),
            None => Some("the testfield is none".to_owned()),
        },
        Subject::Photographs(_) => Some("it is scored where the truth is known: in rendered views of a board".to_owned()),
        Subject::Scene(_) | Subject::Printed(_) => Some("there is no testfield that is one".to_owned()),
    }
}

/// Whether each of `methods` has targets among those of these `kinds`.
pub fn check_busy(methods: &[Configured], spans: &[Range<usize>], kinds: &[TargetKind], problems: &mut Vec<Problem>) {
    problems.extend(all_busy(methods, kinds.iter().copied()).err().map(|gap| at(&gap, spans)));
}

fn at(gap: &KindsGap, spans: &[Range<usize>]) -> Problem {
    let index = if let KindsGap::Idle { index, .. } = gap { *index } else { 0 };
    Problem::new(spans.get(index).cloned().unwrap_or(0..0), gap.to_string())
}

fn method(mut section: Section<'_>, registry: &Registry, problems: &mut Vec<Problem>) -> Option<Configured> {
    let known = || registry.methods().iter().map(|method| method.name);
    let Some((key_span, value)) = section.take("name") else {
        let names = known().collect::<Vec<_>>().join(", ");
        problems.push(Problem::new(section.span, "[[method]] has no `name`").help(format!("`name`: one of {names}")));
        return None;
    };
    let Some(name) = value.get_ref().as_str() else {
        let found = value.get_ref().type_str();
        problems.push(Problem::new(key_span, format!("`name` is the name of a method, in quotes; found {found}")));
        return None;
    };
    let kinds = match section.take(KINDS) {
        Some((_, value)) => Some(kinds(&value, problems)?),
        None => None,
    };
    let mut given = Vec::new();
    // An unknown key first: what kind of value it has does not matter.
    let known_keys = registry.methods().iter().find(|m| m.name == name).map_or(&[][..], |m| m.parameters);
    let unknown = |key: &str| !known_keys.is_empty() && !known_keys.iter().any(|p| p.name == key);
    for (key, value) in &section.table {
        if unknown(key.get_ref()) {
            given.push((key.get_ref().to_string(), Setting::Number(0.0)));
            continue;
        }
        let name_or_number = || value.get_ref().as_str().map(|name| Setting::Name(name.to_owned()));
        match number(value.get_ref()).map(Setting::Number).or_else(name_or_number) {
            Some(setting) => given.push((key.get_ref().to_string(), setting)),
            None => {
                let found = value.get_ref().type_str();
                problems.push(Problem::new(value.span(), format!("`{}` of `{name}` is a number or a name, found {found}", key.get_ref())));
                return None;
            }
        }
    }
    let span_of = |key: &str| section.table.iter().find(|(k, _)| k.get_ref() == key).map(|(k, v)| (k.span(), v.span()));
    let problem = |error: MethodError| match &error {
        MethodError::UnknownMethod { name, .. } => Problem::new(value.span(), error.to_string()).nearest(name, known()),
        MethodError::UnknownParameter { key, known, .. } => {
            let span = span_of(key).map_or(section.span.clone(), |spans| spans.0);
            Problem::new(span, error.to_string()).nearest(key, known.iter().map(String::as_str))
        }
        MethodError::Domain { key, .. } | MethodError::Twice { key, .. } => {
            Problem::new(span_of(key).map_or(section.span.clone(), |spans| spans.1), error.to_string())
        }
        MethodError::Form { .. } | MethodError::Kinds { .. } | MethodError::File { .. } => Problem::new(value.span(), error.to_string()),
    };
    let configured = registry.configure(name, &given).map_err(|error| problems.push(problem(error))).ok()?;
    Some(match kinds {
        Some(kinds) => configured.limited(kinds),
        None => configured,
    })
}

/// The kinds of targets that a method is limited to, as in `["disc", "square"]`.
fn kinds(value: &Spanned<DeValue<'_>>, problems: &mut Vec<Problem>) -> Option<Kinds> {
    let names = value.get_ref().as_array().map(|list| list.iter().map(|name| name.get_ref().as_str()).collect::<Option<Vec<_>>>());
    let Some(Some(names)) = names else {
        let message = "`kinds` is a list of kinds of targets, in quotes, as in [\"disc\", \"square\"]";
        problems.push(Problem::new(value.span(), message).help(format!("known are {}", known_kinds())));
        return None;
    };
    let problem = |error: KindsError| {
        let problem = Problem::new(value.span(), format!("`kinds`: {error}"));
        match &error {
            KindsError::Unknown(unknown) => problem.nearest(&unknown.0, TargetKind::ALL.map(TargetKind::name)),
            _ => problem,
        }
    };
    Kinds::new(names).map_err(|error| problems.push(problem(error))).ok()
}

fn known_kinds() -> String {
    TargetKind::ALL.map(TargetKind::name).join(", ")
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    if let Some(integer) = value.as_integer() {
        return i64::from_str_radix(integer.as_str(), integer.radix()).ok().map(|integer| integer as f64);
    }
    value.as_float().and_then(|float| float.as_str().parse().ok())
}
