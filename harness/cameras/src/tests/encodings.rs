//! Files in other encodings than UTF-8 that say so.

use super::super::{ReadOptions, parse_camera};

const NAMED: &str = "<?xml version=\"1.0\" encoding=\"ENCODING\"?>\n<collection><cameras>\n<camera label=\"Stra\u{df}e\"><calibration><projection>frame</projection>\
    <width>640</width><height>480</height><fx>500</fx><fy>501</fy><cx>320</cx><cy>240</cy></calibration></camera>\n</cameras></collection>\n";

fn utf_16(text: &str, bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
    std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(bytes).collect()
}

fn latin_1(text: &str) -> Vec<u8> {
    text.chars().map(|c| u8::try_from(u32::from(c)).unwrap()).collect()
}

fn read(bytes: &[u8]) -> Result<String, String> {
    let read = parse_camera("f", bytes, &ReadOptions::default());
    read.map(|file| file.cameras[0].name.clone()).map_err(|error| error.to_string())
}

#[test]
fn what_an_encoding_says_is_read() {
    let of = |encoding: &str| NAMED.replace("ENCODING", encoding);
    for bytes in [
        of("UTF-8").into_bytes(),
        format!("\u{feff}{}", of("UTF-8")).into_bytes(),
        utf_16(&of("UTF-16"), u16::to_le_bytes),
        utf_16(&of("utf-16"), u16::to_be_bytes),
        latin_1(&of("ISO-8859-1")),
        latin_1(&of("Windows-1252")),
        latin_1(&of("latin1").replace('"', "'")),
        // Declared, and yet read byte by byte.
        of("UTF-16").into_bytes(),
    ] {
        assert_eq!(read(&bytes).as_deref(), Ok("Stra\u{df}e"));
    }
    // Other texts by their mark alone.
    let yaml = "image_width: 640\nimage_height: 480\ncamera_name: Stra\u{df}e\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [500, 0, 320, 0, 501, 240, 0, 0, 1]\n\
                distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.1, 0, 0, 0, 0]\n";
    assert_eq!(read(&utf_16(yaml, u16::to_le_bytes)), read(yaml.as_bytes()));
}

#[test]
fn bytes_that_are_not_of_the_encoding_are_refused() {
    let undeclared = latin_1(&NAMED.replace("ENCODING", "UTF-8"));
    assert!(read(&undeclared).unwrap_err().contains("f:3: expected text in UTF-8"), "{:?}", read(&undeclared));
    let unknown = NAMED.replace("ENCODING", "klingon");
    assert!(
        read(unknown.as_bytes()).unwrap_err().contains("f:1: encoding `klingon` is not known; expected UTF-8"),
        "{:?}",
        read(unknown.as_bytes())
    );
    let mut cut = utf_16(&NAMED.replace("ENCODING", "UTF-16"), u16::to_le_bytes);
    cut.extend([0x00, 0xd8]);
    assert!(read(&cut).unwrap_err().contains("says that it is in UTF-16LE, and holds bytes that are not"), "{:?}", read(&cut));
}
