//! The bookkeeping, by a published block.

use calibench_adjust::{Options, adjust};

use crate::networks;

#[test]
fn vosselman_and_foerstner_s_block() {
    let mut network = networks::vosselman_foerstner();
    assert_eq!(network.observations.len(), 32 * 32, "every circle is seen in every image");
    networks::shake_poses(&mut network, 0.02, 0.005, &mut networks::random(8));
    let solution = adjust(&network, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    let counts = solution.counts();
    assert_eq!((counts.observations(), counts.unknowns, counts.redundancy()), (2055, 384, 1671));
    assert_eq!((counts.image_coordinates, counts.observed, counts.constraints), (2048, 0, 7));
    assert!(solution.sigma0().is_some_and(|sigma0| sigma0 < 1e-9));
}
