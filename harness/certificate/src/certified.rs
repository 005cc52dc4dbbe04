//! A record and the digests of its files, and the document that they become.

use thiserror::Error;

use crate::answer::Answer;
use crate::budget::Budget;
use crate::digest::{digest_of, of_line};
use crate::document::{About, Attachment, document};
use crate::pages::{Told, pages, title};
use crate::record::{Certificate, LIST_FILE, RECORD, RECORD_FILE};

/// Why there is no certificate.
#[derive(Debug, Error)]
pub enum CertificateError {
    /// A record that is none.
    #[error("{RECORD_FILE}: line {line}, column {column}: {why}; expected the record as `calibrate --report` of calibench writes it")]
    Record {
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What is wrong.
        why: String,
    },
    /// A record of another version.
    #[error(
        "{RECORD_FILE}: version {0} of the record; this program reads version {RECORD}: take the program that wrote it, or calibrate again"
    )]
    Version(u32),
    /// An answer that lacks what a certificate says.
    #[error("{RECORD_FILE}: the answer of `calibrate` in it cannot be read: {0}; calibrate again")]
    Answer(String),
    /// Digests that are not those of the record's files.
    #[error("{LIST_FILE}: {found} digests of {expected} files; expected the list as `calibrate --report` of calibench writes it")]
    List {
        /// Digests.
        found: usize,
        /// Files of the record.
        expected: usize,
    },
    /// A camera that is not there.
    #[error("no camera {0} in this calibration; there are {1}")]
    Camera(usize, usize),
    /// A document that no certificate is attached to as `certificate` writes it.
    #[error(
        "no certificate of calibench is attached as it was written; expected the file that `calibench certificate` wrote, not printed or saved anew by another program"
    )]
    NoCertificate,
}

impl CertificateError {
    pub(crate) fn of_json(error: &serde_json::Error) -> Self {
        Self::Record { line: error.line(), column: error.column(), why: error.to_string() }
    }
}

/// A certificate whose text is fixed: what its digest is of.
#[derive(Clone, Debug, PartialEq)]
pub struct Sealed {
    /// The text of [`Certificate`] as it is attached.
    pub record: String,
    /// The list of digests, a line for each file in the record's order.
    pub list: String,
}

/// The document.
#[derive(Clone, Debug, PartialEq)]
pub struct Certified {
    /// PDF/A-3b.
    pub pdf: Vec<u8>,
    /// SHA-256 of the attached record and list, one after the other.
    pub digest: String,
    /// Why the calibration is in doubt, and the document's title says so.
    pub doubts: Vec<String>,
}

impl Sealed {
    /// Of a certificate and the list of the digests of its files.
    ///
    /// # Errors
    /// A list that is not of these files.
    pub fn new(certificate: &Certificate, list: &str) -> Result<Self, CertificateError> {
        let found = list.lines().filter(|line| of_line(line).is_some()).count();
        let expected = certificate.record.files.len();
        if found != expected || list.lines().count() != expected {
            return Err(CertificateError::List { found, expected });
        }
        let record = serde_json::to_string(certificate).map_err(|error| CertificateError::of_json(&error))?;
        Ok(Self { record, list: list.to_owned() })
    }

    /// SHA-256 of record and list, as hexadecimal digits.
    pub fn digest(&self) -> String {
        digest_of(&[self.record.as_bytes(), self.list.as_bytes()].concat())
    }

    /// What it holds.
    ///
    /// # Errors
    /// A record that cannot be read, or of another version.
    pub fn certificate(&self) -> Result<Certificate, CertificateError> {
        let found: Certificate = serde_json::from_str(&self.record).map_err(|error| CertificateError::of_json(&error))?;
        if found.record.certificate != RECORD {
            return Err(CertificateError::Version(found.record.certificate));
        }
        Ok(found)
    }

    /// The document. The same text gives the same bytes.
    ///
    /// # Errors
    /// As [`Self::certificate`]; an answer that cannot be read; a camera that is not there.
    pub fn certified(&self) -> Result<Certified, CertificateError> {
        let certificate = self.certificate()?;
        let answer: Answer =
            serde_json::from_value(certificate.record.calibration.clone()).map_err(|error| CertificateError::Answer(error.to_string()))?;
        if certificate.camera >= answer.cameras.len() {
            return Err(CertificateError::Camera(certificate.camera, answer.cameras.len()));
        }
        let doubts: Vec<String> = answer.doubts.iter().cloned().chain(mixed(&certificate)).collect();
        let budget = Budget::of(&certificate.record, &answer, certificate.camera);
        let digest = self.digest();
        let told = Told { certificate: &certificate, answer: &answer, budget: &budget, digest: &digest, list: &self.list, doubts: &doubts };
        let paper = pages(&told);
        let program = format!("calibench {}", certificate.record.calibench);
        let identifier = format!("{digest} (SHA-256)");
        let about = About { title: title(!doubts.is_empty()), identifier: &identifier, program: &program };
        let attachments = [
            Attachment {
                name: RECORD_FILE,
                about: "The record that the certificate is made of",
                kind: "application/json",
                content: self.record.as_bytes(),
            },
            Attachment {
                name: LIST_FILE,
                about: "SHA-256 of the files, as sha256sum checks them",
                kind: "text/plain",
                content: self.list.as_bytes(),
            },
        ];
        let pdf = document(paper, &about, &attachments);
        Ok(Certified { pdf, digest, doubts })
    }
}

/// Photographs of one camera that say they are of several cameras, lenses or focal lengths.
fn mixed(certificate: &Certificate) -> Vec<String> {
    let Some(camera) = certificate.record.cameras.get(certificate.camera) else { return Vec::new() };
    let all = &camera.equipment;
    let several = |what: &str, values: Vec<String>| {
        let mut values = values;
        values.sort();
        values.dedup();
        (values.len() > 1).then(|| format!("the photographs are of several {what}, as EXIF says: {}", values.join(", ")))
    };
    [
        several(
            "cameras",
            all.iter()
                .filter_map(|one| {
                    one.camera.clone().map(|name| format!("{name} {}", one.serial.as_deref().unwrap_or("")).trim().to_owned())
                })
                .collect(),
        ),
        several("lenses", all.iter().filter_map(|one| one.lens.clone()).collect()),
        several("focal lengths", all.iter().filter_map(|one| one.focal_mm.map(|mm| format!("{mm} mm"))).collect()),
    ]
    .into_iter()
    .flatten()
    .collect()
}
