//! Putting a value in the place that a swept key names.

use std::borrow::Cow;
use std::ops::Range;

use calibench_diagnostics::Problem;
use calibench_measure::Registry;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::axis::Axis;

/// Replaces the value of `axis` in `table`, or adds it: a key that the file may not have is found out when its table is read, at its place in
/// the sweep. Of a list of tables those that the path names by index, `id` or `name` are meant, or all; of methods all with such a parameter.
pub(super) fn replace<'i>(
    table: &mut DeTable<'i>,
    axis: &'i Axis,
    value: &Spanned<DeValue<'i>>,
    registry: &Registry,
    problems: &mut Vec<Problem>,
) {
    let parts: Vec<&'i str> = axis.path.split('.').collect();
    if let ["method", rest @ ..] = &parts[..]
        && let Some(DeValue::Array(methods)) = table.get_mut("method").map(Spanned::get_mut)
    {
        return in_methods(methods, rest, axis, value, registry, problems);
    }
    if !in_table(table, &parts, &axis.span, value) {
        problems.push(Problem::new(axis.span.clone(), format!("`{}` names no key of the file", axis.path)));
    }
}

fn in_table<'i>(table: &mut DeTable<'i>, parts: &[&'i str], span: &Range<usize>, value: &Spanned<DeValue<'i>>) -> bool {
    let Some((first, rest)) = parts.split_first() else { return false };
    let key = || Spanned::new(span.clone(), Cow::Borrowed(*first));
    if rest.is_empty() {
        match table.get_mut(*first) {
            Some(old) => *old = value.clone(),
            None => drop(table.insert(key(), value.clone())),
        }
        return true;
    }
    let empty = || Spanned::new(span.clone(), DeValue::Table(DeTable::new()));
    in_value(table.entry(key()).or_insert_with(empty).get_mut(), rest, span, value)
}

fn in_value<'i>(old: &mut DeValue<'i>, parts: &[&'i str], span: &Range<usize>, value: &Spanned<DeValue<'i>>) -> bool {
    match old {
        DeValue::Table(table) => in_table(table, parts, span, value),
        DeValue::Array(list) => in_list(list, parts, span, value),
        _ => false,
    }
}

fn in_list<'i>(list: &mut DeArray<'i>, parts: &[&'i str], span: &Range<usize>, value: &Spanned<DeValue<'i>>) -> bool {
    let Some((first, rest)) = parts.split_first() else { return false };
    if let Ok(index) = first.parse::<usize>() {
        return match (list.get_mut(index), rest.is_empty()) {
            (Some(element), true) => {
                *element = value.clone();
                true
            }
            (Some(element), false) => in_value(element.get_mut(), rest, span, value),
            (None, _) => false,
        };
    }
    let named = list.iter().any(|element| is_named(element.get_ref(), first));
    let mut done = false;
    for element in list.iter_mut() {
        let DeValue::Table(table) = element.get_mut() else { continue };
        if !named {
            done |= in_table(table, parts, span, value);
        } else if is_called(table, first) {
            done |= in_table(table, rest, span, value);
        }
    }
    done
}

fn is_named(element: &DeValue<'_>, name: &str) -> bool {
    matches!(element, DeValue::Table(table) if is_called(table, name))
}

fn is_called(table: &DeTable<'_>, name: &str) -> bool {
    ["id", "name"].iter().any(|key| table.get(*key).and_then(|value| value.get_ref().as_str()) == Some(name))
}

/// The parameters of methods: `[parameter]` of all that have it, or `[method, parameter]`.
fn in_methods<'i>(
    methods: &mut DeArray<'i>,
    parts: &[&'i str],
    axis: &'i Axis,
    value: &Spanned<DeValue<'i>>,
    registry: &Registry,
    problems: &mut Vec<Problem>,
) {
    let (only, key) = match *parts {
        [key] => (None, key),
        [method, key] => (Some(method), key),
        _ => {
            let problem = Problem::new(axis.span.clone(), format!("`{}` names no parameter of a method", axis.path));
            problems.push(problem.help("as in \"method.window\", or \"method.forstner.window\" for one of the methods"));
            return;
        }
    };
    let (mut names, mut known, mut done) = (Vec::new(), Vec::new(), false);
    for element in methods.iter_mut() {
        let DeValue::Table(table) = element.get_mut() else { continue };
        let Some(name) = table.get("name").and_then(|name| name.get_ref().as_str().map(str::to_owned)) else { continue };
        let parameters = registry.methods().iter().find(|method| method.name == name).map_or(&[][..], |method| method.parameters);
        if only.is_none_or(|only| only == name) {
            known.extend(parameters.iter().map(|parameter| parameter.name));
            if parameters.iter().any(|parameter| parameter.name == key) {
                done |= in_table(table, &[key], &axis.span, value);
            }
        }
        names.push(name);
    }
    if done {
        return;
    }
    let of = only.map_or(String::new(), |only| format!(" called `{only}`"));
    let problem = Problem::new(axis.span.clone(), format!("no method of the scenario{of} has a parameter `{key}`"));
    let problem = match only.filter(|only| names.iter().all(|name| name != only)) {
        Some(only) => problem.nearest(only, names.iter().map(String::as_str)),
        None => problem.nearest(key, known),
    };
    problems.push(problem);
}
