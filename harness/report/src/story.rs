//! A story as one page: what was done, step by step, with pictures.

use crate::Canvas;
use crate::html::{Drawing, Figures, Groups, Level, Page};

/// A picture of a story: its name in the text, its caption, and the picture itself.
pub type Illustration = (String, String, Canvas);

/// A page that needs nothing beside it: `text` is Markdown with a section for each heading of level 2, in which pictures stand by their names. `lead` says in a
/// sentence what came out, `is_sound` whether nothing of it is in doubt.
pub fn story(title: &str, (lead, is_sound): (&str, bool), text: &str, pictures: &[Illustration]) -> String {
    let mut page = Page::new(title);
    page.verdict(if is_sound { Level::Good } else { Level::Doubt }, lead, []);
    let figure = |(place, (name, caption, canvas)): (usize, &Illustration)| {
        (name.clone(), Drawing::of(canvas).figure(&format!("picture-{}", place + 1), caption))
    };
    let mut figures: Figures = pictures.iter().enumerate().map(figure).collect();
    page.markdown(text, &mut figures, &Groups::new());
    page.render()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_story_has_its_pictures_where_the_text_names_them() {
        let picture = || ("a.png".to_owned(), "a caption".to_owned(), Canvas::new(20, 10));
        let text = "# T\n\n## First\n\nwords\n\n![a caption](a.png)\n\n## Second\n\n```console\n$ command <x>\n```\n";
        let page = story("A <story>", ("all is well", true), text, &[picture()]);
        for part in [
            "<h1>A &lt;story&gt;</h1>",
            "class=\"verdict good\"",
            "all is well",
            "<h2>First</h2>",
            "picture-1",
            "a caption",
            "$ command &lt;x&gt;",
        ] {
            assert!(page.contains(part), "{part}: {page}");
        }
        let (first, second) = (page.find("picture-1").unwrap(), page.find("<h2>Second").unwrap());
        assert!(first < second && !page.contains("a.png\""));
        assert!(story("T", ("hm", false), "", &[]).contains("class=\"verdict doubt\""));
    }
}
