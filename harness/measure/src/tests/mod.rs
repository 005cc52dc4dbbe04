//! Images whose contents are known, for the tests of several operators. They share no code with any operator.

pub(crate) mod closed_form_images;
pub(crate) mod quadrature_images;
