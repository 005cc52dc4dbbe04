//! Figures that a text asks for in braces.

/// How what is asked for in braces may begin.
const KINDS: [&str; 8] = ["printed", "ours", "figure", "error", "mean", "median", "range", "ratio"];

/// The first `{` of `text` after which no figure is asked for.
pub fn not_asked(text: &str) -> Option<usize> {
    let mut braces = text.match_indices('{').map(|(at, _)| at);
    braces.find(|at| !KINDS.iter().any(|kind| text[at + 1..].strip_prefix(kind).is_some_and(|rest| rest.starts_with(' '))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brace_asks_for_a_figure_or_is_none() {
        assert_eq!([not_asked("a {ours b} {c}"), not_asked("{range b}"), not_asked("{ranges b}")], [Some(11), None, Some(0)]);
    }
}
