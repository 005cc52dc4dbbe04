//! A font in a document: the letters that are used, and no others.

use std::collections::BTreeMap;

use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, Str};
use subsetter::GlyphRemapper;
use ttf_parser::{Face, GlyphId};

use crate::deflated;

const SYSTEM: SystemInfo<'_> = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// A font to write with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Font {
    /// Noto Sans.
    Regular,
    /// Noto Sans Bold.
    Bold,
}

impl Font {
    /// TrueType.
    fn data(self) -> &'static [u8] {
        match self {
            Self::Regular => ttf_noto_sans::REGULAR,
            Self::Bold => ttf_noto_sans::BOLD,
        }
    }

    /// With the six letters that say that it is a part.
    fn name(self) -> Name<'static> {
        match self {
            Self::Regular => Name(b"CALIBE+NotoSans"),
            Self::Bold => Name(b"CALIBE+NotoSans-Bold"),
        }
    }
}

/// The letters that a document uses, each with its number in the document's font.
pub struct Lettering {
    font: Font,
    /// `None` for a font that cannot be read: no text then.
    face: Option<Face<'static>>,
    numbers: GlyphRemapper,
    /// Width, thousandths of an em, and letter of each number.
    used: BTreeMap<u16, (f32, char)>,
}

impl Lettering {
    /// None as yet.
    pub fn new(font: Font) -> Self {
        Self { font, face: Face::parse(font.data(), 0).ok(), numbers: GlyphRemapper::new(), used: BTreeMap::new() }
    }

    /// Whether the font has this letter.
    pub fn has(&self, letter: char) -> bool {
        self.face.as_ref().is_some_and(|face| face.glyph_index(letter).is_some())
    }

    /// How wide a text is, em; the document need not have it.
    pub fn width(&self, text: &str) -> f64 {
        let Some(face) = &self.face else { return 0.0 };
        let units: u32 = text.chars().map(|letter| u32::from(face.glyph_hor_advance(glyph(face, letter)).unwrap_or(0))).sum();
        f64::from(units) / f64::from(face.units_per_em())
    }

    /// The numbers of a text's letters, two bytes each, as hexadecimal digits; and the text's width, em.
    pub fn set(&mut self, text: &str) -> (String, f64) {
        let Some(face) = &self.face else { return (String::new(), 0.0) };
        let (mut digits, mut width) = (String::new(), 0.0);
        for letter in text.chars() {
            let glyph = glyph(face, letter);
            let wide = f64::from(face.glyph_hor_advance(glyph).unwrap_or(0)) / f64::from(face.units_per_em());
            let number = self.numbers.remap(glyph.0);
            self.used.insert(number, ((1000.0 * wide) as f32, letter));
            digits.push_str(&format!("{number:04x}"));
            width += wide;
        }
        (digits, width)
    }

    /// Adds the font to a document, as `font`, with what it is made of as the references after it.
    pub fn write(self, pdf: &mut Pdf, font: Ref, next: &mut impl FnMut() -> Ref) {
        let Some(face) = &self.face else { return };
        let [descendant, descriptor, file, letters] = std::array::from_fn(|_| next());
        pdf.type0_font(font)
            .base_font(self.font.name())
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(descendant)
            .to_unicode(letters);
        let mut cid = pdf.cid_font(descendant);
        cid.subtype(CidFontType::Type2)
            .base_font(self.font.name())
            .system_info(SYSTEM)
            .font_descriptor(descriptor)
            .cid_to_gid_map_predefined(Name(b"Identity"));
        let mut widths = cid.widths();
        for (number, (width, _)) in &self.used {
            widths.consecutive(*number, [*width]);
        }
        widths.finish();
        cid.finish();
        let scale = 1000.0 / f32::from(face.units_per_em());
        let scaled = |value: i16| f32::from(value) * scale;
        let bounds = face.global_bounding_box();
        pdf.font_descriptor(descriptor)
            .name(self.font.name())
            .flags(FontFlags::NON_SYMBOLIC)
            .bbox(Rect::new(scaled(bounds.x_min), scaled(bounds.y_min), scaled(bounds.x_max), scaled(bounds.y_max)))
            .italic_angle(0.0)
            .ascent(scaled(face.ascender()))
            .descent(scaled(face.descender()))
            .cap_height(scaled(face.capital_height().unwrap_or(face.ascender())))
            .stem_v(if self.font == Font::Bold { 140.0 } else { 80.0 })
            .font_file2(file);
        let mut unicode = UnicodeCmap::new(Name(b"calibench"), SYSTEM);
        for (number, (_, letter)) in &self.used {
            unicode.pair(*number, *letter);
        }
        pdf.cmap(letters, &unicode.finish());
        // A font that was parsed can be cut; whole it is larger and serves as well.
        let cut = subsetter::subset(self.font.data(), 0, &self.numbers).unwrap_or_else(|_| self.font.data().to_vec());
        let data = deflated(&cut);
        pdf.stream(file, &data).filter(Filter::FlateDecode).pair(Name(b"Length1"), cut.len() as i32);
    }
}

/// The glyph of a letter, or that of what there is not.
fn glyph(face: &Face<'_>, letter: char) -> GlyphId {
    face.glyph_index(letter).unwrap_or(GlyphId(0))
}
