//! Reasons below a table, said once: the cells refer to them by a letter.

/// The reasons so far, in the order of their letters.
#[derive(Debug, Default)]
pub struct Notes(Vec<String>);

impl Notes {
    /// The mark that stands for `reason`, as in ` (a)`; nothing for an empty one.
    pub fn mark(&mut self, reason: &str) -> String {
        if reason.is_empty() {
            return String::new();
        }
        let index = self.0.iter().position(|known| known == reason).unwrap_or_else(|| {
            self.0.push(reason.to_owned());
            self.0.len() - 1
        });
        format!(" ({})", letters(index))
    }

    /// The list of reasons; nothing where there are none.
    pub fn render(&self) -> String {
        let lines: String = self.0.iter().enumerate().map(|(index, reason)| format!("- ({}) {reason}\n", letters(index))).collect();
        if lines.is_empty() { lines } else { lines + "\n" }
    }
}

/// a to z, then aa, ab, ...
fn letters(index: usize) -> String {
    let letter = |place: usize| char::from(b'a' + (place % 26) as u8);
    if index < 26 { letter(index).to_string() } else { letters(index / 26 - 1) + &letter(index).to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_has_one_letter() {
        let mut notes = Notes::default();
        assert_eq!(
            (notes.mark("x"), notes.mark("y"), notes.mark("x"), notes.mark("")),
            (" (a)".into(), " (b)".into(), " (a)".into(), String::new())
        );
        assert_eq!(notes.render(), "- (a) x\n- (b) y\n\n");
        assert_eq!((letters(25), letters(26), letters(27), letters(701)), ("z".into(), "aa".into(), "ab".into(), "zz".into()));
    }
}
