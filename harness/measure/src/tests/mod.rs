//! Images whose contents are known, and errors against the bound, for the tests of several operators. They share no formula with any operator.

pub(crate) mod bound;
pub(crate) mod closed_form_images;
pub(crate) mod junction_images;
pub(crate) mod no_corners;
pub(crate) mod quadrature_images;
