"""Which way of measuring and calibrating should I trust with my camera, and how far?

Image coordinates are px, x along the row, y down; the centre of the first pixel is (0, 0). Rays and points in a camera's
axes are x right, y down, z forward, as in OpenCV. NaN marks what was missed; the reason stands beside it. What is doubtful
is a `DoubtWarning`; what cannot be is a `calibench.Error`.
"""

from . import _cv2 as _cv2
from ._calibench import (
    Calibration,
    CalibrationError,
    Camera,
    CameraError,
    Difference,
    DoubtWarning,
    Error,
    InputError,
    Judgement,
    LossWarning,
    Measured,
    Pose,
    Records,
    ScenarioError,
    Shot,
    Targets,
    UnavailableError,
    __version__,
    board,
    calibrate,
    detect,
    diff,
    judge,
    measure,
    merge,
    methods,
    render,
    report,
    run,
    run_part,
    scenarios,
)
from ._method import method


__all__ = [
    "Calibration",
    "CalibrationError",
    "Camera",
    "CameraError",
    "Difference",
    "DoubtWarning",
    "Error",
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
    "board",
    "calibrate",
    "detect",
    "diff",
    "judge",
    "measure",
    "merge",
    "method",
    "methods",
    "render",
    "report",
    "run",
    "run_part",
    "scenarios",
]
