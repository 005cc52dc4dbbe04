//! Arrays as images.

use calibench_images::photo::grey::{of_bytes, of_words};
use calibench_model::Image;
use numpy::{Element, PyReadonlyArray2, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::error::{doubt, input};

/// Grey values in the hands of Python: of contiguous 32-bit numbers nothing is copied.
pub enum Grey<'py> {
    Lent(PyReadonlyArray2<'py, f32>),
    Own(Image<'static>),
}

/// What an image may be.
const EXPECTED: &str =
    "expected a two-dimensional array (rows, columns) of uint8, uint16, float32 or float64; floats are fractions of full scale";
/// All levels of a camera of 12 bits are below.
const TWELVE_BITS: u16 = 4096;
/// Grey values beyond this are no fractions of full scale.
const NO_FRACTION: f32 = 2.0;

impl<'py> Grey<'py> {
    /// Of an array of one of the four types.
    ///
    /// # Errors
    /// Anything else, by its type and shape.
    pub fn of(array: &Bound<'py, PyAny>) -> PyResult<Self> {
        let wrong = |found: String| input(format!("image: found {found}; {EXPECTED}"));
        let Ok(untyped) = array.cast::<PyUntypedArray>() else {
            return Err(wrong(format!("{}", array.get_type().name()?)));
        };
        let &[height, width] = untyped.shape() else { return Err(wrong(format!("an array of shape {:?}", untyped.shape()))) };
        if width == 0 || height == 0 {
            return Err(wrong(format!("an empty array of shape {:?}", untyped.shape())));
        }
        let own = |image: Option<Image<'static>>| image.map(Self::Own).ok_or_else(|| wrong("another number of values".into()));
        if let Ok(levels) = array.extract::<PyReadonlyArray2<'py, u8>>() {
            return own(of_bytes(width, height, &in_rows(&levels)));
        }
        if let Ok(levels) = array.extract::<PyReadonlyArray2<'py, u16>>() {
            let levels = in_rows(&levels);
            let most = levels.iter().fold(0, |most, level| level.max(&most).to_owned());
            if most < TWELVE_BITS {
                doubt(array.py(), &format!("image: levels up to {most} of 65535; of 10 or 12 bits multiply them, by 64 or 16"))?;
            }
            return own(of_words(width, height, &levels));
        }
        let grey = if let Ok(values) = array.extract::<PyReadonlyArray2<'py, f32>>() {
            if values.is_c_contiguous() { Self::Lent(values) } else { Self::Own(Image::new(width, height, in_rows(&values).into_owned())) }
        } else if let Ok(values) = array.extract::<PyReadonlyArray2<'py, f64>>() {
            Self::Own(Image::new(width, height, values.as_array().iter().map(|&value| value as f32).collect()))
        } else {
            return Err(wrong(format!("an array of {}", untyped.dtype())));
        };
        if let Some(most) = beyond(grey.image()?.grey()) {
            doubt(array.py(), &format!("image: grey values up to {most}; floats are fractions of full scale, 0 is black and 1 is white"))?;
        }
        Ok(grey)
    }

    /// The image.
    ///
    /// # Errors
    /// None that a user sees: [`Self::of`] has looked.
    pub fn image(&self) -> PyResult<Image<'_>> {
        match self {
            Self::Own(image) => Ok(image.lent()),
            Self::Lent(values) => {
                let (shape, values) = (values.shape(), values.as_slice().map_err(input)?);
                Image::borrowed(shape[1], shape[0], values).ok_or_else(|| input(EXPECTED))
            }
        }
    }
}

/// The largest grey value, if it is no fraction of full scale. In lanes, which a compiler turns into instructions that look at many at once.
fn beyond(grey: &[f32]) -> Option<f32> {
    let mut lanes = [0.0_f32; 32];
    let (chunks, rest) = grey.as_chunks::<32>();
    for chunk in chunks {
        for (lane, grey) in lanes.iter_mut().zip(chunk) {
            *lane = if *grey > *lane { *grey } else { *lane };
        }
    }
    let most = lanes.iter().chain(rest).fold(0.0, |most: f32, grey| most.max(*grey));
    (most > NO_FRACTION).then_some(most)
}

/// The values row by row: as they lie, or copied where they do not lie so.
fn in_rows<'a, T: Element + Copy>(array: &'a PyReadonlyArray2<'_, T>) -> std::borrow::Cow<'a, [T]> {
    match array.as_slice() {
        Ok(values) if array.is_c_contiguous() => values.into(),
        _ => array.as_array().iter().copied().collect::<Vec<T>>().into(),
    }
}
