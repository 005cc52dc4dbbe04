//! Certificates of camera calibrations: two pages of PDF/A with parameters, the uncertainty budget after GUM, a map over the frame, what is in doubt, and the digests of
//! all files; and whether these files, and the pages, are still the same.
//!
//! A certificate is made from a [`Record`] that `calibrate` writes. Record and digests are attached to the document.

mod answer;
mod budget;
mod certified;
mod digest;
mod digits;
mod document;
mod pages;
mod record;
mod verify;

pub use certified::{CertificateError, Certified, Sealed};
pub use digest::{digest_of, digest_of_file, line};
pub use record::{
    CameraRecord, Certificate, Equipment, Fields, FileEntry, FrameRecord, LIST_FILE, PlaceRecord, RECORD, RECORD_FILE, Record, Role,
    TaskFigure,
};
pub use verify::{Pages, Verified, attached, verify};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
