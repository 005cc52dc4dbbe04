//! The names of what is measured.

/// By operator and view: corners measured; beside it how many all comparable operators have; of how many.
pub const CORNERS: &str = "corners";
/// A corner that an operator rejected.
pub const REJECTED: &str = "rejected";
/// How many parameters a model solves for.
pub const PARAMETERS: &str = "parameters";
/// By view: RMS of the residuals of the adjustment of all views.
pub const RESIDUALS: &str = "residuals";
/// By view: RMS error of the half of its corners predicted from the other half, the camera calibrated without the view.
pub const HOLDOUT: &str = "holdout";
/// By view: the same, one side of the field from the other.
pub const ACROSS: &str = "across";
/// By view: how far rows and columns are from straight, the camera calibrated without the view.
pub const STRAIGHT: &str = "straight";
/// By split: RMS difference of the cameras of two halves over the frame; beside it the predicted one.
pub const SPLIT: &str = "split";
/// By split: the modes of that difference, squared over their predicted variance, mean; of how many; beside it the chance of as much.
pub const SPLIT_TEST: &str = "split_test";
/// By place `x:y`: RMS difference of halves over all splits; beside it the predicted one.
pub const MAP: &str = "map";
/// The principal point, by set of views; beside it the predicted standard deviation.
pub const PRINCIPAL: [&str; 2] = ["principal_x", "principal_y"];
/// Predicted standard deviation (2D) of the camera over the frame, RMS; beside it the one that leaving photographs out shows.
pub const FRAME: &str = "frame";
/// In how many modes, of equal weight, the camera is uncertain over the frame.
pub const FRAME_MODES: &str = "frame_modes";
/// Standard deviation (2D) of a projected point far away: `centre`, and `corner`, the worst of four.
pub const UNCERTAINTY: &str = "uncertainty";
/// By another model: RMS difference of the cameras of all views over the frame; beside it the largest.
pub const BESIDE: &str = "beside";
/// The RMS difference where corners were measured.
pub const BESIDE_SEEN: &str = "beside_seen";
/// RMS difference from the published camera over the frame; beside it the predicted standard deviation of ours.
pub const PUBLISHED: &str = "published";
/// Standard deviation (2D) over the frame that the published camera states of itself, RMS.
pub const PUBLISHED_SIGMA: &str = "published_sigma";
/// The largest such difference.
pub const PUBLISHED_MOST: &str = "published_most";
/// The RMS difference from the published camera where corners were measured.
pub const PUBLISHED_SEEN: &str = "published_seen";
/// By view: RMS residual of our corners with the published camera held.
pub const PUBLISHED_VIEW: &str = "published_view";
/// By view: as [`HOLDOUT`], the corners of the board freed in the other views.
pub const BOARD_FREED: &str = "board_freed";
/// By view: as [`HOLDOUT`], with nominal corners in the place of measured ones.
pub const BOARD_NOMINAL: &str = "board_nominal";
/// `in the plane` (2D), `across`: how far freed corners are from where the field has them, RMS; beside it the standard deviation of that.
pub const BOARD_MOVED: &str = "board_moved";
