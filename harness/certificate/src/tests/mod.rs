//! Tests of a certificate as a whole, on a record of which every number is known.

mod sample;

use std::fs;

use sample::sample;

use crate::certified::{CertificateError, Sealed};
use crate::verify::{Pages, attached, verify};
use crate::{Certificate, Role, digest_of, line};

fn pdf(certificate: &Certificate, list: &str) -> Vec<u8> {
    Sealed::new(certificate, list).unwrap().certified().unwrap().pdf
}

fn holds(bytes: &[u8], text: &str) -> bool {
    bytes.windows(text.len()).any(|window| window == text.as_bytes())
}

#[test]
fn the_same_record_gives_the_same_bytes_and_another_one_others() {
    let (certificate, list) = sample(0, 12);
    let first = pdf(&certificate, &list);
    assert_eq!(first, pdf(&certificate, &list));
    let mut other = certificate.clone();
    other.fields.date = Some("today".into());
    assert_ne!(first, pdf(&other, &list));
    assert!(first.len() < 150_000, "{} bytes", first.len());
}

#[test]
fn a_doubtful_calibration_says_so_in_the_title() {
    for (doubts, title) in
        [(0, "<rdf:li xml:lang=\"x-default\">Calibration certificate</rdf:li>"), (1, ">Calibration certificate: in doubt</rdf:li>")]
    {
        let (certificate, list) = sample(doubts, 3);
        assert!(holds(&pdf(&certificate, &list), title), "{title}");
    }
    // Photographs of two lenses are no photographs of one camera.
    let (mut certificate, list) = sample(0, 3);
    let mut other = certificate.record.cameras[0].equipment[0].clone();
    other.focal_mm = Some(55.0);
    certificate.record.cameras[0].equipment.push(other);
    let made = Sealed::new(&certificate, &list).unwrap().certified().unwrap();
    assert_eq!(made.doubts, ["the photographs are of several focal lengths, as EXIF says: 18 mm, 55 mm"]);
    assert!(holds(&made.pdf, "in doubt"));
}

#[test]
fn record_and_list_are_attached_and_their_digest_is_stated() {
    let (certificate, list) = sample(2, 5);
    let sealed = Sealed::new(&certificate, &list).unwrap();
    let made = sealed.certified().unwrap();
    assert_eq!(attached(&made.pdf).unwrap(), sealed);
    assert_eq!(made.digest, digest_of(format!("{}{list}", sealed.record).as_bytes()));
    assert!(holds(&made.pdf, &format!("<dc:identifier>{} (SHA-256)", made.digest)));
    assert!(
        holds(&made.pdf, "<pdfaid:part>3</pdfaid:part>")
            && holds(&made.pdf, "/AFRelationship /Source")
            && holds(&made.pdf, "/S /GTS_PDFA1")
    );
}

/// Files, a certificate of them, and where they are.
fn made(folder: &std::path::Path) -> (Certificate, String) {
    let (mut certificate, _) = sample(0, 3);
    let mut list = String::new();
    for entry in &mut certificate.record.files {
        entry.path = entry.path.rsplit('/').next().unwrap().to_owned();
        fs::write(folder.join(&entry.path), &entry.path).unwrap();
        list.push_str(&line(&digest_of(entry.path.as_bytes()), &entry.path));
    }
    (certificate, list)
}

#[test]
fn a_file_that_was_changed_is_named_and_one_that_is_gone() {
    let folder = tempfile::tempdir().unwrap();
    let here = [folder.path().to_owned()];
    let (certificate, list) = made(folder.path());
    let pdf = pdf(&certificate, &list);
    let found = verify(&pdf, &here).unwrap();
    assert_eq!((found.found.as_ref(), found.pages, found.files), (Some(&found.stated), Pages::Same, 4));
    assert!(found.changed.is_empty() && found.missing.is_empty());
    fs::write(folder.path().join("IMG_0001.JPG"), "another").unwrap();
    let found = verify(&pdf, &here).unwrap();
    assert_eq!(found.changed, ["IMG_0001.JPG"]);
    assert!(found.found.is_some_and(|digest| digest != found.stated));
    fs::remove_file(folder.path().join("camera.yaml")).unwrap();
    let found = verify(&pdf, &here).unwrap();
    assert_eq!((found.missing, found.found), (vec!["camera.yaml".to_owned()], None));
    // It is found in another folder under its name, and what is as it was goes before what is not.
    let other = tempfile::tempdir().unwrap();
    for name in ["camera.yaml", "IMG_0001.JPG"] {
        fs::write(other.path().join(name), name).unwrap();
    }
    let found = verify(&pdf, &[here[0].clone(), other.path().to_owned()]).unwrap();
    assert!(found.changed.is_empty() && found.missing.is_empty(), "{found:?}");
}

#[test]
fn pages_that_were_changed_are_seen_and_what_was_added_behind_them() {
    let folder = tempfile::tempdir().unwrap();
    let here = [folder.path().to_owned()];
    let (certificate, list) = made(folder.path());
    let pdf = pdf(&certificate, &list);
    let added = [&pdf[..], b"\n% signed"].concat();
    assert_eq!(verify(&added, &here).unwrap().pages, Pages::Added(9));
    // A number of the record, and one bit of a page.
    let place = pdf.windows(6).position(|window| window == b"1213.4").unwrap();
    let mut other = pdf.clone();
    other[place] = b'2';
    let found = verify(&other, &here).unwrap();
    assert!(found.pages == Pages::Changed && found.found.as_ref() != Some(&found.stated), "{found:?}");
    let stream = pdf.windows(18).position(|window| window == b"/FlateDecode\n>>\nst").unwrap_or(pdf.len() / 2) + 40;
    let mut other = pdf.clone();
    other[stream] ^= 1;
    assert!(verify(&other, &here).is_ok_and(|found| found.pages == Pages::Changed));
    // A digest of the list in its place: the file is as the list says, and the pages are not.
    let forged = digest_of(b"another");
    fs::write(folder.path().join("IMG_0002.JPG"), "another").unwrap();
    let text = digest_of(b"IMG_0002.JPG");
    let places: Vec<usize> = (0..pdf.len() - 64).filter(|at| &pdf[*at..at + 64] == text.as_bytes()).collect();
    let mut other = pdf.clone();
    places.iter().for_each(|at| other[*at..at + 64].copy_from_slice(forged.as_bytes()));
    let found = verify(&other, &here).unwrap();
    assert!(found.changed.is_empty() && found.pages == Pages::Changed && found.found.as_ref() != Some(&found.stated), "{found:?}");
}

#[test]
fn what_is_no_certificate_is_refused_with_the_reason() {
    let (certificate, list) = sample(0, 3);
    let refused = |result: Result<Sealed, CertificateError>| result.and_then(|sealed| sealed.certified()).unwrap_err().to_string();
    assert!(refused(Sealed::new(&certificate, "")).contains("0 digests of 4 files"));
    let with = |change: &dyn Fn(&mut Certificate)| {
        let mut other = certificate.clone();
        change(&mut other);
        refused(Sealed::new(&other, &list))
    };
    assert!(with(&|other| other.camera = 1).contains("no camera 1 in this calibration; there are 1"));
    assert!(with(&|other| other.record.certificate = 2).contains("version 2 of the record"));
    assert!(with(&|other| drop(other.record.calibration.as_object_mut().unwrap().remove("counts"))).contains("missing field `counts`"));
    for bytes in [&b""[..], b"%PDF-1.7", b"/Type /EmbeddedFile stream\n"] {
        assert!(matches!(attached(bytes), Err(CertificateError::NoCertificate)));
    }
    // Whatever is left of it, nothing panics.
    let whole = pdf(&certificate, &list);
    for cut in (0..whole.len()).step_by(997) {
        assert!(verify(&whole[..cut], &[]).is_err() || cut > whole.len() / 2);
    }
}

#[test]
fn any_number_of_doubts_files_and_letters_has_room() {
    for (doubts, photographs) in [(0, 0), (40, 3), (3, 2000)] {
        let (mut certificate, list) = sample(doubts, photographs);
        certificate.fields.by = Some("\u{4e2d}\u{6587} \u{1b}[31m ".repeat(40));
        certificate.record.calibration["cameras"][0]["camera"]["convention"] = "x".repeat(3000).into();
        let one = certificate.record.calibration["cameras"][0]["camera"]["parameters"][0].clone();
        let many = certificate.record.calibration["cameras"][0]["camera"]["parameters"].as_array_mut().unwrap();
        many.extend(std::iter::repeat_n(one, 300));
        let made = Sealed::new(&certificate, &list).unwrap().certified().unwrap();
        assert!(holds(&made.pdf, "/Count 2"));
        let listed = certificate.record.files.iter().filter(|file| file.role == Role::Photograph).count();
        assert_eq!(listed, photographs);
    }
}

/// What cannot be said is not said: no redundancy, no images left out, nothing adjusted.
#[test]
fn a_calibration_that_knows_little_has_a_certificate_too() {
    let (mut certificate, list) = sample(0, 3);
    let answer = &mut certificate.record.calibration;
    answer["sigma0"] = serde_json::Value::Null;
    answer["counts"]["redundancy"] = 0.into();
    answer["cameras"][0]["over_frame"] = serde_json::Value::Null;
    answer["cameras"][0]["camera"]["covariance"] = serde_json::Value::Null;
    answer["board"] = serde_json::json!({"shape": "untouched", "why": null, "bend": null, "sigma": null, "p": null});
    certificate.record.groups = None;
    certificate.record.board = None;
    certificate.record.cameras[0].frame = None;
    assert!(!pdf(&certificate, &list).is_empty());
    // A grid that is not what it says is no map, and no panic.
    certificate.record.cameras[0].frame =
        Some(crate::FrameRecord { grid: [3, 3], sigma_px: vec![None], measured: Vec::new(), places: Vec::new() });
    assert!(!pdf(&certificate, &list).is_empty());
}
