//! OpenCV's methods, and the full `calibench` binary.
