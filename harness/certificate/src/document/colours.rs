//! What the colours of a document are, as an ICC profile of version 2: the primaries of sRGB with one exponent.

/// Its name.
pub(super) const NAME: &str = "sRGB primaries, gamma 2.2";
/// Whites and primaries as X, Y, Z, adapted to the white of the profile. Source: IEC 61966-2-1, Bradford's adaptation from D65 to D50.
const WHITE: [f64; 3] = [0.9642, 1.0, 0.8249];
const PRIMARIES: [[f64; 3]; 3] = [[0.43607, 0.22249, 0.01392], [0.38515, 0.71687, 0.09708], [0.14307, 0.06061, 0.71410]];

/// The profile.
pub(super) fn profile() -> Vec<u8> {
    let curve = [&b"curv\0\0\0\0\0\0\0\x01"[..], &0x0233_u16.to_be_bytes(), &[0, 0]].concat();
    let mut tags: Vec<(&[u8; 4], Vec<u8>)> = vec![(b"desc", described()), (b"cprt", b"text\0\0\0\0No copyright, use freely\0".to_vec())];
    tags.push((b"wtpt", place(WHITE)));
    tags.extend([b"rXYZ", b"gXYZ", b"bXYZ"].into_iter().zip(PRIMARIES.map(place)));
    tags.extend([b"rTRC", b"gTRC", b"bTRC"].map(|name| (name, curve.clone())));
    let mut table = (tags.len() as u32).to_be_bytes().to_vec();
    let mut data = Vec::new();
    let start = 128 + 4 + 12 * tags.len();
    for (name, content) in tags {
        table.extend(name);
        table.extend(((start + data.len()) as u32).to_be_bytes());
        table.extend((content.len() as u32).to_be_bytes());
        data.extend(content);
        data.resize(data.len().next_multiple_of(4), 0);
    }
    let mut head = Vec::with_capacity(128);
    head.extend(((start + data.len()) as u32).to_be_bytes());
    head.extend([0; 4]);
    head.extend([2, 0x10, 0, 0]);
    head.extend(b"mntrRGB XYZ ");
    // The first of January 2026.
    head.extend([2026_u16, 1, 1, 0, 0, 0].into_iter().flat_map(u16::to_be_bytes));
    head.extend(b"acsp");
    head.extend([0; 28]);
    head.extend(WHITE.into_iter().flat_map(fixed));
    head.resize(128, 0);
    [head, table, data].concat()
}

fn fixed(value: f64) -> [u8; 4] {
    ((value * 65536.0).round() as i32).to_be_bytes()
}

fn place(xyz: [f64; 3]) -> Vec<u8> {
    [*b"XYZ ", [0; 4]].into_iter().chain(xyz.map(fixed)).flatten().collect()
}

/// The name as a description of version 2: ASCII, and no other script.
fn described() -> Vec<u8> {
    let mut text = b"desc\0\0\0\0".to_vec();
    text.extend((NAME.len() as u32 + 1).to_be_bytes());
    text.extend(NAME.bytes().chain([0]));
    text.resize(text.len() + 8 + 3 + 67, 0);
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_primaries_make_white() {
        for (i, white) in WHITE.into_iter().enumerate() {
            let sum: f64 = PRIMARIES.iter().map(|primary| primary[i]).sum();
            assert!((sum - white).abs() < 2e-4, "{sum} {white}");
        }
    }

    #[test]
    fn every_tag_lies_within_the_profile() {
        let profile = profile();
        let word = |at: usize| u32::from_be_bytes(*profile[at..].first_chunk().unwrap()) as usize;
        assert_eq!((word(0), &profile[36..40], word(128)), (profile.len(), &b"acsp"[..], 9));
        for tag in 0..9 {
            let at = 132 + 12 * tag;
            assert!(word(at + 4) % 4 == 0 && word(at + 4) >= 132 + 9 * 12 && word(at + 4) + word(at + 8) <= profile.len());
        }
    }
}
