"""What calibench computes, in Rust. Use it through `calibench`."""

import os
from pathlib import Path
from typing import Any, Callable, Dict, List, Literal, Mapping, Optional, Sequence, Tuple, Union, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
__all__ = [
    "Calibration",
    "CalibrationError",
    "Camera",
    "CameraError",
    "Difference",
    "DoubtWarning",
    "Error",
    "Identified",
    "InputError",
    "Judgement",
    "LossWarning",
    "Measured",
    "Pose",
    "Records",
    "ScenarioError",
    "Shot",
    "Targets",
    "UnavailableError",
    "__version__",
    "accept_lengths",
    "accept_points",
    "add_method",
    "board",
    "calibrate",
    "confine",
    "detect",
    "diff",
    "identify",
    "judge",
    "league",
    "measure",
    "merge",
    "methods",
    "render",
    "report",
    "restored",
    "run",
    "run_part",
    "scenarios",
    "task",
    "undistort",
    "undistort_points",
    "shipped",
]

_Path = Union[str, "os.PathLike[str]"]
_Size = Sequence[int]
#: `9x6:25` (inner corners and the side of a square) or another board in a word, (n, 3) object coordinates, or names with coordinates.
_Board = Union[str, ArrayLike, Mapping[str, Sequence[float]]]

class Error(Exception):
    """What calibench cannot do, in the words of the command line."""

class InputError(Error):
    """What was given cannot be used: the message says what was expected, and what to do."""

class ScenarioError(InputError):
    """A scenario or a plug-in's file with mistakes, each with its line and column."""

class CameraError(InputError):
    """A camera file that cannot be read or written, or a camera that cannot be converted."""

class CalibrationError(Error):
    """No calibration: too few points, unknowns that nothing determines, no convergence."""

class UnavailableError(Error):
    """What this build or machine cannot do."""

class DoubtWarning(UserWarning):
    """A result that is doubtful, and why: what the command line says on standard error, or ends with exit code 3 for."""

class LossWarning(UserWarning):
    """What a file or a convention has no place for, or what was left out of a file that was read."""

@final
class Pose:
    """Exterior orientation: X_camera = R X + t, with camera axes x right, y down, z forward, as in OpenCV."""

    @property
    def R(self) -> NDArray[np.float64]:
        """(3, 3): from object axes to the camera's."""
    @property
    def t(self) -> NDArray[np.float64]:
        """(3,), object units."""
    @property
    def centre(self) -> NDArray[np.float64]:
        """(3,): the projection centre, object units."""
    @property
    def angles(self) -> Tuple[float, float, float]:
        """omega, phi, kappa, degrees: of the photogrammetric camera, which looks along its -z."""

@final
class Camera:
    """A camera with what is known of it: parameters in its own convention, covariance, pixel pitch."""

    @staticmethod
    def read(
        path: _Path, *, size: Optional[_Size] = None, camera: Optional[str] = None, format: Optional[str] = None, fisheye: Optional[bool] = None
    ) -> "Camera":
        """The camera of a file of any known format, found by content: the first, or the one called or numbered `camera`.

        `size` is that of the images, (columns, rows), where the file does not state it; `format` decides where more than
        one reads the file; `fisheye` says which of OpenCV's cameras it is where the file does not.
        """
    @staticmethod
    def read_all(
        path: _Path, *, size: Optional[_Size] = None, format: Optional[str] = None, fisheye: Optional[bool] = None
    ) -> List["Camera"]:
        """All cameras of a file."""
    def convert(
        self,
        to: str,
        *,
        model: Optional[str] = None,
        pitch: Optional[float] = None,
        base: Optional[float] = None,
        radius: Optional[float] = None,
        rotation: bool = False,
        accept: bool = False,
    ) -> "Camera":
        """The same camera in another convention, or for another tool: as `calibench convert` does.

        `pitch` (um) for conventions in mm, `base` (mm) for Ebner's; `radius` (px) fits and holds only so far from the axis;
        `rotation` lets the fit turn the camera; `accept` takes residuals above 0.5 px, which are refused otherwise.
        """
    def reframe(
        self,
        *,
        crop: Optional[Tuple[int, int, int, int]] = None,
        size: Optional[_Size] = None,
        scale: Optional[float] = None,
        binned: Optional[int] = None,
        turn: Optional[int] = None,
    ) -> "Camera":
        """The same camera in other images: of a part of them, then in another size, then turned: as `calibench convert` does.

        `crop` is the first column and row, counted from 0, columns and rows; `size` is (columns, rows), `scale` a factor, `binned`
        how many pixels along each side make one: one of the three; `turn` is 90, 180 or 270 degrees, clockwise, the camera's axes
        with the images. Exact, covariance and pitch along; what the model does not hold is refused.
        """
    def write(self, path: _Path, *, to: Optional[str] = None) -> None:
        """Write a file: as converted or read, in the convention `to`, or in the one that the file's ending asks for."""
    def project(self, points: ArrayLike) -> NDArray[np.float64]:
        """(n, 3) in the camera's axes (x right, y down, z forward) to (n, 2) px; NaN for what is not pictured."""
    def unproject(self, px: ArrayLike) -> NDArray[np.float64]:
        """(n, 2) px to rays (n, 3) of length 1 in the camera's axes; NaN for what no ray comes to."""
    def undistort(self, px: ArrayLike) -> NDArray[np.float64]:
        """(n, 2) px to where they would be without distortion, with the same focal lengths and principal point."""
    @property
    def size(self) -> Tuple[int, int]:
        """Columns and rows, px."""
    @property
    def model(self) -> str:
        """The name of its convention."""
    @property
    def name(self) -> str:
        """Its name in the file; empty where the format has none."""
    @property
    def pitch(self) -> Optional[float]:
        """Pixel pitch, um, if known."""
    @property
    def parameters(self) -> Dict[str, float]:
        """The parameters by their names, in the convention's units."""
    @property
    def units(self) -> Dict[str, str]:
        """The units of the parameters; empty for numbers."""
    @property
    def covariance(self) -> Optional[NDArray[np.float64]]:
        """Of all parameters in their order, zero for those that were held; None where none is stated."""
    @property
    def fit(self) -> Optional[Tuple[float, float]]:
        """RMS and largest residual of the fit that made it, px; None if it is as it was read, or exact."""
    @property
    def notes(self) -> List[str]:
        """What is to be known of how it was read."""

@final
class Identified:
    """What board is in an image of which nothing is known."""

    @property
    def board(self) -> Optional[str]:
        """The words by which it is found in this image, its lengths in sides of a square or a marker, or in distances of circles; None of markers by themselves."""
    @property
    def words(self) -> str:
        """Kind, counts, dictionary and pattern."""
    @property
    def points(self) -> int:
        """How many of its points are seen."""
    @property
    def markers(self) -> List[int]:
        """The ids of its markers, ascending; of boards without markers none."""

@final
class Targets:
    """Targets in an image, one a row."""

    @property
    def target(self) -> List[str]:
        """Names."""
    @property
    def kind(self) -> List[Optional[str]]:
        """Kinds; None where not known."""
    @property
    def xy(self) -> NDArray[np.float64]:
        """(n, 2), px; NaN for what has no place in the image plane."""
    @property
    def axes(self) -> NDArray[np.float64]:
        """(n, 2, 2): columns are the target's own axes (u right, v down, in its size) in the image, px; NaN where not known."""
    @property
    def object(self) -> NDArray[np.float64]:
        """(n, 3), object units; NaN in a flat scene and where not known."""
    @property
    def visibility(self) -> List[str]:
        """visible, clipped, hidden or outside."""
    def __len__(self) -> int: ...

@final
class Shot:
    """An image and all that is known of it."""

    @property
    def name(self) -> str:
        """The station's name, or `image` in a flat scene."""
    @property
    def image(self) -> NDArray[np.float32]:
        """(rows, columns), fractions of full scale."""
    @property
    def truth(self) -> Targets:
        """Every target."""
    @property
    def starts(self) -> Targets:
        """Where measuring starts: what the scenario's hand or detector gives a method."""
    @property
    def camera(self) -> Optional[Camera]:
        """The true camera; None in a flat scene."""
    @property
    def pose(self) -> Optional[Pose]:
        """Where it stood; None in a flat scene."""

@final
class Measured:
    """What a method made of points, one a row."""

    @property
    def xy(self) -> NDArray[np.float64]:
        """(n, 2), px; NaN for what was rejected."""
    @property
    def cov(self) -> NDArray[np.float64]:
        """(n, 2, 2), px^2; NaN where the method gives none."""
    @property
    def status(self) -> List[str]:
        """measured or rejected."""
    @property
    def reason(self) -> List[Optional[str]]:
        """Why a point was rejected."""
    @property
    def method(self) -> str:
        """The method with its parameters, in one word."""
    @property
    def version(self) -> str:
        """Its version."""
    def __len__(self) -> int: ...

@final
class Calibration:
    """A calibrated camera and its quality."""

    @property
    def camera(self) -> Camera:
        """With its covariance."""
    @property
    def sigma(self) -> Dict[str, float]:
        """Standard deviations of the parameters that were solved for, in their units."""
    @property
    def solved(self) -> List[str]:
        """Their names: rows and columns of `covariance`."""
    @property
    def covariance(self) -> NDArray[np.float64]:
        """(p, p), in their units."""
    @property
    def residuals(self) -> List[NDArray[np.float64]]:
        """(n, 2) for each image given: adjusted less observed, px; NaN where there is no point."""
    @property
    def used(self) -> List[List[bool]]:
        """For each image given whether each point took part."""
    @property
    def poses(self) -> Dict[str, Pose]:
        """By the names of images."""
    @property
    def per_image(self) -> Dict[str, Dict[str, Tuple[float, float]]]:
        """What each image has for itself beside the camera of all: by image and number, its value and its standard deviation."""
    @property
    def sigma0(self) -> Optional[float]:
        """The standard deviation of an image coordinate over the a-priori one; None without redundancy."""
    @property
    def rms_px(self) -> float:
        """Root mean square of the residuals in use, 2D, px."""
    @property
    def doubts(self) -> List[str]:
        """What is doubtful, in words; with any the command line ends with exit code 3."""
    @property
    def doubted(self) -> List[Dict[str, Any]]:
        """The same for programs: dicts of `subject` (a word), `p`, `moves` and `words`; None where a number is not known."""
    @property
    def suspected(self) -> List[Dict[str, Any]]:
        """What the input may be in truth where the result is in doubt, first what explains it best: `kind`, `what` and `rms_px`, or None there."""
    @property
    def warnings(self) -> List[str]:
        """What is to be known and is no doubt: what the summary calls warnings."""
    @property
    def summary(self) -> str:
        """What the command line prints."""

@final
class Difference:
    """How far two cameras differ over the frame."""

    @property
    def rms_px(self) -> float: ...
    @property
    def max_px(self) -> float: ...
    @property
    def max_at(self) -> Tuple[float, float]:
        """Where the largest is, px."""
    @property
    def rotation_deg(self) -> float:
        """The best rotation, which was taken out."""
    @property
    def compensated_rms_px(self) -> Optional[float]:
        """What remains after the best change of principal distance and point."""
    @property
    def not_comparable(self) -> float:
        """Share of the region that one of the cameras does not picture."""
    @property
    def vectors(self) -> NDArray[np.float64]:
        """(n, 4): x, y, dx, dy on a grid over the frame, px."""

@final
class Judgement:
    """A verdict and the figures behind it."""

    @property
    def operator(self) -> str:
        """The operator to be trusted."""
    @property
    def model(self) -> str:
        """The camera model to be trusted."""
    @property
    def verdict(self) -> str:
        """What the command line prints."""
    @property
    def doubt(self) -> Optional[str]:
        """Why the verdict is in doubt, if so."""
    @property
    def limit_px(self) -> Optional[float]:
        """Below which the camera's error over the frame is in 95 of 100 cases, px RMS."""
    @property
    def in_use(self) -> Optional[Literal["holds", "moved", "cannot tell"]]:
        """What the photographs say of the camera in use, if one was given."""
    @property
    def columns(self) -> Dict[str, Any]:
        """The figures: method, model, measure, place, value, sigma, count, unit, status, reason."""

@final
class Records:
    """What a run left."""

    @staticmethod
    def read(folder: _Path) -> "Records":
        """The records of a run that are there."""
    @property
    def folder(self) -> Optional[Path]:
        """Where they are; None where they go with this object."""
    @property
    def points(self) -> Dict[str, Any]:
        """What was measured, a row a point: numbers as arrays (NaN where there is none), texts as lists. Of a sweep all cells."""
    @property
    def adjustments(self) -> Dict[str, Any]:
        """What was adjusted, a row a figure; empty where nothing was."""

def render(
    scenario: str, *, trial: int = 0, seed: Optional[int] = None, stations: Optional[Sequence[str]] = None, root: Optional[_Path] = None
) -> List[Shot]:
    """The images of one trial of a scenario (a name of the project, or a TOML file), with their truth. Of a sweep the first cell's."""

def measure(
    image: NDArray[Any],
    xy: ArrayLike,
    method: str = "forstner",
    *,
    kind: Union[None, str, Sequence[str]] = None,
    axes: Optional[ArrayLike] = None,
    cov: Optional[ArrayLike] = None,
) -> Measured:
    """Measure points of an image, from approximate positions (n, 2): as `calibench measure` does.

    The image is (rows, columns) of uint8, uint16, float32 or float64; floats are fractions of full scale. `kind` says what
    is pictured, of all points or of each; `axes` (n, 2, 2) its own axes in the image, `cov` (n, 2, 2) how far the start may
    be off, px^2.
    """

@overload
def detect(
    image: NDArray[Any],
    board: Optional[str] = None,
    *,
    all: Literal[False] = False,
    testfield: Optional[str] = None,
    classifier: str = "modern",
    root: Optional[_Path] = None,
) -> Optional[Targets]:
    """Find a board (`9x6`; `charuco:8x5:30:21:DICT_4X4_50`, ...) or the coded field of a scenario; None where it is not seen.

    With `all=True` each of several such boards, from the left, in a list.
    """

@overload
def detect(
    image: NDArray[Any],
    board: Optional[str] = None,
    *,
    all: Literal[True],
    testfield: Optional[str] = None,
    classifier: str = "modern",
    root: Optional[_Path] = None,
) -> List[Targets]: ...
def identify(image: NDArray[Any]) -> Optional[Identified]:
    """What board is in an image of which nothing is known; None where none is that is known: as `calibench detect --board unknown` says."""

def board(text: str) -> List[Tuple[str, List[float]]]:
    """Names and object coordinates of a board's points, as of 9x6:25: X to the right, Y upwards, Z towards the viewer."""

def calibrate(
    xy: Sequence[Union[ArrayLike, Measured]],
    board: _Board,
    *,
    size: _Size,
    images: Optional[Sequence[str]] = None,
    model: Optional[str] = None,
    pitch: Optional[float] = None,
    solve: Optional[Sequence[str]] = None,
    priors: Optional[Sequence[str]] = None,
    per_image: Optional[Sequence[str]] = None,
    start: Optional[Camera] = None,
    datum: str = "control",
    board_shape: str = "tested",
    sigma: Optional[float] = None,
    covariances: bool = False,
    huber: Optional[float] = None,
    snoop: Optional[bool] = None,
    compare: Optional[Sequence[Sequence[str]]] = None,
    limit: Optional[float] = None,
    board_file: Optional[_Path] = None,
    save_board: Optional[_Path] = None,
    board_scale: Optional[Tuple[float, float]] = None,
    print_noise: Optional[float] = None,
) -> Calibration:
    """Calibrate a camera: as `calibench calibrate --points --control` does.

    `xy` has one array for each image, with a row for each point of the board, NaN where it was not measured; what `measure`
    returned does as well, and its covariances are weights with `covariances=True`. `images` are their names; `solve`, `priors` (as k1=-3e-4:1e-5), `per_image` (as c:2 or c), `datum`,
    `board_shape`, `sigma` (px), `huber`, `snoop`, `compare` and `limit` (px) are as on the command line: `snoop=False` (`--plain` there) keeps all image points,
    `True` leaves out all that Baarda's test rejects, `None` what is wrong for itself beyond doubt. `save_board` writes the board's own corners as these images show
    them, `board_file` takes such a file; `board_scale` is (true over nominal length, standard deviation) of the print, `print_noise` the standard deviation of each
    coordinate of a corner, in object units.
    """

def accept_lengths(
    lengths: ArrayLike,
    limit: Sequence[float],
    lines: Sequence[str],
    *,
    probability: float = 0.95,
    guard_band: Optional[float] = None,
    diagonal: Optional[float] = None,
    unit: Optional[str] = None,
) -> Dict[str, Any]:
    """Errors of calibrated lengths against the limit A + K L, at most B: what `calibench accept --lengths --json` answers.

    `lengths` is (n, 3): calibrated, its standard uncertainty, measured (NaN: not measured), in one unit; `limit` is (A,), (A, K) or (A, K, B), `lines` the names of
    their measurement lines. Lengths that gave the scale are to be left out.
    """

def accept_points(
    surveyed: ArrayLike,
    measured: ArrayLike,
    *,
    horizontal: Optional[float] = None,
    vertical: Optional[float] = None,
    spatial: Optional[float] = None,
    survey: Optional[Sequence[float]] = None,
    unit: Optional[str] = None,
) -> Dict[str, Any]:
    """Accuracies at check points against classes: what `calibench accept --check-points --json` answers.

    Both are (n, 3), row by row of the same points; NaN in `measured` is a point that was not measured. `survey` is the survey's RMSE, horizontal and vertical.
    """

def task(
    task: str,
    camera: Optional[Camera] = None,
    *,
    calibration: Optional[_Path] = None,
    camera_name: Optional[str] = None,
    halves: Optional[float] = None,
    control: Optional[ArrayLike] = None,
    slices: Optional[Sequence[float]] = None,
) -> Dict[str, Any]:
    """How well a camera will measure something, at 95 %, and what makes that up: what `calibench task --json` answers.

    `task` is the text of the TOML file; `camera` has a covariance, as that of a `Calibration`, or `calibration` is the folder that `calibrate --report` wrote.
    `control` is (n, 3), or (n, 6) with standard deviations: points that every image shows as well, from which the poses come. `halves` is the model error, as on the
    command line; `slices` asks for maps of planes so far from what is measured. What is in doubt is a `DoubtWarning` as well.
    """

def diff(
    first: Camera, second: Camera, *, rotation: bool = True, radius: Optional[float] = None, points: Optional[ArrayLike] = None
) -> Difference:
    """How far two cameras differ over the frame, after the best rotation: as `calibench diff` says."""

def undistort(
    picture: Union[np.ndarray, Sequence[np.ndarray]],
    camera: Camera,
    *,
    to: Union[str, Camera, None] = None,
    frame: str = "keep",
    scale: float = 1.0,
    kernel: str = "cubic",
    redistort: bool = False,
) -> Tuple[Union[np.ndarray, List[np.ndarray]], Optional[Camera], np.ndarray]:
    """Pictures as another camera would have taken them: as `calibench undistort` makes them.

    A picture is (rows, columns) or (rows, columns, channels) of uint8, uint16 or float32; of a list all are made with one map. Returned are the
    picture or pictures, the camera that they are of (None on a sphere), and a mask: True where they show something.
    `to` is "pinhole" (the default), "equirectangular" or a camera, `frame` "keep", "all" or "crop", `kernel` "linear", "cubic", "lanczos3", "lanczos4",
    "area" or "spline", which moves points least.
    """

def undistort_points(
    points: ArrayLike,
    camera: Camera,
    *,
    to: Union[str, Camera, None] = None,
    frame: str = "keep",
    scale: float = 1.0,
    redistort: bool = False,
) -> np.ndarray:
    """Points of pictures, (n, 2), where `undistort` puts them; `redistort` leads back. NaN for what has no place there."""

def judge(
    what: Union[Sequence[_Path], Sequence[Union[ArrayLike, Measured]], Mapping[str, Sequence[Union[ArrayLike, Measured]]]],
    board: _Board,
    *,
    size: Optional[_Size] = None,
    images: Optional[Sequence[str]] = None,
    methods: Optional[Sequence[str]] = None,
    models: Optional[Sequence[str]] = None,
    pitch: Optional[float] = None,
    splits: int = 10,
    seed: int = 0,
    camera: Optional[Camera] = None,
    margin: float = 1.0,
    board_file: Optional[_Path] = None,
) -> Judgement:
    """Say which operator and which camera model to trust, without truth: as `calibench judge` does.

    Photographs of a chessboard by their paths; or points as `calibrate` takes them, of one operator, or of several by name.
    With `camera`: whether it still holds within `margin` px. `board_file` has the board's own corners, which are taken as exact.
    """

def league(
    scenarios: Union[str, Sequence[str]],
    calibrators: Sequence[Union[str, Callable[[Dict[str, Any]], Mapping[str, Any]]]],
    *,
    trials: Optional[int] = None,
    seed: Optional[int] = None,
    threads: Optional[int] = None,
    root: Optional[_Path] = None,
) -> Dict[str, Any]:
    """Ask calibrators about the same trials of scenarios with [calibrators], and compare their cameras with the true ones.

    `calibrators` are names, as `calibench list calibrators` has them, and callables. A callable gets a task and answers what
    a program would (docs/calibrators.md), both as dicts; `status` is "calibrated" unless it says otherwise, arrays are
    lists. What it raises has failed. Its name is `__name__`, its version `__version__`, if it has one.

    A row for each calibrator, scenario and trial, as columns: `calibrator`, `system`, `version`, `scenario`, `trial`, `status`,
    `message`, `silent` (wrong and nothing said), `left_out`, and numbers that are NaN where there are none: `frame` and `covered`
    (distance from the true camera after the best rotation, RMS, px), `length` (error of 100 mm, RMS, mm), `stated` (px),
    `z2` and `z2_parameters` (mean squares of errors in stated standard deviations), `rms` (px), `seconds`.
    """

def run(
    scenario: str,
    *,
    methods: Optional[Sequence[str]] = None,
    trials: Optional[int] = None,
    seed: Optional[int] = None,
    records: Optional[_Path] = None,
    threads: Optional[int] = None,
    root: Optional[_Path] = None,
) -> Records:
    """Run a scenario: as `calibench run` does, into the folder `records`, or into one that goes with the result.

    `methods`, `trials` and `seed` take the place of the scenario's own. Ctrl-C ends it; older records are then as they were.
    """

def run_part(
    scenario: str,
    part: str,
    folder: _Path,
    *,
    methods: Optional[Sequence[str]] = None,
    trials: Optional[int] = None,
    seed: Optional[int] = None,
    again: bool = False,
    threads: Optional[int] = None,
    root: Optional[_Path] = None,
    revision: Optional[str] = None,
) -> Path:
    """Run one part of a run, as 3/8, into a folder of parts: as `calibench run --part` does. One that is there is left as it is."""

def merge(folders: Sequence[_Path], records: _Path) -> List[Records]:
    """Put parts together, byte for byte to what one run would have written: as `calibench merge` does."""

def report(*papers: str, root: Optional[_Path] = None) -> List[Path]:
    """Write the reports of papers, all where none is named, from the project's records alone. Their pages."""

def shipped(scenario: str, *, root: Optional[_Path] = None) -> Tuple[str, str, List[Tuple[Path, Path]], str]:
    """What a part needs on another machine: name, text, files of its camera and its board (from its folder, and where they are), revision."""

def restored(class_: str, version: str, state: Any) -> Any:
    """What `pickle` calls: the object of a class that was pickled as `state`, by the same version of calibench."""

def methods(*, root: Optional[_Path] = None) -> List[Tuple[str, str]]:
    """All methods: names and what they are."""

def scenarios(*, root: Optional[_Path] = None) -> List[str]:
    """The names of the project's scenarios; outside of a project there are none."""

def add_method(
    name: str,
    version: Union[str, Callable[[], str]],
    about: str,
    source: str,
    callable: Callable[..., Any],
    parameters: Sequence[Tuple[str, float, float, float, bool, bool, str]],
    radius: Optional[float],
) -> None:
    """What `calibench.method` calls."""

def confine(scratch: _Path, closed: Optional[_Path], open: Sequence[_Path], memory: int, command: Sequence[str]) -> str:
    """Restrict this process, then become the command; why not, where it cannot."""
