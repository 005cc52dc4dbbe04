//! Names of views: a photograph of several boards is a view for each of them, with a pose of its own.

/// The name of the view of a board, counted from 1, in a photograph that is called `photo`.
pub fn view_of(photo: &str, board: usize) -> String {
    format!("{photo}#{board}")
}

/// What the photograph is called in which a view of that name is one of several boards; `None` for the name of a whole photograph.
pub fn photo_of(view: &str) -> Option<&str> {
    let (photo, board) = view.rsplit_once('#')?;
    (!photo.is_empty() && !board.is_empty() && board.bytes().all(|digit| digit.is_ascii_digit())).then_some(photo)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_tells_its_photograph() {
        assert_eq!(photo_of(&view_of("a#b.png", 12)), Some("a#b.png"));
        for whole in ["a.png", "a#b.png", "a.png#", "#3", "a.png#1x"] {
            assert_eq!(photo_of(whole), None, "{whole}");
        }
    }
}
