//! What the wheel weighs: of functions of the same code one is kept.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if folds() {
        println!("cargo::rustc-link-arg-cdylib=-Wl,--icf=all");
    }
}

/// Whether the linker is the one that Rust brings for this system, which folds functions; GNU's does not know how.
fn folds() -> bool {
    let is = |key: &str, value: &str| env::var(format!("CARGO_CFG_TARGET_{key}")).is_ok_and(|found| found == value);
    let flags = env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default();
    let own = env::var_os("RUSTC_LINKER").is_some() || flags.split('\u{1f}').any(|flag| flag.contains("link"));
    is("OS", "linux") && is("ARCH", "x86_64") && is("ENV", "gnu") && !own
}
