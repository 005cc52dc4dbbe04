//! Our own Markdown as HTML: the same text, with tables that sort and figures in the place of pictures.

use std::collections::HashMap;

use pulldown_cmark::{Alignment, CodeBlockKind, Event, HeadingLevel, Options, Parser, Tag, TagEnd};

use super::Section;
use crate::markdown::anchor;
use crate::markup::escaped;

/// What stands in the place of a picture, by the picture's file name: empty for one that another shows as well. Each is used once.
pub(crate) type Figures = HashMap<String, String>;
/// Groups that are chosen together, by the text of the first cell of a table's row.
pub(crate) type Groups = HashMap<String, usize>;

/// The figure of a picture, by its file and its caption.
type FigureOf<'a> = &'a mut dyn FnMut(&str, &str) -> Option<String>;
/// Where a link goes: an address, an anchor, or nowhere.
type LinkTo<'a> = &'a dyn Fn(&str) -> Option<String>;

/// The sections of a text: one for each heading of level 2, and before them one without a heading of its own if there is anything. The title is left out.
pub(super) fn sections(text: &str, figures: &mut Figures, groups: &Groups) -> Vec<Section> {
    let mut figure = |file: &str, _: &str| figures.remove(file);
    let link = |target: &str| Some(target.to_owned());
    let mut writer = Writer::new(&mut figure, groups, &link, None);
    writer.all(text);
    writer.close();
    writer.sections
}

/// A page as a part of another one.
pub(crate) struct Converted {
    /// Its title, as HTML.
    pub(crate) title: String,
    /// Its first paragraph, as HTML.
    pub(crate) lead: String,
    /// What is below the title; headings are of one level less.
    pub(crate) body: String,
}

/// A page of an anchor within another one: its own anchors begin with that one. `link` says to which anchor of the whole a link goes.
pub(crate) fn in_place(text: &str, id: &str, figure: FigureOf<'_>, link: LinkTo<'_>) -> Converted {
    let groups = Groups::new();
    let anchors = |target: &str| link(target).map(|anchor| format!("#{anchor}"));
    let mut writer = Writer::new(figure, &groups, &anchors, Some(id));
    writer.all(text);
    Converted { title: writer.title, lead: writer.lead.unwrap_or_default(), body: writer.out }
}

struct Writer<'a> {
    figure: FigureOf<'a>,
    groups: &'a Groups,
    link: LinkTo<'a>,
    /// Of a page within another one.
    id: Option<&'a str>,
    title: String,
    /// The first paragraph.
    lead: Option<String>,
    sections: Vec<Section>,
    /// What is being written: the body of the last section.
    out: String,
    anchors: HashMap<String, usize>,
    /// Where a paragraph began.
    paragraph: Option<usize>,
    /// The caption of the last picture, as HTML: a paragraph below that says the same is said by its figure.
    caption: String,
    tables: usize,
}

impl<'a> Writer<'a> {
    fn new(figure: FigureOf<'a>, groups: &'a Groups, link: LinkTo<'a>, id: Option<&'a str>) -> Self {
        Self {
            figure,
            groups,
            link,
            id,
            title: String::new(),
            lead: None,
            sections: Vec::new(),
            out: String::new(),
            anchors: HashMap::new(),
            paragraph: None,
            caption: String::new(),
            tables: 0,
        }
    }

    fn all(&mut self, text: &str) {
        let mut events = Parser::new_ext(text, Options::ENABLE_TABLES);
        while let Some(event) = events.next() {
            self.event(event, &mut events);
        }
    }
}

impl Writer<'_> {
    fn event<'e>(&mut self, event: Event<'e>, rest: &mut impl Iterator<Item = Event<'e>>) {
        match event {
            Event::Start(Tag::Heading { level, .. }) => self.heading(level, rest),
            Event::Start(Tag::Table(alignments)) => self.table(&alignments, rest),
            Event::Start(Tag::Image { dest_url, .. }) => self.picture(&dest_url, rest),
            Event::Start(Tag::Paragraph) => self.paragraph = Some(self.out.len()),
            Event::End(TagEnd::Paragraph) => self.end_paragraph(),
            event => self.inline(event),
        }
    }

    fn inline(&mut self, event: Event<'_>) {
        match event {
            Event::Start(Tag::List(Some(_))) => self.out.push_str("<ol>"),
            Event::Start(Tag::List(None)) => self.out.push_str("<ul>"),
            Event::Start(Tag::Item) => self.out.push_str("<li>"),
            Event::Start(Tag::Strong) => self.out.push_str("<strong>"),
            Event::Start(Tag::Emphasis) => self.out.push_str("<em>"),
            Event::Start(Tag::BlockQuote(_)) => self.out.push_str("<blockquote>"),
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(_) | CodeBlockKind::Indented)) => self.out.push_str("<pre><code>"),
            Event::Start(Tag::Link { dest_url, .. }) => {
                let target = (self.link)(&dest_url).map_or(String::new(), |target| format!(" href=\"{}\"", escaped(&target)));
                self.out.push_str(&format!("<a{target}>"));
            }
            Event::End(end) => self.out.push_str(closing(end)),
            Event::Code(code) => self.out.push_str(&format!("<code>{}</code>", escaped(&code))),
            // What is HTML in the text was not written by us: it is shown and not obeyed.
            Event::Text(text) | Event::Html(text) | Event::InlineHtml(text) => self.out.push_str(&escaped(&text)),
            Event::SoftBreak => self.out.push('\n'),
            Event::HardBreak => self.out.push_str("<br>"),
            Event::Rule => self.out.push_str("<hr>"),
            _ => {}
        }
    }

    /// What stands up to the end of a tag, as HTML.
    fn aside<'e>(&mut self, end: TagEnd, rest: &mut impl Iterator<Item = Event<'e>>) -> (String, String) {
        let outer = std::mem::take(&mut self.out);
        let mut plain = String::new();
        for event in rest.by_ref() {
            match event {
                Event::End(found) if found == end => break,
                event => {
                    if let Event::Text(text) | Event::Code(text) = &event {
                        plain.push_str(text);
                    }
                    self.inline(event);
                }
            }
        }
        (std::mem::replace(&mut self.out, outer), plain)
    }

    fn heading<'e>(&mut self, level: HeadingLevel, rest: &mut impl Iterator<Item = Event<'e>>) {
        let (html, plain) = self.aside(TagEnd::Heading(level), rest);
        let anchor = self.unique(anchor(&plain));
        let (anchor, level) = match (self.id, level) {
            (_, HeadingLevel::H1) => return self.title = html,
            (Some(id), HeadingLevel::H2) => (format!("{id}--{anchor}"), HeadingLevel::H3),
            (Some(id), _) => (format!("{id}--{anchor}"), HeadingLevel::H4),
            (None, level) => (anchor, level),
        };
        match level {
            HeadingLevel::H2 => {
                self.close();
                self.sections.push(Section { anchor, heading: html, body: String::new() });
            }
            level => self.out.push_str(&format!("<{level} id=\"{anchor}\">{html}</{level}>\n")),
        }
    }

    fn unique(&mut self, anchor: String) -> String {
        let count = self.anchors.entry(anchor.clone()).or_default();
        *count += 1;
        if *count > 1 { format!("{anchor}-{count}") } else { anchor }
    }

    /// Puts what was written below the last heading.
    fn close(&mut self) {
        let body = std::mem::take(&mut self.out);
        if body.trim().is_empty() && self.sections.is_empty() {
            return;
        }
        match self.sections.last_mut() {
            Some(section) => section.body.push_str(&body),
            None => self.sections.push(Section { anchor: "result".into(), heading: "Result".into(), body }),
        }
    }

    fn end_paragraph(&mut self) {
        let Some(start) = self.paragraph.take() else { return };
        let body = self.out.split_off(start);
        let is_figure = body.trim().is_empty() || body.starts_with("<figure");
        if !is_figure && body == std::mem::take(&mut self.caption) {
            return;
        }
        if !is_figure && self.lead.is_none() {
            self.lead = Some(body.clone());
        }
        self.out.push_str(&if is_figure { body } else { format!("<p>{body}</p>\n") });
    }

    fn picture<'e>(&mut self, file: &str, rest: &mut impl Iterator<Item = Event<'e>>) {
        let (html, caption) = self.aside(TagEnd::Image, rest);
        self.caption = html;
        match (self.figure)(file, &caption) {
            Some(figure) => self.out.push_str(&figure),
            None => self.out.push_str(&format!("<figure><figcaption>{} ({})</figcaption></figure>", escaped(&caption), escaped(file))),
        }
    }

    fn table<'e>(&mut self, alignments: &[Alignment], rest: &mut impl Iterator<Item = Event<'e>>) {
        self.tables += 1;
        let id = self.id.map_or(String::new(), |id| format!("{id}-"));
        self.out.push_str(&format!("<div class=\"table\"><table class=\"data\" id=\"t-{id}{}\"><thead><tr>", self.tables));
        let (mut column, mut is_head) = (0, true);
        while let Some(event) = rest.next() {
            match event {
                Event::End(TagEnd::Table) => break,
                Event::Start(Tag::TableCell) => {
                    let (html, plain) = self.aside(TagEnd::TableCell, rest);
                    let numeric = alignments.get(column) == Some(&Alignment::Right);
                    if column == 0 && !is_head {
                        let group = self.groups.get(&plain).map_or(String::new(), |group| format!(" data-g=\"{group}\""));
                        self.out.push_str(&format!("<tr{group}>"));
                    }
                    self.out.push_str(&cell(is_head, numeric, &html));
                    column += 1;
                }
                Event::End(TagEnd::TableHead) => {
                    self.out.push_str("</tr></thead><tbody>\n");
                    (is_head, column) = (false, 0);
                }
                Event::End(TagEnd::TableRow) => {
                    self.out.push_str("</tr>\n");
                    column = 0;
                }
                _ => {}
            }
        }
        self.out.push_str("</tbody></table></div>\n");
    }
}

fn cell(is_head: bool, numeric: bool, html: &str) -> String {
    match (is_head, numeric) {
        (true, true) => format!("<th scope=\"col\" class=\"n\">{html}</th>"),
        (true, false) => format!("<th scope=\"col\">{html}</th>"),
        (false, false) => format!("<td>{html}</td>"),
        // The script sorts it by the number that it begins with.
        (false, true) => format!("<td class=\"n\">{html}</td>"),
    }
}

const fn closing(end: TagEnd) -> &'static str {
    match end {
        TagEnd::List(true) => "</ol>\n",
        TagEnd::List(false) => "</ul>\n",
        TagEnd::Item => "</li>\n",
        TagEnd::Strong => "</strong>",
        TagEnd::Emphasis => "</em>",
        TagEnd::BlockQuote(_) => "</blockquote>\n",
        TagEnd::CodeBlock => "</code></pre>\n",
        TagEnd::Link => "</a>",
        _ => "",
    }
}
