//! Which target, when: boards of one size before one camera, by what makes images bad.

mod load;
mod page;
mod picture;

pub use load::{BOARD, Comparison, kind};
pub use page::{FILE, page, without_kinds};
