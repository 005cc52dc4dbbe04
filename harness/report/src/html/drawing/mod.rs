//! A picture as a drawing of lines: what was drawn, once more.

mod colour;
mod letters;
mod pencil;
mod series;

use crate::Canvas;
use crate::markup::escaped;

/// A picture as a drawing, before it is known where it stands.
pub(crate) struct Drawing {
    size: (u32, u32),
    attributes: String,
    inside: String,
}

impl Drawing {
    /// What was drawn.
    pub(crate) fn of(canvas: &Canvas) -> Self {
        Self { size: (canvas.width(), canvas.height()), attributes: series::attributes(canvas), inside: series::groups(canvas.strokes()) }
    }

    /// The figure, with a caption.
    pub(crate) fn figure(&self, id: &str, caption: &str) -> String {
        let Self { size: (width, height), attributes, inside } = self;
        let (id, caption) = (escaped(id), escaped(caption));
        format!(
            "<figure class=\"plot\" id=\"{id}\"><svg class=\"still\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{caption}\" data-box=\"0 0 {width} {height}\">\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/><g class=\"marks\" fill=\"none\"{attributes}>{inside}</g></svg><figcaption>{caption}</figcaption></figure>\n"
        )
    }
}

/// What was drawn as a file of SVG that needs nothing beside it.
pub(crate) fn svg(canvas: &Canvas) -> String {
    let (width, height) = (canvas.width(), canvas.height());
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"'Noto Sans', sans-serif\">\n<desc>Drawn by calibench {}.</desc>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n<g fill=\"none\">{}</g>\n</svg>\n",
        env!("CARGO_PKG_VERSION"),
        series::named(canvas)
    )
}

#[cfg(test)]
mod tests {
    use plotters::prelude::*;

    use super::*;

    /// What is drawn on a canvas is in the drawing once: lines, texts with their markup as text, and the caption.
    #[test]
    fn a_drawing_holds_what_was_drawn() {
        let mut canvas = Canvas::new(200, 100);
        canvas.text("a < b", 12, (20, 30));
        canvas.frame((10, 10), (50, 40));
        canvas.paint(|area| {
            area.draw(&PathElement::new([(1, 2), (3, 4)], RED)).ok();
        });
        let html = Drawing::of(&canvas).figure("f--a", "it's <b>");
        for part in [
            "id=\"f--a\"",
            "viewBox=\"0 0 200 100\"",
            "a &lt; b</text>",
            "it&#39;s &lt;b&gt;</figcaption>",
            "M10 10h50v40h-50z",
            "stroke=\"#f00\" d=\"M1 2l2 2\"",
        ] {
            assert_eq!(html.matches(part).count(), 1, "{part}: {html}");
        }
    }
}
