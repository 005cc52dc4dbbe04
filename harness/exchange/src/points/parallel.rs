//! Long point files, read on all threads.

use std::io::Read;

use super::{Check, LostRows, PointFile, Points, most_rows, read_rows, reader};
use calibench_files::pipelined::pipelined;

/// Bytes that one thread reads at a time.
const PIECE: usize = 1 << 19;
/// Pieces that are read before they are joined: their memory is that much.
const BATCH: usize = 16;

/// What `text` holds; `None` if anything in it is wrong, and for what cannot be cut at line ends: short files, and those with quotes.
///
/// The result does not depend on the number of threads.
pub(super) fn parse(file: &str, text: &[u8], check: Check<'_>) -> Option<PointFile> {
    if text.len() < 2 * PIECE || text.contains(&b'"') {
        return None;
    }
    let (header, body) = text.split_at(below_header(text)?);
    if body.is_empty() {
        return None;
    }
    let mut all = PointFile { points: Points::with_capacity(most_rows(text)), lost: LostRows::default() };
    let one = |piece: &[u8]| {
        let mut found = PointFile { points: Points::with_capacity(most_rows(piece)), lost: LostRows::default() };
        read_rows(file, header.chain(piece), text, check, &mut found).map(|()| found)
    };
    let join = |found: PointFile| {
        all.points.append(&found.points);
        found.lost.iter().for_each(|row| all.lost.push(row));
        Ok(())
    };
    pipelined(pieces(body), BATCH, one, join).ok()?;
    all.points.twice().is_none().then_some(all)
}

/// Where the first row begins.
fn below_header(text: &[u8]) -> Option<usize> {
    let mut reader = reader(text);
    reader.headers().ok()?;
    let end = usize::try_from(reader.position().byte()).ok()?;
    // Of CR and LF only the first was read.
    let end = end + usize::from(text.get(end) == Some(&b'\n'));
    text.get(..end).filter(|header| header.ends_with(b"\n")).map(<[u8]>::len)
}

/// The text in pieces that end with a line.
fn pieces(mut text: &[u8]) -> Vec<&[u8]> {
    let mut pieces = Vec::with_capacity(text.len() / PIECE + 1);
    while !text.is_empty() {
        let least = PIECE.min(text.len());
        let end = text[least..].iter().position(|byte| *byte == b'\n').map_or(text.len(), |more| least + more + 1);
        let (piece, rest) = text.split_at(end);
        pieces.push(piece);
        text = rest;
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::super::{in_turn, parse_points};
    use super::*;

    /// Two megabytes of points of two images, and a fifth of rows without one.
    fn long() -> String {
        let mut text = String::from("image,target,x,y,kind,status,reason\r\n");
        for i in 0..70_000 {
            let image = if i < 35_000 { "left" } else { "right" };
            text += &match i % 5 {
                4 => format!("{image},t{i},,,,rejected,why {}\n", i % 3),
                3 => format!("{image},t{},{i}.25,-{i},disc,measured,\r\n", i % 35_000),
                _ => format!("{image},t{},{i}.5,-{i}.125,,,\n\n", i % 35_000),
            };
        }
        // Of the third image every target is new.
        text.replace("right,t0,", "third,t0,")
    }

    #[test]
    fn on_all_threads_the_same_is_read_as_in_turn() {
        let text = long();
        assert!(text.len() > 3 * PIECE);
        let [together, one] =
            [parse("p.csv", text.as_bytes(), &|_| Ok(())), in_turn("p.csv", text.as_bytes(), &|_| Ok(())).ok()].map(Option::unwrap);
        assert!(together.points == one.points && together.lost == one.lost && !one.lost.is_empty());
        let names = |file: &PointFile| [file.points.images().clone(), file.points.targets().clone()];
        assert_eq!(names(&together), names(&one));
    }

    #[test]
    fn whatever_ends_lines_the_same_is_read() {
        let plain: String = (0..120_000).map(|i| format!("i,t{i},{i}.5,2\n")).collect();
        let plain = format!("image,target,x,y\n{plain}");
        let expected = in_turn("p.csv", plain.as_bytes(), &|_| Ok(())).unwrap();
        for (name, text, together) in [
            ("as written", plain.clone(), true),
            ("byte order mark", format!("\u{feff}{plain}"), true),
            ("CR LF", plain.replace('\n', "\r\n"), true),
            ("CR", plain.replace('\n', "\r"), false),
            ("CR in the rows alone", plain.replace('\n', "\r").replacen('\r', "\n", 1), true),
            ("no end of the last line", plain.trim_end().to_owned(), true),
            ("empty lines", plain.replace('\n', "\n\n"), true),
        ] {
            let found = parse("p.csv", text.as_bytes(), &|_| Ok(()));
            assert_eq!(found.is_some(), together, "{name}");
            let found = found.map_or_else(|| parse_points("p.csv", text.as_bytes()).unwrap().points, |found| found.points);
            assert!(found == expected.points, "{name}");
        }
        let header = format!("{}\n", vec!["x"; PIECE].join(","));
        assert!(header.len() >= 2 * PIECE && parse("p.csv", header.as_bytes(), &|_| Ok(())).is_none());
    }

    #[test]
    fn what_is_wrong_in_a_long_file_has_its_line() {
        let rows = |wrong: &str| {
            let row = |i: usize| if i == 100_000 { format!("{wrong}\n") } else { format!("i,t{i},1,2\n") };
            format!("image,target,x,y\n{}", (0..120_000).map(row).collect::<String>())
        };
        for (wrong, expected) in [
            ("i,t,1,two", "p.csv:100002, column `y`: expected a finite number"),
            ("i,t,1", "p.csv:100002: expected 4 cells as in the header, found 3"),
            ("i,t7,1,2", "p.csv:100002: target `t7` of image `i` is already on line 9"),
        ] {
            let error = parse_points("p.csv", rows(wrong).as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
        let twice = rows("i,t7,1,2").replace("i,t110000,1,2", "i,t110000,1,two");
        let error = parse_points("p.csv", twice.as_bytes()).unwrap_err().to_string();
        assert!(error.contains("already on line 9"), "{error}");
    }
}
