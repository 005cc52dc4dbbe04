//! Where the keys of a testfield stand in the file.

use std::ops::Range;

use crate::section::Section;

/// Where keys and named things stand.
#[derive(Clone, Debug, Default)]
pub struct Spans {
    pub whole: Range<usize>,
    keys: Vec<(String, Range<usize>)>,
    ids: Vec<(String, Range<usize>)>,
}

impl Spans {
    /// Of the table itself and its keys.
    pub fn of(section: &Section<'_>) -> Self {
        let mut spans = Self { whole: section.span.clone(), ..Self::default() };
        spans.add(section);
        spans
    }

    /// Adds the keys of a table within, and its name under `id` or `name`.
    pub fn add(&mut self, section: &Section<'_>) {
        for (key, value) in &section.table {
            self.keys.push((key.get_ref().to_string(), value.span()));
            if let ("id" | "name", Some(name)) = (key.get_ref().as_ref(), value.get_ref().as_str()) {
                self.ids.push((name.to_owned(), value.span()));
            }
        }
    }

    /// The value of a key, if it stands in one place only.
    pub fn of_key(&self, name: &str) -> Option<Range<usize>> {
        let mut found = self.keys.iter().filter(|(key, _)| key == name);
        let first = found.next()?;
        found.next().is_none().then(|| first.1.clone())
    }

    /// The last place of a name: of two that are equal the second is the mistake.
    pub fn of_id(&self, name: &str) -> Option<Range<usize>> {
        self.ids.iter().rfind(|(id, _)| id == name).map(|(_, span)| span.clone())
    }
}
