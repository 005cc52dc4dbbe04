//! Whether files and pages are still those of a certificate.

use std::path::{Path, PathBuf};

use crate::certified::{CertificateError, Sealed};
use crate::digest::{digest_of_file, line, of_line};

/// What became of the pages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pages {
    /// They are those that the record gives, byte for byte.
    Same,
    /// They are, and something was added behind them, as a signature or remarks are.
    Added(usize),
    /// They are not.
    Changed,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Verified {
    /// The digest that the document states.
    pub stated: String,
    /// The digest of the record and of the files as they are now; `None` where a file is missing.
    pub found: Option<String>,
    /// Files that are another than the certificate is of.
    pub changed: Vec<String>,
    /// Files that are not where they are looked for.
    pub missing: Vec<String>,
    /// How many files there are.
    pub files: usize,
    /// What became of the pages.
    pub pages: Pages,
    /// The version of calibench that wrote it.
    pub calibench: String,
}

/// What is attached to a document.
///
/// # Errors
/// [`CertificateError::NoCertificate`].
pub fn attached(pdf: &[u8]) -> Result<Sealed, CertificateError> {
    let mut from = 0;
    let mut next = || {
        let kind = from + find(&pdf[from..], b"/Type /EmbeddedFile")?;
        let start = kind + find(&pdf[kind..], b"stream\n")? + 7;
        let end = start + find(&pdf[start..], b"\nendstream")?;
        from = end;
        String::from_utf8(pdf[start..end].to_vec()).ok()
    };
    let found = if pdf.starts_with(b"%PDF-") { next().zip(next()) } else { None };
    found.map(|(record, list)| Sealed { record, list }).ok_or(CertificateError::NoCertificate)
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    bytes.windows(what.len()).position(|window| window == what)
}

/// The digest that a document states of itself.
fn stated(pdf: &[u8]) -> Option<String> {
    let begin = find(pdf, b"<dc:identifier>")? + 15;
    let digest = std::str::from_utf8(pdf.get(begin..begin + 64)?).ok()?;
    of_line(digest).map(str::to_owned)
}

/// Computes the digests of the files anew, which are looked for in each of `folders` by their paths and by their names, and the pages from the record.
///
/// # Errors
/// A document that is no certificate, a record that cannot be read. A file that cannot be read counts as missing.
pub fn verify(pdf: &[u8], folders: &[PathBuf]) -> Result<Verified, CertificateError> {
    let sealed = attached(pdf)?;
    let stated = stated(pdf).ok_or(CertificateError::NoCertificate)?;
    let certificate = sealed.certificate()?;
    let files = &certificate.record.files;
    if sealed.list.lines().count() != files.len() {
        return Err(CertificateError::List { found: sealed.list.lines().count(), expected: files.len() });
    }
    let (mut list, mut changed, mut missing) = (String::new(), Vec::new(), Vec::new());
    for (entry, known) in files.iter().zip(sealed.list.lines()) {
        let known = of_line(known).unwrap_or_default();
        match digest_in(folders, &entry.path, known) {
            Some(digest) => {
                if digest != known {
                    changed.push(entry.path.clone());
                }
                list.push_str(&line(&digest, &entry.path));
            }
            None => missing.push(entry.path.clone()),
        }
    }
    let found = missing.is_empty().then(|| Sealed { record: sealed.record.clone(), list }.digest());
    let again = sealed.certified()?;
    let pages = match pdf.strip_prefix(again.pdf.as_slice()) {
        Some([]) => Pages::Same,
        Some(more) => Pages::Added(more.len()),
        None => Pages::Changed,
    };
    Ok(Verified { stated, found, changed, missing, files: files.len(), pages, calibench: certificate.record.calibench })
}

/// The digest of a file in the first folder that has it as it was, or else in the first that has one of its name.
fn digest_in(folders: &[PathBuf], path: &str, known: &str) -> Option<String> {
    let mut other = None;
    let name = Path::new(path).file_name();
    for folder in folders {
        for place in [Some(folder.join(path)), name.map(|name| folder.join(name))].into_iter().flatten() {
            match digest_of_file(&place) {
                Ok((digest, _)) if digest == known => return Some(digest),
                Ok((digest, _)) => other = other.or(Some(digest)),
                Err(_) => {}
            }
        }
    }
    other
}
