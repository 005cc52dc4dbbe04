//! What a test decides.

/// Of a value or of a whole test; the worse, the larger.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Decision {
    /// It conforms.
    Pass,
    /// Neither conformity nor the contrary is shown.
    CannotTell,
    /// It does not conform.
    Fail,
}

impl Decision {
    /// That of a whole, which is as its worst part; one without parts cannot be told.
    pub fn of_all(parts: impl IntoIterator<Item = Self>) -> Self {
        parts.into_iter().max().unwrap_or(Self::CannotTell)
    }

    /// In words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::CannotTell => "cannot tell",
            Self::Fail => "fail",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Decision::{self, CannotTell, Fail, Pass};

    #[test]
    fn a_whole_is_as_its_worst_part() {
        for (parts, whole) in
            [(&[Pass, Pass][..], Pass), (&[Pass, CannotTell], CannotTell), (&[Fail, CannotTell, Pass], Fail), (&[], CannotTell)]
        {
            assert_eq!(Decision::of_all(parts.iter().copied()), whole, "{parts:?}");
        }
    }
}
