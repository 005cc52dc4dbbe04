//! Image coordinates and control to orientations, object points and their covariance. Truth is not known here.

pub mod approximate;
