//! A document of PDF/A-3b: pages of text, lines and grey or coloured areas, with files attached.

mod colours;
mod metadata;
mod paper;

use calibench_prints::deflated;
use pdf_writer::types::{AssociationKind, OutputIntentSubtype};
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};

pub use paper::{GREY, INK, Paper, SIZE, Style};

/// A file that is attached to the document, which is not compressed, so that it is found without a reader of PDF.
pub struct Attachment<'a> {
    /// Its name.
    pub name: &'a str,
    /// What it is, in words.
    pub about: &'a str,
    /// MIME type.
    pub kind: &'a str,
    /// The file.
    pub content: &'a [u8],
}

/// What a document says of itself.
pub struct About<'a> {
    /// Its title.
    pub title: &'a str,
    /// What is unique about it.
    pub identifier: &'a str,
    /// The program that wrote it.
    pub program: &'a str,
}

/// The document. The same pages give the same bytes.
pub fn document(paper: Paper, about: &About<'_>, attachments: &[Attachment<'_>]) -> Vec<u8> {
    let mut last = 0;
    let mut next = || {
        last += 1;
        Ref::new(last)
    };
    let [catalog, tree, info, metadata, profile, regular, bold] = std::array::from_fn(|_| next());
    let pages: Vec<[Ref; 2]> = paper.pages.iter().map(|_| [next(), next()]).collect();
    let files: Vec<[Ref; 2]> = attachments.iter().map(|_| [next(), next()]).collect();
    let mut pdf = Pdf::new();
    write_catalog(&mut pdf, [catalog, tree, metadata, profile], &files, attachments);
    pdf.pages(tree).kids(pages.iter().map(|[page, _]| *page)).count(pages.len() as i32);
    pdf.document_info(info).title(TextStr(about.title)).producer(TextStr(about.program));
    pdf.stream(metadata, metadata::xmp(about).as_bytes()).pair(Name(b"Type"), Name(b"Metadata")).pair(Name(b"Subtype"), Name(b"XML"));
    let colours = deflated(&colours::profile());
    pdf.icc_profile(profile, &colours).n(3).filter(Filter::FlateDecode);
    for ([page, content], text) in pages.iter().zip(&paper.pages) {
        let mut leaf = pdf.page(*page);
        leaf.parent(tree).media_box(Rect::new(0.0, 0.0, SIZE[0] as f32, SIZE[1] as f32)).contents(*content);
        leaf.resources().fonts().pair(Name(b"R"), regular).pair(Name(b"B"), bold);
        leaf.finish();
        pdf.stream(*content, &deflated(text.as_bytes())).filter(Filter::FlateDecode);
    }
    for ([about, stream], attachment) in files.iter().zip(attachments) {
        attach(&mut pdf, [*about, *stream], attachment);
    }
    paper.regular.write(&mut pdf, regular, &mut next);
    paper.bold.write(&mut pdf, bold, &mut next);
    let id = about.identifier.as_bytes().get(..32).unwrap_or_default().to_vec();
    pdf.set_file_id((id.clone(), id));
    pdf.finish()
}

fn write_catalog(pdf: &mut Pdf, [catalog, tree, metadata, profile]: [Ref; 4], files: &[[Ref; 2]], attachments: &[Attachment<'_>]) {
    let mut root = pdf.catalog(catalog);
    root.pages(tree).metadata(metadata).lang(TextStr("en"));
    root.viewer_preferences().display_doc_title(true);
    root.output_intents()
        .push()
        .subtype(OutputIntentSubtype::PDFA)
        .output_condition_identifier(TextStr("sRGB"))
        .info(TextStr(colours::NAME))
        .dest_output_profile(profile);
    let mut named: Vec<(&[u8], Ref)> = attachments.iter().zip(files).map(|(file, [about, _])| (file.name.as_bytes(), *about)).collect();
    named.sort_unstable();
    let mut names = root.names();
    let mut tree = names.embedded_files();
    let mut entries = tree.names();
    for (name, about) in named {
        entries.insert(Str(name), about);
    }
    entries.finish();
    tree.finish();
    names.finish();
    root.insert(Name(b"AF")).array().items(files.iter().map(|[about, _]| *about));
}

fn attach(pdf: &mut Pdf, [about, stream]: [Ref; 2], attachment: &Attachment<'_>) {
    let mut spec = pdf.file_spec(about);
    spec.path(Str(attachment.name.as_bytes())).unic_file(TextStr(attachment.name)).description(TextStr(attachment.about));
    spec.association_kind(AssociationKind::Source);
    spec.embedded_file_with_unicode(stream);
    spec.finish();
    let mut file = pdf.embedded_file(stream, attachment.content);
    file.subtype(Name(attachment.kind.as_bytes()));
    file.params().size(attachment.content.len() as i32);
}
