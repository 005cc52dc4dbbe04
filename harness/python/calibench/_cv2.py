"""OpenCV's methods, where the package `cv2` is installed: cornerSubPix."""

from __future__ import annotations

import importlib.util
from typing import Any

import numpy as np

from ._method import method

def installed() -> bool:
    """Whether there is a `cv2`; it is imported when it is first asked for something."""
    return importlib.util.find_spec("cv2") is not None


def version() -> str:
    """The version of OpenCV."""
    import cv2  # type: ignore[import-not-found,unused-ignore]

    return f"cv2 {cv2.__version__}"


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
