//! What a scenario is to show, without making anything of what it describes.

use calibench_diagnostics::{Problem, Problems};
use toml::de::{DeTable, DeValue};

/// The `why` of a scenario's `text`, that of `file`, as it stands there. Nothing else is read of it or checked: no field is laid out, no station drawn.
///
/// # Errors
/// What is no TOML, and a text without `why`, with its place.
pub(crate) fn why(file: &str, text: &str) -> Result<String, Problems> {
    let wrong = |problems| Problems { file: file.to_owned(), text: text.to_owned(), problems };
    let (root, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        return Err(wrong(errors.iter().map(|error| Problem::new(error.span().unwrap_or(0..0), error.message())).collect()));
    }
    let missing = || wrong(vec![Problem::new(0..0, "missing key `why` in the scenario: expected a sentence on what it is to show")]);
    let value = root.get_ref().get("why").ok_or_else(missing)?;
    match value.get_ref() {
        DeValue::String(why) => Ok(why.to_string()),
        _ => Err(wrong(vec![Problem::new(value.span(), "`why` is a text: expected a sentence on what the scenario is to show")])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_read_of_a_scenario_that_could_not_be_laid_out() {
        assert_eq!(why("a.toml", "why = \"to see\"\nseed = -1\n[testfield]\nkind = 7\n").unwrap(), "to see");
        assert_eq!(why("a.toml", "[scene]\nwidth = 3\n").unwrap_err().problems.len(), 1);
        let wrong = why("a.toml", "seed = 1\nwhy = 3\n").unwrap_err();
        assert_eq!(wrong.place(wrong.problems[0].span.start), (2, 7));
        assert!(why("a.toml", "why = \"a\nb\"\n").is_err());
    }
}
