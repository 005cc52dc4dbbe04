//! Stations, targets, methods and camera models that tables name.

use calibench_calibrate::MODELS;
use calibench_diagnostics::Problem;
use glob::Pattern;
use toml::Spanned;

/// The places of names in a list; unknown names and names that stand twice are problems.
pub(crate) fn places(what: &str, names: &[Spanned<String>], known: &[&str], problems: &mut Vec<Problem>) -> Vec<usize> {
    let mut found = Vec::new();
    for name in names {
        match known.iter().position(|known| known == name.get_ref()) {
            None => {
                let problem = Problem::new(name.span(), format!("no {what} is called `{}`", name.get_ref()));
                problems.push(problem.nearest(name.get_ref(), known.iter().copied()));
            }
            Some(place) if found.contains(&place) => {
                problems.push(Problem::new(name.span(), format!("`{}` stands twice: expected each {what} once", name.get_ref())));
            }
            Some(place) => found.push(place),
        }
    }
    found
}

/// A list that is there and empty is a problem.
pub(crate) fn filled<T>(key: &str, list: Option<&Spanned<Vec<T>>>, problems: &mut Vec<Problem>) {
    if let Some(empty) = list.filter(|list| list.get_ref().is_empty()) {
        problems.push(Problem::new(empty.span(), format!("`{key}` is empty: expected at least one")));
    }
}

/// The places of names that match a pattern; a pattern that none matches is a problem.
pub(crate) fn matched(what: &str, patterns: &[Spanned<String>], known: &[&str], problems: &mut Vec<Problem>) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    for written in patterns {
        let fits: Vec<usize> = match Pattern::new(written.get_ref()) {
            Ok(pattern) => (0..known.len()).filter(|&i| pattern.matches(known[i])).collect(),
            Err(error) => {
                problems.push(Problem::new(written.span(), format!("`{}` is no pattern: {}", written.get_ref(), error.msg)));
                continue;
            }
        };
        if fits.is_empty() {
            let problem = Problem::new(written.span(), format!("no {what} is called `{}`", written.get_ref()));
            problems.push(problem.nearest(written.get_ref(), known.iter().copied()));
        }
        found.extend(fits);
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// A name that is that of no camera model is a problem.
pub(crate) fn check_model(model: &Spanned<String>, problems: &mut Vec<Problem>) {
    let name = model.get_ref();
    if !MODELS.contains(&name.as_str()) {
        let message = format!("`{name}` is no camera model: expected one of {}", MODELS.join(", "));
        problems.push(Problem::new(model.span(), message).nearest(name, MODELS));
    }
}
