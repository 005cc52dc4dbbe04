//! What the last bits of results depend on beside the code: the processor's instructions, and the functions of the system.

use std::fmt::Write as _;
use std::sync::OnceLock;

/// A fingerprint of both, in words and numbers. From machine to machine last bits differ; a store that several share keeps their results apart.
pub fn arithmetic() -> &'static str {
    static KNOWN: OnceLock<String> = OnceLock::new();
    KNOWN.get_or_init(|| format!("{} {} {}", std::env::consts::ARCH, lanes().join("+"), functions()))
}

/// Instructions that the lanes of operators, cameras and adjustments are compiled for.
#[cfg(target_arch = "x86_64")]
fn lanes() -> Vec<&'static str> {
    let known = [
        ("avx2", std::arch::is_x86_feature_detected!("avx2")),
        ("fma", std::arch::is_x86_feature_detected!("fma")),
        ("avx512f", std::arch::is_x86_feature_detected!("avx512f")),
        ("avx512bw", std::arch::is_x86_feature_detected!("avx512bw")),
        ("avx512dq", std::arch::is_x86_feature_detected!("avx512dq")),
        ("avx512vl", std::arch::is_x86_feature_detected!("avx512vl")),
    ];
    known.into_iter().filter_map(|(name, there)| there.then_some(name)).collect()
}

#[cfg(not(target_arch = "x86_64"))]
fn lanes() -> Vec<&'static str> {
    Vec::new()
}

/// A digest of what the system's functions give at 500 places each.
fn functions() -> String {
    let of_one: [fn(f64) -> f64; 8] = [f64::sin, f64::cos, f64::tan, f64::atan, f64::exp, f64::ln, f64::cbrt, f64::sqrt];
    let of_two: [fn(f64, f64) -> f64; 3] = [f64::atan2, f64::hypot, f64::powf];
    let mut hasher = blake3::Hasher::new();
    for place in 1..=500 {
        let at = std::hint::black_box(0.037 * f64::from(place));
        of_one.iter().for_each(|function| _ = hasher.update(&function(at).to_bits().to_le_bytes()));
        of_two.iter().for_each(|function| _ = hasher.update(&function(at, 1.7).to_bits().to_le_bytes()));
    }
    let mut text = String::new();
    hasher.finalize().as_bytes()[..8].iter().for_each(|byte| _ = write!(text, "{byte:02x}"));
    text
}
