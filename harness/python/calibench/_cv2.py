"""OpenCV's methods, where the package `cv2` is installed: a detector of chessboards and cornerSubPix."""

from __future__ import annotations

import functools
import importlib.util
from typing import Any, Optional

import numpy as np

from ._method import method

#: The longer side of the image that is searched, px: larger ones only add noise that looks like squares, and time.
_SEARCHED = 1280


@functools.lru_cache(maxsize=None)
def installed() -> bool:
    """Whether there is a `cv2`; it is imported when it is first asked for something. Every call asks: it is looked for once."""
    return importlib.util.find_spec("cv2") is not None


def version() -> str:
    """The version of OpenCV."""
    import cv2  # type: ignore[import-not-found,unused-ignore]

    return f"cv2 {cv2.__version__}"


def find_chessboard(image: Any, columns: int, rows: int) -> Optional[Any]:
    """The inner corners of a board in an 8-bit image, along its rows; None where it is not seen whole."""
    import cv2  # type: ignore[import-not-found,unused-ignore]

    reduction = max(1.0, max(image.shape) / _SEARCHED)
    size = (round(image.shape[1] / reduction), round(image.shape[0] / reduction))
    small = image if reduction == 1.0 else cv2.resize(image, size, interpolation=cv2.INTER_AREA)
    if not cv2.checkChessboard(small, (columns, rows)):
        return None
    flags = cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE
    found, corners = cv2.findChessboardCorners(small, (columns, rows), flags=flags)
    if not found:
        return None
    # Outer corners of pixels scale, their centres do not.
    corners = ((corners.reshape(-1, 2) + 0.5) * (np.array(image.shape[::-1]) / np.array(small.shape[::-1])) - 0.5).astype(np.float32)
    grid = corners.reshape(rows, columns, 2)
    sides = [np.linalg.norm(np.diff(grid, axis=axis), axis=2).min() for axis in (0, 1)]
    half = int(np.clip(min(sides) / 3.0, 1.0, 30.0))
    if min(image.shape) < 2 * half + 5:
        return corners.astype(float)
    refined = cv2.cornerSubPix(image, corners[:, None, :].copy(), (half, half), (-1, -1), (3, 40, 1e-3))
    return refined.reshape(-1, 2).astype(float)


def cv2_subpix(image: Any, starts: Any, window: int, iterations: int, epsilon: float) -> Any:
    """cornerSubPix of the installed cv2, as it answers: it does not say when it fails."""
    import cv2  # type: ignore[import-not-found,unused-ignore]

    half = window // 2
    height, width = image.shape
    near = np.rint(starts)
    ring = half + 1
    inside = np.all((near >= ring) & (near < np.array([width, height]) - ring), axis=1)
    found = np.full(starts.shape, np.nan)
    if inside.any() and min(height, width) >= window + 4:
        corners = starts[inside].astype(np.float32).reshape(-1, 1, 2)
        found[inside] = cv2.cornerSubPix(image, corners, (half, half), (-1, -1), (3, iterations, epsilon)).reshape(-1, 2)
    return found


_PARAMETERS = {
    "window": {"default": 11, "min": 3, "max": 31, "odd": True, "about": "side of the window, px"},
    "iterations": {"default": 40, "min": 1, "max": 100, "about": "most steps"},
    "epsilon": {"default": 1e-3, "min": 0.0, "max": 1.0, "about": "step at which iteration ends, px"},
}

if installed():
    method(name="cv2_subpix", version=version, parameters=_PARAMETERS, source="Bradski 2000, OpenCV, cornerSubPix")(cv2_subpix)
