//! What the adjustment must hold, by networks whose truth is known.

mod counts;
mod crept;
mod datum;
mod distances;
mod gross;
mod inverse;
mod networks;
mod noise_free;
mod per_image;
mod projection_uncertainty;
mod quality;
mod rigs;
mod significance;
mod stand;
mod standard_deviations;
mod stands;
mod surfaces;
mod undetermined;
