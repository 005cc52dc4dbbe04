//! Text within HTML.

use std::fmt::Write;

use calibench_model::escape;

/// A text within HTML or a quoted attribute: markup and what a terminal would take for a command are shown as they are written.
pub fn escaped(text: &str) -> String {
    escape::markup(&escape::message(text), |c| match c {
        '"' => Some("&quot;".into()),
        '\'' => Some("&#39;".into()),
        _ => None,
    })
}

/// A text that stands between bars in an attribute.
pub(crate) fn between_bars(text: &str) -> String {
    escaped(&text.replace('\\', "\\\\").replace('|', "\\|"))
}

/// JSON within a script element: no `<` ends it, and nothing in it turns the direction of writing.
pub fn json(value: &serde_json::Value) -> String {
    let mut out = String::new();
    for c in value.to_string().chars() {
        if c == '<' || escape::is_command(c) {
            // All of them are in the first plane. Writing to a String cannot fail.
            let _ = write!(out, "\\u{:04x}", u32::from(c));
        } else {
            out.push(c);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_text() {
        assert_eq!(escaped("<img src=x onerror='a'>&\"\u{202e}"), "&lt;img src=x onerror=&#39;a&#39;&gt;&amp;&quot;\\u{202e}");
        assert_eq!(between_bars("a|b\\c"), "a\\|b\\\\c");
        assert_eq!(json(&serde_json::json!(["</script>"])), "[\"\\u003c/script>\"]");
    }
}
