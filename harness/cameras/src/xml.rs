//! XML, within limits, with lines in errors.

use calibench_model::camera::ImageSize;
use calibench_model::escape;
use roxmltree::{Document, Node, ParsingOptions};

use super::CameraFileError;
use super::number::{finite, pixels, shortened};

/// Nodes at most: each takes memory.
const MOST_NODES: u32 = 2_000_000;
/// Attributes of one element at most: the parser compares each with each.
const MOST_ATTRIBUTES: usize = 1000;
/// Namespaces at most: the parser keeps a list of all for each element.
const MOST_NAMESPACES: usize = 32;

/// The tree of a text. DTDs, and so entities of its own, are refused.
pub(super) fn parse(text: &str) -> Result<Document<'_>, CameraFileError> {
    // A `<` cannot stand in an attribute's value: what is between two of them holds all attributes of an element.
    if text.split('<').any(|part| part.len() > MOST_ATTRIBUTES && part.matches('=').count() > MOST_ATTRIBUTES) {
        return Err(CameraFileError::new(format!("XML with more than {MOST_ATTRIBUTES} attributes in an element; expected a camera")));
    }
    if text.matches("xmlns").count() > MOST_NAMESPACES {
        return Err(CameraFileError::new(format!("XML with more than {MOST_NAMESPACES} namespaces; expected a camera")));
    }
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        let problem = match error {
            roxmltree::Error::DtdDetected => "XML with a DTD is refused: entities can hide anything".to_owned(),
            roxmltree::Error::NodesLimitReached => format!("XML with more than {MOST_NODES} nodes; expected a camera"),
            ref other => format!("not well-formed XML: {other}"),
        };
        let at = error.pos();
        CameraFileError::new(problem).on_line(at.row as usize).in_column(at.col as usize)
    })
}

/// `error` at the place of `node`.
pub(super) fn at(node: Node<'_, '_>, error: CameraFileError) -> CameraFileError {
    let place = node.document().text_pos_at(node.range().start);
    error.on_line(place.row as usize).in_column(place.col as usize).of(node.tag_name().name())
}

/// The children that are elements.
pub(super) fn elements<'a, 'input>(node: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    node.children().filter(Node::is_element)
}

/// The child called `name`, if there is one; two are a mistake.
pub(super) fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Result<Option<Node<'a, 'input>>, CameraFileError> {
    let mut found = elements(node).filter(|child| child.has_tag_name(name));
    let first = found.next();
    match found.next() {
        Some(second) => Err(at(second, CameraFileError::new(format!("stands in `{}` twice; expected once", node.tag_name().name())))),
        None => Ok(first),
    }
}

/// The child called `name`.
pub(super) fn required<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Result<Node<'a, 'input>, CameraFileError> {
    child(node, name)?.ok_or_else(|| at(node, CameraFileError::new(format!("has no element `{name}`"))))
}

/// The text of an element that holds nothing else.
pub(super) fn text<'a>(node: Node<'a, '_>) -> Result<&'a str, CameraFileError> {
    if let Some(inner) = elements(node).next() {
        return Err(at(inner, CameraFileError::new(format!("expected a value in `{}`, found an element", node.tag_name().name()))));
    }
    Ok(node.text().unwrap_or("").trim())
}

/// The number in the child called `name`; `None` without the child.
pub(super) fn number(node: Node<'_, '_>, name: &str) -> Result<Option<f64>, CameraFileError> {
    child(node, name)?.map(|child| finite(text(child)?).map_err(|error| at(child, error))).transpose()
}

/// The number in the child called `name`.
pub(super) fn required_number(node: Node<'_, '_>, name: &str) -> Result<f64, CameraFileError> {
    let child = required(node, name)?;
    finite(text(child)?).map_err(|error| at(child, error))
}

/// The size in the children `width` and `height`.
pub(super) fn size_of_children(node: Node<'_, '_>) -> Result<ImageSize, CameraFileError> {
    let side = |name| {
        let child = required(node, name)?;
        pixels(text(child)?).map_err(|error| at(child, error))
    };
    Ok(ImageSize { width: side("width")?, height: side("height")? })
}

/// The size in the attributes `width` and `height`.
pub(super) fn size_of_attributes(node: Node<'_, '_>) -> Result<ImageSize, CameraFileError> {
    let side = |name| pixels(attribute(node, name)?).map_err(|error| at(node, error));
    Ok(ImageSize { width: side("width")?, height: side("height")? })
}

/// An attribute that must be there.
pub(super) fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Result<&'a str, CameraFileError> {
    node.attribute(name).ok_or_else(|| at(node, CameraFileError::new(format!("has no attribute `{name}`"))))
}

/// Accepts this name of the root; the error says what it is instead.
pub(super) fn root_is(document: Option<&Document<'_>>, name: &str) -> Result<(), String> {
    let Some(document) = document else { return Err("is not XML".into()) };
    let found = document.root_element().tag_name().name();
    if found == name { Ok(()) } else { Err(format!("the root element is `{}`, not `{name}`", shortened(found))) }
}

/// Text as it stands in XML.
pub(super) fn escaped(text: &str) -> String {
    escape::markup(text, |c| match c {
        '"' => Some("&quot;".into()),
        // OpenCV refuses the bare character.
        '\'' => Some("&apos;".into()),
        '\t' | '\n' | '\r' => Some(format!("&#{};", c as u32).into()),
        // XML has no way to write other control characters.
        c if c.is_control() => Some("\u{fffd}".into()),
        _ => None,
    })
}
