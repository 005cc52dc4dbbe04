//! The numbers of a `[sensor]` table, with their bounds.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::wire::bounded;

bounded! {
    /// A coefficient of the fall-off.
    Coefficient(f64), f64 "f64", -100.0, 100.0;
    /// A change of light, as a fraction.
    Gradient(f64), f64 "f64", -2.0, 2.0;
    /// A grey value of reflectance 1.
    Exposure(f64), f64 "f64", 1e-6, 1e6;
    /// A colour's relative sensitivity.
    Sensitivity(f64), f64 "f64", 1e-3, 10.0;
    /// A factor of a colour.
    Factor(f64), f64 "f64", 1e-3, 1e3;
    /// A ratio, dB.
    Decibel(f64), f64 "f64", 0.0, 200.0;
    /// Electrons, photons or a gain.
    Positive(f64), f64 "f64", 1e-6, 1e9;
    /// Electrons per photon.
    QuantumEfficiency(f64), f64 "f64", 1e-3, 1.0;
    /// A standard deviation, %.
    Percent(f64), f64 "f64", 0.0, 100.0;
    /// Electrons a second.
    Current(f64), f64 "f64", 0.0, 1e6;
    /// Seconds.
    Time(f64), f64 "f64", 0.0, 1e5;
    /// A standard deviation, e-.
    Electron(f64), f64 "f64", 0.0, 1e6;
    /// A level, DN.
    Offset(f64), f64 "f64", 0.0, 32767.0;
    /// An exponent.
    GammaExponent(f64), f64 "f64", 0.1, 10.0;
    /// A standard deviation of smoothing, px.
    Smoothing(f64), f64 "f64", 0.0, 5.0;
    /// An amount of sharpening.
    Sharpening(f64), f64 "f64", -0.9, 5.0;
    /// A radius of sharpening, px.
    Radius(f64), f64 "f64", 0.1, 20.0;
    /// A grey value at which a shoulder begins.
    ShoulderStart(f64), f64 "f64", 0.0, 0.99;
    /// The slope of a curve.
    ShoulderGain(f64), f64 "f64", 1.0, 64.0;
    /// Quality of JPEG.
    Quality(u8), i64 "i64", 1, 100;
    /// A step of JPEG's quantisation.
    TableStep(u8), i64 "i64", 1, 255;
    /// A standard deviation of rows' places, px.
    Jitter(f64), f64 "f64", 0.0, 100.0;
}

/// `N` numbers in a list. (An array would take more numbers in silence.)
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec<T>", bound = "T: DeserializeOwned")]
pub struct Numbers<T, const N: usize>(pub [T; N]);

impl<T, const N: usize> TryFrom<Vec<T>> for Numbers<T, N> {
    type Error = String;

    fn try_from(numbers: Vec<T>) -> Result<Self, String> {
        numbers.try_into().map(Self).map_err(|wrong: Vec<T>| format!("expected {N} numbers in a list, found {}", wrong.len()))
    }
}

impl<T: JsonSchema, const N: usize> JsonSchema for Numbers<T, N> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("{N}_of_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "minItems": N, "maxItems": N, "items": T::json_schema(generator) })
    }
}

/// Bits of a converter.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "i64")]
pub struct ConverterBits(pub u32);

impl TryFrom<i64> for ConverterBits {
    type Error = String;

    fn try_from(bits: i64) -> Result<Self, String> {
        match bits {
            8 | 10 | 12 | 14 | 16 => Ok(Self(bits as u32)),
            _ => Err(format!("expected 8, 10, 12, 14 or 16 bits, found {bits}")),
        }
    }
}

impl JsonSchema for ConverterBits {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "ConverterBits".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "enum": [8, 10, 12, 14, 16] })
    }
}
