//! What every study says of itself to whoever runs it.

/// A study as a scenario has it.
pub trait StudyPlan {
    /// The sets under which its figures stand in the records, in their order.
    fn sets(&self) -> Vec<String>;

    /// The labels of its own methods, in their order, where it measures no image points: none of the methods that do takes their place.
    fn own_methods(&self) -> Option<Vec<String>> {
        None
    }

    /// Whether it draws random numbers beside those of what is pictured.
    fn is_random(&self) -> bool {
        false
    }

    /// Whether the image points of every trial are kept, and not those of the first alone.
    fn keeps_points(&self) -> bool {
        false
    }

    /// Where image coordinates are drawn and no image is rendered: of each method, in the scenario's order, the standard deviation per axis, px; `None` for
    /// the hand.
    fn drawn(&self) -> Option<&[(String, Option<f64>)]> {
        None
    }

    /// Whether `run --all` leaves it, where it is left to the night, to a command of its own.
    fn runs_apart(&self) -> bool {
        false
    }

    /// The pixel pitch of the camera that it adjusts, um.
    fn pitch_um(&self) -> Option<f64> {
        None
    }
}
