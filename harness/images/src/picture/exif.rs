//! EXIF: the directories of a TIFF, which photographs of every format carry, or are.

use std::io::{self, Cursor, Read, Seek, SeekFrom};

/// The orientation of a picture, 1 if it is upright.
const ORIENTATION: u16 = 0x112;
/// Columns and rows as the EXIF directory says them.
const COLUMNS: u16 = 0xa002;
const ROWS: u16 = 0xa003;
/// Where the directories of EXIF and of the position stand.
const EXIF: u16 = 0x8769;
const GPS: u16 = 0x8825;
/// The colour profile of a TIFF.
pub(super) const PROFILE: u16 = 0x8773;
/// What of a TIFF's own entries is about the photograph and not about how its pixels are stored: description, maker, model, resolution, software, date,
/// artist, copyright.
const ABOUT: [u16; 10] = [0x10e, 0x10f, 0x110, 0x11a, 0x11b, 0x128, 0x131, 0x132, 0x13b, 0x8298];
/// Entries of a directory, and bytes of one, at most: what claims more is damaged.
const MOST_ENTRIES: u16 = 2000;
const MOST_BYTES: u64 = 64 << 20;

/// Bytes of a value of each type of TIFF, from 1 on.
const SIZES: [u64; 12] = [1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8];

/// An entry, its value in little-endian order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    pub(super) tag: u16,
    pub(super) kind: u16,
    pub(super) value: Vec<u8>,
}

impl Entry {
    pub(super) fn short(tag: u16, values: &[u16]) -> Self {
        Self { tag, kind: 3, value: values.iter().flat_map(|value| value.to_le_bytes()).collect() }
    }

    pub(super) fn long(tag: u16, values: &[u32]) -> Self {
        Self { tag, kind: 4, value: values.iter().flat_map(|value| value.to_le_bytes()).collect() }
    }

    fn count(&self) -> u32 {
        (self.value.len() as u64 / size(self.kind).unwrap_or(1)) as u32
    }

    fn number(&self) -> Option<u64> {
        match (self.kind, self.value.as_slice()) {
            (3, [a, b, ..]) => Some(u64::from(u16::from_le_bytes([*a, *b]))),
            (4 | 13, [a, b, c, d, ..]) => Some(u64::from(u32::from_le_bytes([*a, *b, *c, *d]))),
            _ => None,
        }
    }
}

fn size(kind: u16) -> Option<u64> {
    SIZES.get(usize::from(kind.checked_sub(1)?)).copied()
}

/// What a photograph says of itself: its main directory, that of EXIF, and that of its position.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Directories {
    pub(super) main: Vec<Entry>,
    pub(super) exif: Vec<Entry>,
    pub(super) gps: Vec<Entry>,
}

struct Reader<'a, R> {
    input: &'a mut R,
    big: bool,
}

impl<R: Read + Seek> Reader<'_, R> {
    fn bytes<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.input.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    fn short(&mut self) -> io::Result<u16> {
        let bytes = self.bytes()?;
        Ok(if self.big { u16::from_be_bytes(bytes) } else { u16::from_le_bytes(bytes) })
    }

    fn long(&mut self) -> io::Result<u32> {
        let bytes = self.bytes()?;
        Ok(if self.big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    /// The entries of the directory at `place` that `wanted` names.
    fn directory(&mut self, place: u64, wanted: impl Fn(u16) -> bool) -> io::Result<Vec<Entry>> {
        self.input.seek(SeekFrom::Start(place))?;
        let count = self.short()?.min(MOST_ENTRIES);
        let mut entries = Vec::new();
        for i in 0..u64::from(count) {
            self.input.seek(SeekFrom::Start(place + 2 + 12 * i))?;
            let (tag, kind, count) = (self.short()?, self.short()?, self.long()?);
            let Some(bytes) = size(kind).map(|size| size * u64::from(count)).filter(|bytes| wanted(tag) && *bytes <= MOST_BYTES) else {
                continue;
            };
            if bytes > 4 {
                let place = self.long()?;
                self.input.seek(SeekFrom::Start(u64::from(place)))?;
            }
            let mut value = Vec::new();
            if self.input.by_ref().take(bytes).read_to_end(&mut value)? as u64 != bytes {
                continue;
            }
            if self.big {
                let word = if matches!(kind, 5 | 10) { 4 } else { SIZES[usize::from(kind) - 1] as usize };
                value.chunks_exact_mut(word).for_each(<[u8]>::reverse);
            }
            entries.push(Entry { tag, kind, value });
        }
        Ok(entries)
    }
}

impl Directories {
    /// Those of a TIFF, or of the EXIF block of another file; of a TIFF's main directory what is about the photograph.
    ///
    /// # Errors
    /// What is no TIFF, or damaged.
    pub(super) fn read(input: &mut (impl Read + Seek)) -> io::Result<Self> {
        input.seek(SeekFrom::Start(0))?;
        let mut head = [0; 4];
        input.read_exact(&mut head)?;
        let big = match &head {
            b"II*\0" => false,
            b"MM\0*" => true,
            _ => return Err(io::ErrorKind::InvalidData.into()),
        };
        let mut reader = Reader { input, big };
        let place = reader.long()?;
        let main = reader.directory(u64::from(place), |tag| ABOUT.contains(&tag) || [EXIF, GPS, PROFILE].contains(&tag))?;
        let mut within = |tag: u16| {
            let place = main.iter().find(|entry| entry.tag == tag).and_then(Entry::number);
            // The place of what is another directory still would mean nothing elsewhere.
            place.map_or(Ok(Vec::new()), |place| reader.directory(place, |tag| tag != 0xa005))
        };
        let (exif, gps) = (within(EXIF)?, within(GPS)?);
        Ok(Self { main: main.into_iter().filter(|entry| ![EXIF, GPS].contains(&entry.tag)).collect(), exif, gps })
    }

    /// Columns and rows are these.
    pub(super) fn resize(&mut self, [width, height]: [u32; 2]) {
        for (tag, side) in [(COLUMNS, width), (ROWS, height)] {
            self.exif.iter_mut().filter(|entry| entry.tag == tag).for_each(|entry| *entry = Entry::long(tag, &[side]));
        }
    }

    /// As a TIFF without pixels, whose main directory has `more` entries too; the first byte behind it is returned with it.
    pub(super) fn file(&self, more: Vec<Entry>) -> Vec<u8> {
        let mut main: Vec<Entry> = self.main.iter().cloned().chain(more).collect();
        for (tag, entries) in [(EXIF, &self.exif), (GPS, &self.gps)] {
            if !entries.is_empty() {
                main.push(Entry::long(tag, &[0]));
            }
        }
        main.sort_by_key(|entry| entry.tag);
        main.dedup_by_key(|entry| entry.tag);
        let length = |entries: &[Entry]| 2 + 12 * entries.len() + 4 + entries.iter().map(behind).sum::<usize>();
        let exif_at = 8 + length(&main);
        let gps_at = exif_at + if self.exif.is_empty() { 0 } else { length(&self.exif) };
        for (tag, place) in [(EXIF, exif_at), (GPS, gps_at)] {
            main.iter_mut().filter(|entry| entry.tag == tag).for_each(|entry| *entry = Entry::long(tag, &[place as u32]));
        }
        let mut file = b"II*\0\x08\0\0\0".to_vec();
        for entries in [&main, &self.exif, &self.gps].into_iter().filter(|entries| !entries.is_empty()) {
            put(&mut file, entries);
        }
        file
    }
}

/// Bytes of a value that stand behind its directory: an even number.
fn behind(entry: &Entry) -> usize {
    if entry.value.len() > 4 { entry.value.len().next_multiple_of(2) } else { 0 }
}

/// Puts a directory at the end of a file.
fn put(file: &mut Vec<u8>, entries: &[Entry]) {
    let mut place = file.len() + 2 + 12 * entries.len() + 4;
    file.extend((entries.len() as u16).to_le_bytes());
    let mut values = Vec::new();
    for entry in entries {
        file.extend(entry.tag.to_le_bytes());
        file.extend(entry.kind.to_le_bytes());
        file.extend(entry.count().to_le_bytes());
        if behind(entry) == 0 {
            file.extend(entry.value.iter().copied().chain([0; 4]).take(4));
        } else {
            file.extend((place as u32).to_le_bytes());
            place += behind(entry);
            values.extend(&entry.value);
            values.resize(values.len().next_multiple_of(2), 0);
        }
    }
    file.extend([0; 4]);
    file.extend(values);
}

/// An EXIF block of an upright picture of another size, the rest as it is: makers' notes hold places of their own. What cannot be understood is left out.
pub(super) fn of_picture(block: &[u8], [width, height]: [u32; 2]) -> Option<Vec<u8>> {
    let mut changed = block.to_vec();
    let big = match block.get(..4)? {
        b"II*\0" => false,
        b"MM\0*" => true,
        _ => return None,
    };
    let main = Reader { input: &mut Cursor::new(block.get(4..8)?), big }.long().ok()?;
    patch(&mut changed, u64::from(main), big, &[(ORIENTATION, 1)])?;
    let within = Reader { input: &mut Cursor::new(block), big }.directory(u64::from(main), |tag| tag == EXIF).ok()?;
    if let Some(exif) = within.first().and_then(Entry::number) {
        patch(&mut changed, exif, big, &[(COLUMNS, width), (ROWS, height)])?;
    }
    Some(changed)
}

/// Changes numbers of a directory where they stand.
fn patch(block: &mut [u8], place: u64, big: bool, numbers: &[(u16, u32)]) -> Option<()> {
    let place = usize::try_from(place).ok()?;
    let two = |bytes: &[u8]| -> Option<u16> {
        let bytes = *bytes.first_chunk()?;
        Some(if big { u16::from_be_bytes(bytes) } else { u16::from_le_bytes(bytes) })
    };
    let count = two(block.get(place..)?)?;
    for i in 0..usize::from(count) {
        let entry = block.get_mut(place + 2 + 12 * i..)?.first_chunk_mut::<12>()?;
        let (tag, kind) = (two(&entry[..])?, two(&entry[2..])?);
        let Some((_, number)) = numbers.iter().find(|(known, _)| *known == tag) else { continue };
        let short = *number as u16;
        match kind {
            3 => entry[8..10].copy_from_slice(&if big { short.to_be_bytes() } else { short.to_le_bytes() }),
            4 => entry[8..12].copy_from_slice(&if big { number.to_be_bytes() } else { number.to_le_bytes() }),
            _ => {}
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directories() -> Directories {
        Directories {
            main: vec![
                Entry { tag: 0x10f, kind: 2, value: b"Maker\0".to_vec() },
                Entry { tag: 0x11a, kind: 5, value: [72_u32.to_le_bytes(), 1_u32.to_le_bytes()].concat() },
            ],
            exif: vec![
                Entry::long(COLUMNS, &[640]),
                Entry::short(ROWS, &[480]),
                Entry { tag: 0x829a, kind: 5, value: vec![1, 0, 0, 0, 125, 0, 0, 0] },
            ],
            gps: vec![Entry { tag: 1, kind: 2, value: b"N\0".to_vec() }],
        }
    }

    #[test]
    fn directories_are_read_as_they_are_written() {
        let file = directories().file(vec![Entry::short(ORIENTATION, &[6])]);
        assert_eq!(Directories::read(&mut Cursor::new(&file)).unwrap(), directories());
        let mut sized = directories();
        sized.resize([300, 200]);
        assert_eq!(sized.exif[..2], [Entry::long(COLUMNS, &[300]), Entry::long(ROWS, &[200])]);
        for cut in 0..file.len() {
            // Whatever is left, nothing panics.
            let _ = Directories::read(&mut Cursor::new(&file[..cut]));
            let _ = of_picture(&file[..cut], [1, 2]);
        }
    }

    #[test]
    fn a_block_is_changed_where_it_has_to_be() {
        let file = directories().file(vec![Entry::short(ORIENTATION, &[6])]);
        let changed = of_picture(&file, [300, 200]).unwrap();
        let mut expected = directories();
        expected.resize([300, 200]);
        // Numbers keep their type.
        expected.exif[1] = Entry::short(ROWS, &[200]);
        assert_eq!(changed, expected.file(vec![Entry::short(ORIENTATION, &[1])]));
    }

    #[test]
    fn the_other_order_of_bytes_is_read_too() {
        // One entry, maker, in big-endian order.
        let file =
            [&b"MM\0*\0\0\0\x08\0\x02"[..], &[1, 0x0f, 0, 2, 0, 0, 0, 3], b"ab\0\0", &[1, 0x12, 0, 3, 0, 0, 0, 1, 0, 6, 0, 0], &[0; 4]]
                .concat();
        let found = Directories::read(&mut Cursor::new(&file)).unwrap();
        assert_eq!(found.main, [Entry { tag: 0x10f, kind: 2, value: b"ab\0".to_vec() }]);
        let changed = of_picture(&file, [1, 1]).unwrap();
        let at = file.len() - 8;
        assert_eq!((changed[at], changed[at + 1], file[at + 1]), (0, 1, 6));
    }
}
