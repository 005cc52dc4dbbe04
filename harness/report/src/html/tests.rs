use super::*;
use crate::plot::{Axis, Plot, Said, Shape};
use calibench_model::camera::ImageSize;

const HOSTILE: [&str; 4] = ["<img src=x onerror=alert(1)>.png", "</script><script>alert(2)</script>", "\"a\" & 'b'|c\\", "\u{202e}gnp.exe"];

fn converted(text: &str, figures: &[(&str, &str)], groups: &[(&str, usize)]) -> String {
    let mut figures: Figures = figures.iter().map(|(name, figure)| ((*name).to_owned(), (*figure).to_owned())).collect();
    let groups: Groups = groups.iter().map(|(name, group)| ((*name).to_owned(), *group)).collect();
    let mut page = Page::new("A page");
    page.markdown(text, &mut figures, &groups);
    let html = page.render();
    let (from, to) = (html.find("<main>").unwrap(), html.find("</main>").unwrap());
    html[from + 6..to].to_owned()
}

#[test]
fn a_text_is_the_same_text() {
    let text = "# Title\n\nBefore **bold** and `code`.\n\n## One *two*\n\n- a\n- b [c](d.md)\n\n### Below\n\n1. x\n";
    let html = converted(text, &[], &[]);
    assert_eq!(
        html.replace('\n', ""),
        "<section id=\"result\"><h2>Result</h2><p>Before <strong>bold</strong> and <code>code</code>.</p></section>\
         <section id=\"one-two\"><h2>One <em>two</em></h2><ul><li>a</li><li>b <a href=\"d.md\">c</a></li></ul>\
         <h3 id=\"below\">Below</h3><ol><li>x</li></ol></section>"
    );
}

#[test]
fn tables_know_their_numbers_and_their_groups() {
    let mut table = crate::markdown::MarkdownTable::new(&["image", "rms", "p"]);
    table.row(["a\\_b.png".into(), "0.25 \u{b1} 0.01".into(), "<0.0001".into()]);
    table.row(["c.png".into(), "-3.5e-5".into(), String::new()]);
    let html = converted(&format!("## T\n\n{}", table.render()), &[], &[("a_b.png", 7)]);
    assert!(html.contains("<th scope=\"col\">image</th><th scope=\"col\" class=\"n\">rms</th>"), "{html}");
    assert!(html.contains("<tr data-g=\"7\"><td>a_b.png</td><td class=\"n\">0.25 \u{b1} 0.01</td>"), "{html}");
    assert!(html.contains("<td class=\"n\">&lt;0.0001</td></tr>"), "{html}");
    assert!(html.contains("<tr><td>c.png</td><td class=\"n\">-3.5e-5</td><td class=\"n\"></td></tr>"), "{html}");
}

#[test]
fn pictures_become_figures_once_and_their_captions_are_not_said_twice() {
    let text = "## P\n\n![All of it](a.png)\n\nAll of it\n\n![Less](b.png)\n\nLess\n\nAll of it\n\n![Gone](c.png)\n\nGone\n";
    let html = converted(text, &[("a.png", "<figure>F</figure>"), ("b.png", "")], &[]);
    assert_eq!(
        html.replace('\n', ""),
        "<section id=\"p\"><h2>P</h2><figure>F</figure><p>All of it</p><figure><figcaption>Gone (c.png)</figcaption></figure></section>"
    );
}

#[test]
fn names_from_files_do_nothing() {
    for name in HOSTILE {
        let markdown = calibench_model::escape::markdown(name);
        let mut table = crate::markdown::MarkdownTable::new(&["image"]);
        table.row([markdown.clone().into_owned()]);
        let mut page = Page::new(name);
        page.verdict(Level::Doubt, name, [name.to_owned()]);
        page.markdown(
            &format!("{markdown}\n\n## {markdown}\n\n{}\n\n{}", table.render(), calibench_model::escape::code(name)),
            &mut Figures::new(),
            &Groups::new(),
        );
        // Not even a text that nobody escaped.
        page.markdown(&format!("## Raw\n\n{name}\n\n<div>{name}</div>\n"), &mut Figures::new(), &Groups::new());
        let mut plot = Plot::new(name, name, Axis::named(name, vec![name.to_owned()]), Axis::linear(name, [0.0, 1.0]), 200.0);
        plot.series(0, Some(name), &[name]);
        plot.legend(0, Shape::Circle, name, true);
        plot.symbol(Shape::Circle, (0.0, 0.5), &Said::of([name.to_owned()]));
        plot.note((0.0, 0.1), name, true);
        page.section(name, plot.figure(name));
        let station = Station {
            name: name.to_owned(),
            group: 0,
            centre: [0.0; 3],
            rotation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            half: [0.5; 2],
        };
        let point = ScenePoint { name: name.to_owned(), place: [1.0; 3], covariance: None, is_control: true };
        page.section("Scene", Scene { stations: vec![station], points: vec![point], rays: vec![[0, 0]], factor: 1.0 }.figure(name));
        let html = page.render();
        assert!(!html.contains("<img") && !html.contains("alert(2)</script>") && !html.contains('\u{202e}'), "{name}");
        assert_eq!(html.matches("<script").count(), 2, "that of the page and the scene's data: {name}");
    }
}

#[test]
fn a_page_asks_for_nothing() {
    let mut page = Page::new("A page");
    page.section("Plot", Plot::frame("f", "l", ImageSize { width: 640, height: 480 }).figure("c"));
    page.patch(3, "<img alt=\"\" src=\"data:image/png;base64,AA==\">");
    let html = page.render();
    assert!(html.contains("default-src 'none'") && html.contains("<figure class=\"patch\" data-k=\"3\">"));
    // Names of XML are no addresses that are asked for.
    let addresses = html.matches("://").count() - html.matches("http://www.w3.org/").count();
    assert_eq!(addresses, 0);
    for attribute in ["src=\"", "href=\""] {
        for found in html.split(attribute).skip(1) {
            assert!(found.starts_with("data:") || found.starts_with('#') || found.starts_with("${"), "{attribute}{}", &found[..20]);
        }
    }
    assert!(!html.contains("@import") && !html.contains("url("));
}
