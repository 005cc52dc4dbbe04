//! Says whether the networks of others that a test adjusts are there: `cfg(networks)`.

#[path = "../test_data.rs"]
mod test_data;

fn main() {
    test_data::announce(&[("networks", "networks")]);
}
