//! What the adjustment must hold, by networks whose truth is known.

mod counts;
mod datum;
mod exact;
mod honest;
mod quality;
mod scenes;
mod weak;
