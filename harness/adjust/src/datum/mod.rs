//! The frame of the object.
