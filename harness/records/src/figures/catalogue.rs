//! Every figure that records hold.

use super::terms::Units::{Either, Number, Object, One, Parameter};
use super::{Better, Group, Kind, Units};

/// A row of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// What it is of.
    pub quantity: Quantity,
    /// Its group.
    pub group: Group,
    /// Its name in files. `{}` stands for what it is of (a station, a point, a cause), `{size}` for a size group, `{how}` for `single` or `joint`.
    pub pattern: &'static str,
    /// Its units.
    pub units: Units,
    /// Digits behind the point on pages, where a page has no reason for others.
    pub digits: usize,
    /// Which value is better.
    pub better: Better,
    /// The kind of result that alone has it; `None` for what several have.
    pub kind: Option<Kind>,
    /// What it means.
    pub meaning: &'static str,
}

macro_rules! catalogue {
    ($($quantity:ident: $group:ident $pattern:literal in $units:expr, $digits:literal, $better:ident, $kind:expr, $meaning:literal;)*) => {
        /// What a figure is a value of.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Quantity {
            $(#[doc = $meaning] $quantity,)*
        }

        impl Quantity {
            /// A row for each, in the order of the variants.
            pub const CATALOGUE: &'static [Entry] = &[$(Entry {
                quantity: Self::$quantity,
                group: Group::$group,
                pattern: $pattern,
                units: $units,
                digits: $digits,
                better: Better::$better,
                kind: $kind,
                meaning: $meaning,
            },)*];
        }
    };
}

const CAMERA: Option<Kind> = Some(Kind::Camera);
const FREE: Option<Kind> = Some(Kind::FreeNetwork);
const PAIRS: Option<Kind> = Some(Kind::ResidualPairs);
const SEEN: Option<Kind> = Some(Kind::Recognition);
const FOUND: Option<Kind> = Some(Kind::Detection);
const PRINT: Option<Kind> = Some(Kind::Printed);

catalogue! {
    // Cameras.
    Parameter: Iop "{parameter}" in Parameter, 3, Neither, CAMERA, "a parameter of the interior orientation";
    CentreX: Eop "{}/X0" in Object, 4, Neither, CAMERA, "X of the projection centre of an image";
    CentreY: Eop "{}/Y0" in Object, 4, Neither, CAMERA, "Y of the projection centre of an image";
    CentreZ: Eop "{}/Z0" in Object, 4, Neither, CAMERA, "Z of the projection centre of an image";
    Omega: Eop "{}/omega" in One("deg"), 4, Neither, None, "the first angle of rotation of an image";
    Phi: Eop "{}/phi" in One("deg"), 4, Neither, None, "the second angle of rotation of an image";
    Kappa: Eop "{}/kappa" in One("deg"), 4, Neither, None, "the third angle of rotation of an image";
    Sigma0: Network "sigma0" in Either(&["px", ""]), 3, Less, None, "standard deviation of a coordinate of unit weight, from the residuals";
    Redundancy: Network "redundancy" in Number, 0, More, None, "observations less unknowns";
    ImagePoints: Network "image points" in Number, 0, More, None, "image points that were adjusted";
    ImagesLeftOut: Network "images left out" in Number, 1, Less, CAMERA, "images with fewer points than a pose takes";
    Missed: Network "missed" in Number, 1, Less, CAMERA, "photographs of the calibration in which the board was not found";
    Runs: Network "runs" in Number, 0, Neither, CAMERA, "how often check points were intersected for the split of their errors";
    OverFrame: Frame "rms" in One("px"), 2, Less, CAMERA, "distance from the true camera over the frame, root mean square after the best rotation; its sigma is what the covariance predicts";
    // Whole calibration systems.
    OverCovered: Frame "covered" in One("px"), 2, Less, CAMERA, "the same over the part of the frame where something was measured";
    LengthError: Frame "length" in One("mm"), 3, Less, CAMERA, "error of a length of 100 mm across the line of sight, root mean square over the frame";
    SquareOverStated: Network "z2" in Number, 2, One, CAMERA, "mean square of errors over the frame in stated standard deviations";
    SquareOverStatedParameters: Network "z2 of parameters" in Number, 2, One, CAMERA, "mean square of errors of parameters in stated standard deviations";
    IsCalibrated: Network "calibrated" in Number, 2, Neither, CAMERA, "whether the system gave a camera and said nothing against it";
    IsDoubtful: Network "doubtful" in Number, 2, Neither, CAMERA, "whether it gave a camera and doubted it";
    IsRefused: Network "refused" in Number, 2, Neither, CAMERA, "whether it said that there is none to be had";
    IsFailed: Network "failed" in Number, 2, Less, CAMERA, "whether it failed";
    IsWrongAndSilent: Network "wrong and silent" in Number, 2, Less, CAMERA, "whether it gave a camera, said nothing against it, and was farther off than five stated standard deviations and a pixel";
    StatedRms: Network "stated rms" in One("px"), 3, Neither, CAMERA, "root mean square of residuals as the system reports it";
    PointsLeftOut: Network "points left out" in Number, 1, Neither, CAMERA, "image points that the system left out";
    // Networks that are adjusted as `calibrate` adjusts them.
    CostOverRedundancy: Network "cost over redundancy" in Number, 3, One, CAMERA, "weighted sum of squares over redundancy, with the stated precision";
    SquareOverCovariance: Network "square over covariance" in Number, 3, One, CAMERA, "square of the errors of all parameters of cameras and mounts together in their stated covariance, over their number";
    WithinRegion: Network "within 95 % region" in Number, 3, Neither, CAMERA, "whether all these errors together are within the region of 95 %";
    SquareOfLengths: Network "z2 of lengths" in Number, 3, One, CAMERA, "mean square of errors of lengths in stated standard deviations";
    LengthsWithin: Network "lengths within 95 %" in Number, 3, Neither, CAMERA, "share of the lengths within their intervals of 95 %";
    IsWrongMinimum: Network "wrong minimum" in Number, 4, Less, CAMERA, "whether the truth leads to a lower minimum than the one that was found";
    IsWrongMinimumAndSilent: Network "wrong minimum and silent" in Number, 4, Less, CAMERA, "whether it does, and nothing was said against the one that was found";
    // Lengths that calibrated cameras measure, by how.
    TaskLength: Network "length, {}" in Object, 3, Neither, CAMERA, "a length that is measured: the mean, with root mean squares of its standard uncertainties and errors";
    SquareOfTasks: Network "z2 of lengths, {}" in Number, 3, One, CAMERA, "mean square of errors of measured lengths in their standard uncertainties";
    TasksWithin: Network "lengths within 95 %, {}" in Number, 3, Neither, CAMERA, "share of the measured lengths within their intervals of 95 %";
    // What must be kept.
    AcceptancePass: Network "acceptance/pass" in Number, 3, More, CAMERA, "whether errors keep their limits, decided with the reference's uncertainty";
    AcceptanceFail: Network "acceptance/fail" in Number, 3, Less, CAMERA, "whether one is beyond its limit, decided likewise";
    AcceptanceCannotTell: Network "acceptance/cannot tell" in Number, 3, Less, CAMERA, "whether neither is decided";
    LargestLengthError: Network "largest error of a length" in Object, 4, Less, CAMERA, "the largest error of the tested lengths, by size";
    LargestOverLimit: Network "largest error of a length over its limit" in Number, 3, Less, CAMERA, "the largest error over its limit of the tested lengths";
    RmsOfLengthErrors: Network "rms error of lengths" in Object, 4, Less, CAMERA, "root mean square error of the tested lengths";
    // Check points.
    RmseX: Check "rmse_x" in Object, 4, Less, CAMERA, "root mean square error of check points in X";
    RmseY: Check "rmse_y" in Object, 4, Less, CAMERA, "root mean square error of check points in Y";
    RmseZ: Check "rmse_z" in Object, 4, Less, CAMERA, "root mean square error of check points in Z";
    RmseXy: Check "rmse_xy" in Object, 6, Less, CAMERA, "planimetric root mean square error of check points, in X and Y";
    RmseXyz: Check "rmse_xyz" in Object, 4, Less, CAMERA, "root mean square error of check points in space";
    RmseXySurvey: Check "rmse_xy_survey" in Object, 6, Less, CAMERA, "planimetric root mean square difference of check points from their surveyed coordinates";
    RmseZSurvey: Check "rmse_z_survey" in Object, 6, Less, CAMERA, "root mean square difference of check points from their surveyed coordinates in Z";
    Distance: Check "distance" in Object, 3, Neither, CAMERA, "mean distance of check points from the projection centres";
    CheckPoints: Check "points" in Number, 0, More, CAMERA, "check points that were intersected";
    // Which cause makes how much of the error of check points.
    NoCause: Check "none" in Object, 4, Less, CAMERA, "planimetric error with every cause off";
    AllCauses: Check "all" in Object, 4, Less, CAMERA, "planimetric error with every cause on";
    Interactions: Check "interactions" in Object, 4, Less, CAMERA, "what all causes together make beyond the sum of each alone";
    Alone: Check "alone/{}" in Object, 4, Less, CAMERA, "planimetric error with one cause on alone";
    Without: Check "without/{}" in Object, 4, Less, CAMERA, "planimetric error with one cause off and all others on";
    Share: Check "share/{}" in Number, 3, Neither, CAMERA, "share of a cause in the mean square of the whole error";
    PairOfCauses: Check "pair/{}+{}" in Object, 4, Less, CAMERA, "what two causes make beyond the sum of both alone";
    // Residuals and coordinates of the first trial.
    ImageResidual: Residual "{}" in One("px"), 3, Less, None, "root mean square residual of an image, per axis";
    ResidualX: Point "{}/{}/x" in One("px"), 3, Less, None, "residual in x of a point in an image";
    ResidualY: Point "{}/{}/y" in One("px"), 3, Less, None, "residual in y of a point in an image";
    ObjectX: Object "{}/X" in Object, 4, Neither, None, "X of an object point; of a printed network the absolute error that is predicted of it";
    ObjectY: Object "{}/Y" in Object, 4, Neither, None, "Y of an object point; of a printed network the absolute error that is predicted of it";
    ObjectZ: Object "{}/Z" in Object, 4, Neither, None, "Z of an object point; of a printed network the absolute error that is predicted of it";
    // Free networks.
    ParameterOfGroup: Iop "group {}/{parameter}" in Parameter, 3, Neither, FREE, "a parameter of the interior orientation of a group of images";
    Observations: Network "observations" in Number, 0, More, FREE, "observations: image coordinates, and coordinates that hold the frame";
    Held: Network "of them held" in Number, 0, Neither, FREE, "of the observations those that hold the frame";
    Unknowns: Network "unknowns" in Number, 0, Neither, FREE, "unknowns that were solved for";
    ShareOfRedundancy: Network "share of redundancy" in Number, 3, More, FREE, "redundancy over observations";
    Images: Network "images" in Number, 0, More, FREE, "images that were oriented";
    ImagesWithoutOrientation: Network "images without orientation" in Number, 0, Less, FREE, "images that were not oriented";
    Points: Network "points" in Number, 0, More, FREE, "object points";
    GrossErrors: Network "gross errors" in Number, 1, Less, FREE, "image points that were left out as gross errors";
    Iterations: Network "iterations" in Number, 0, Less, FREE, "iterations of the adjustment";
    Sigma0Um: Network "sigma0 in um" in One("um"), 2, Less, FREE, "sigma0 in um on the sensor";
    Sigma0OfNetwork: Network "sigma0/{}" in One("px"), 4, Less, FREE, "sigma0 of one of several networks";
    Networks: Network "networks" in Number, 0, Neither, FREE, "networks that were adjusted, each by itself";
    ImageScale: Network "image scale" in One("px"), 1, Neither, FREE, "pixels to an object unit";
    RowsOverColumns: Network "rows over columns" in Number, 2, Neither, FREE, "root mean square residual in y over that in x";
    BendX: Network "bend along X" in Object, 3, Less, FREE, "height in the middle over that at a stated distance along X, of the surface through all points";
    BendY: Network "bend along Y" in Object, 3, Less, FREE, "height in the middle over that at a stated distance along Y, of the surface through all points";
    CoordinateError: Network "error of a coordinate" in One("px"), 4, Less, FREE, "root mean square error of an image coordinate against the truth";
    Lost: Network "lost" in Number, 4, Less, FREE, "share of image points more than a pixel from the truth";
    Rejected: Network "rejected" in Number, 4, Less, FREE, "share of image points that the operator rejected";
    OwnSigma: Network "own sigma" in One("px"), 4, Less, FREE, "standard deviation of a coordinate as the operator itself says";
    OwnSigmaOverSigma0: Network "own sigma over sigma0" in Number, 2, Neither, FREE, "the operator's own standard deviation over sigma0, 1 if both are right";
    // Residuals in pairs of images.
    CorrelationWithin: Network "correlation within pairs" in Number, 3, Neither, PAIRS, "correlation of the residuals of equal targets within the pairs";
    CorrelationAcross: Network "correlation across pairs" in Number, 3, Neither, PAIRS, "the same between the first image of a pair and the second of another";
    Pairs: Network "pairs" in Number, 0, Neither, PAIRS, "pairs of images with targets in common";
    // Recognition, by classifier and group of images.
    SeenImages: Network "{}/images/{}" in Number, 0, Neither, SEEN, "images that were searched";
    SeenGrids: Network "{}/grids/{}" in Number, 0, More, SEEN, "images in which the grid was found";
    SeenTargets: Network "{}/targets/{}" in Number, 0, More, SEEN, "dark areas of whole squares that are a target";
    Labels: Network "{}/labels/{}" in Number, 0, More, SEEN, "labels that were given";
    Labelled: Network "{}/labelled/{}" in Number, 0, More, SEEN, "targets with their own label within 2 px of their truth";
    WrongLabels: Network "{}/wrong labels/{}" in Number, 0, Less, SEEN, "labels whose target is elsewhere";
    OfSize: Network "{}/{size}/{}" in Number, 0, Neither, SEEN, "targets of a size group";
    WrongKinds: Network "{}/{how} wrong, {size}/{}" in Number, 0, Less, SEEN, "targets of a size group taken for the other kind, by themselves or jointly";
    WrongKindsPercent: Network "{}/{how} wrong, %, {size}/{}" in Number, 2, Less, SEEN, "their share, %";
    WrongKindsOfAll: Network "{}/{how} wrong, {size}" in Number, 0, Less, SEEN, "the same over all images";
    KindsOfAll: Network "{}/{how} of {size}" in Number, 0, Neither, SEEN, "targets of a size group over all images";
    TakenFor: Network "{}/{how}, {kind} taken for {kind}/{}" in Number, 0, Less, SEEN, "targets of a kind taken for another one";
    Lines: Network "{}/lines/{}" in Number, 0, More, SEEN, "lines of the grid that were found where their true places are known";
    LineError: Network "{}/line error/{}" in One("px"), 3, Less, SEEN, "root mean square distance of lines from the true places of the nodes on them, across";
    LineErrorMost: Network "{}/line error, most/{}" in One("px"), 3, Less, SEEN, "the same of the one line of which it is largest";
    LineErrorMostOfAll: Network "{}/line error, most" in One("px"), 3, Less, SEEN, "the same over all images";
    // Finders of boards.
    BoardGrids: Network "board/grids/all" in Number, 0, More, FOUND, "images in which the board was found";
    BoardImages: Network "board/images/all" in Number, 0, Neither, FOUND, "images that were searched";
    BoardLabelled: Network "board/labelled/all" in Number, 0, More, FOUND, "points in view with their own name";
    BoardLabels: Network "board/labels/all" in Number, 0, More, FOUND, "points that were named";
    BoardNotExpected: Network "board/not expected/all" in Number, 0, Neither, FOUND, "points at the border with their own name";
    BoardOff: Network "board/off/all" in Number, 0, Less, FOUND, "points where none of the board is";
    BoardTargets: Network "board/targets/all" in Number, 0, Neither, FOUND, "points of the board that are in view";
    BoardWrongLabels: Network "board/wrong labels/all" in Number, 0, Less, FOUND, "points with the name of another one";
    // Printed figures, and what follows from them.
    Pitch: Network "{}, um" in One("um"), 3, Neither, PRINT, "a pixel size";
    MillionPixels: Network "million pixels" in Number, 3, Neither, PRINT, "pixels of the sensor";
    PrintedCheckPoints: Network "check points" in Number, 0, Neither, PRINT, "check points whose errors are printed";
    LessFirst: Network "c less that of the first column, mm" in One("mm"), 3, Neither, PRINT, "principal distance less that of the first column";
    FoldCorrectionRadius: Network "fold as a correction, radius, mm" in One("mm"), 3, More, PRINT, "radius at which a camera folds over, its coefficients taken as a correction";
    FoldCorrectionShare: Network "fold as a correction, share of the frame, %" in One("%"), 3, Less, PRINT, "share of the frame beyond that radius";
    FoldOwnRadius: Network "fold of the tool's own, radius, mm" in One("mm"), 3, More, PRINT, "radius at which a camera folds over, in the tool's own direction";
    FoldOwnShare: Network "fold of the tool's own, share of the frame, %" in One("%"), 3, Less, PRINT, "share of the frame beyond that radius";
    InverseError: Network "error of the inverse, px" in One("px"), 3, Less, PRINT, "largest distance between a pixel and where the camera pictures its ray";
    PowerK1: Network "k1: power of c" in Number, 3, Neither, PRINT, "by which power of c the tool's k1 is divided";
    PowerK2: Network "k2: power of c" in Number, 3, Neither, PRINT, "by which power of c the tool's k2 is divided";
    PowerK3: Network "k3: power of c" in Number, 3, Neither, PRINT, "by which power of c the tool's k3 is divided";
    P1OfFirst: Network "p1: of the first" in Number, 3, Neither, PRINT, "share of the tool's first tangential coefficient in p1, over c";
    P1OfSecond: Network "p1: of the second" in Number, 3, Neither, PRINT, "share of the tool's second tangential coefficient in p1, over c";
    P2OfFirst: Network "p2: of the first" in Number, 3, Neither, PRINT, "share of the tool's first tangential coefficient in p2, over c";
    P2OfSecond: Network "p2: of the second" in Number, 3, Neither, PRINT, "share of the tool's second tangential coefficient in p2, over c";
    ExactRms: Network "exact conversion, rms, px" in One("px"), 3, Less, PRINT, "root mean square distance of the exact conversion from the tool's camera";
    ExactMost: Network "exact conversion, most, px" in One("px"), 3, Less, PRINT, "largest distance of the exact conversion from the tool's camera";
    DirectRms: Network "direct conversion, rms, px" in One("px"), 3, Less, PRINT, "root mean square distance of the direct conversion from the tool's camera";
    DirectMost: Network "direct conversion, most, px" in One("px"), 3, Less, PRINT, "largest distance of the direct conversion from the tool's camera";
    DirectRmsTurned: Network "direct conversion, rms after rotation, px" in One("px"), 3, Less, PRINT, "the same after the best rotation";
    DirectMostTurned: Network "direct conversion, most after rotation, px" in One("px"), 3, Less, PRINT, "the same after the best rotation";
    DirectRmsOnObject: Network "direct conversion, rms on the object, {}" in Object, 3, Less, PRINT, "the same on the object";
    DirectMostOnObject: Network "direct conversion, most on the object, {}" in Object, 3, Less, PRINT, "the same on the object";
    DifferenceRms: Network "difference, rms after rotation, px" in One("px"), 3, Less, PRINT, "root mean square distance of a changed camera from the printed one";
    DifferenceMost: Network "difference, most after rotation, px" in One("px"), 3, Less, PRINT, "largest distance of a changed camera from the printed one";
    DifferenceOnObject: Network "difference, rms on the object, {}" in Object, 3, Less, PRINT, "root mean square distance of a changed camera from the printed one, on the object";
    ComparedWithin: Network "compared within, px" in One("px"), 1, Neither, PRINT, "radius within which cameras are compared, where one folds over";
    PrintedX: Check "RMSE X, {}" in Object, 3, Less, PRINT, "RMSE X of the printed errors";
    PredictedX: Network "predicted RMSE X, {}" in Object, 3, Less, PRINT, "RMSE X of the predicted errors";
    PredictedXOf: Network "{}: predicted RMSE X, {}" in Object, 3, Less, PRINT, "RMSE X of the predicted errors of a column, in a network that is fitted again";
    PrintedY: Check "RMSE Y, {}" in Object, 3, Less, PRINT, "RMSE Y of the printed errors";
    PredictedY: Network "predicted RMSE Y, {}" in Object, 3, Less, PRINT, "RMSE Y of the predicted errors";
    PredictedYOf: Network "{}: predicted RMSE Y, {}" in Object, 3, Less, PRINT, "RMSE Y of the predicted errors of a column, in a network that is fitted again";
    PrintedZ: Check "RMSE Z, {}" in Object, 3, Less, PRINT, "RMSE Z of the printed errors";
    PredictedZ: Network "predicted RMSE Z, {}" in Object, 3, Less, PRINT, "RMSE Z of the predicted errors";
    PredictedZOf: Network "{}: predicted RMSE Z, {}" in Object, 3, Less, PRINT, "RMSE Z of the predicted errors of a column, in a network that is fitted again";
    PrintedPlanimetric: Check "planimetric RMSE, {}" in Object, 3, Less, PRINT, "planimetric RMSE of the printed errors";
    PredictedPlanimetric: Network "predicted planimetric RMSE, {}" in Object, 3, Less, PRINT, "planimetric RMSE of the predicted errors";
    PredictedPlanimetricOf: Network "{}: predicted planimetric RMSE, {}" in Object, 3, Less, PRINT, "planimetric RMSE of the predicted errors of a column, in a network that is fitted again";
    PrintedSpatial: Check "spatial RMSE, {}" in Object, 3, Less, PRINT, "spatial RMSE of the printed errors";
    PredictedSpatial: Network "predicted spatial RMSE, {}" in Object, 3, Less, PRINT, "spatial RMSE of the predicted errors";
    PredictedSpatialOf: Network "{}: predicted spatial RMSE, {}" in Object, 3, Less, PRINT, "spatial RMSE of the predicted errors of a column, in a network that is fitted again";
    Misfit: Network "misfit, {}" in Object, 3, Less, PRINT, "root mean square of predicted less printed absolute errors";
    MisfitOf: Network "{}: misfit, {}" in Object, 3, Less, PRINT, "the same of a column, in a network that is fitted again";
    MisfitFitted: Network "misfit of what is fitted, {}" in Object, 3, Less, PRINT, "root mean square misfit over the fitted columns";
    MisfitOverPrinted: Network "misfit over that of the printed cameras" in Number, 3, Less, PRINT, "misfit with a changed camera over that with the printed ones";
    Starts: Network "starts" in Number, 0, Neither, PRINT, "starts from which the network was fitted";
    PredictedNear: Network "errors predicted nearly" in Number, 0, More, PRINT, "errors of columns that are not fitted whose predictions are as near as the scenario says";
    StartsAlike: Network "starts that end here" in Number, 0, More, PRINT, "starts that end in the best network";
    SiteDistance: Eop "distance, {}" in Object, 3, Neither, PRINT, "a number of the fitted network of stations: distance";
    SiteCurve: Eop "curve, {}" in Object, 3, Neither, PRINT, "a number of the fitted network of stations: curve";
    SiteHalfBase: Eop "half base, {}" in Object, 3, Neither, PRINT, "a number of the fitted network of stations: half base";
    SiteShift: Eop "shift, {}" in Object, 3, Neither, PRINT, "a number of the fitted network of stations: shift";
    SiteHeight: Eop "height, {}" in Object, 3, Neither, PRINT, "a number of the fitted network of stations: height";
    SiteHeightStep: Eop "height step, {}" in Object, 3, Neither, PRINT, "a number of the fitted network of stations: height step";
    SiteAimToTheRight: Eop "aim to the right, {}" in Object, 3, Neither, PRINT, "a number of the fitted network of stations: aim to the right";
    SiteAimSpread: Eop "aim spread, {}" in Object, 3, Neither, PRINT, "a number of the fitted network of stations: aim spread";
    SiteAimUpwards: Eop "aim upwards, {}" in Object, 3, Neither, PRINT, "a number of the fitted network of stations: aim upwards";
    StationX: Eop "{}/X" in Object, 2, Neither, PRINT, "X of a station of the fitted network";
    StationY: Eop "{}/Y" in Object, 2, Neither, PRINT, "Y of a station of the fitted network";
    StationZ: Eop "{}/Z" in Object, 2, Neither, PRINT, "Z of a station of the fitted network";
}
