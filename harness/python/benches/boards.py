"""How many points of each board are found, how well and how fast, beside OpenCV on the same images: a table in Markdown.

`just perf-boards` runs it. Rendered boards on a sheet of A3, truth known: four tilts up to 55 degrees, four turns, near and far.
"""

import tempfile
import time
import warnings
from pathlib import Path

import cv2
import numpy as np

import calibench as cb

ROOT = Path(__file__).resolve().parents[3]
TILTS = "tilts = [[0, 0], [30, 0], [0, -40], [-45, 30]]"
WORDS = {
    "chessboard": "9x6:38",
    "charuco": "charuco:10x7:38:26.6:DICT_4X4_50",
    "aprilgrid": "aprilgrid:6x4:48:0.3",
    "circles": "circles:10x7:38:20",
    "rings": "rings:12:10x7:38:10",
    "puzzle": "puzzle:19x13:20:100,200",
}


def shots(kind, distance, blur):
    """Images and truth of a board of `scenarios/targets`."""
    text = (ROOT / f"scenarios/targets/{kind}.toml").read_text()
    for before, after in [
        ("tilts = [[0, 0], [30, 0], [0, -40], [-25, 25]]", TILTS),
        ("rolls = [0, 90]", "rolls = [0, 80, 190, 260]"),
        ("distances = [640]", f"distances = [{distance}]"),
        ("blur = 0.7", f"blur = {blur}"),
        ("#:schema ../scenario.schema.json\n", ""),
    ]:
        assert before in text, before
        text = text.replace(before, after)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{kind}.toml"
        file.write_text(text)
        return cb.render(str(file), root=ROOT)


def dictionary(name):
    return cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, name))


def charuco(image):
    detector = cv2.aruco.CharucoDetector(cv2.aruco.CharucoBoard((10, 7), 38, 26.6, dictionary("DICT_4X4_50")))
    corners, ids, _, _ = detector.detectBoard(image)
    return {} if ids is None else {f"r{i // 9 + 1}c{i % 9 + 1}": xy for i, xy in zip(ids.ravel(), corners.reshape(-1, 2))}


def aprilgrid(image, refinement=cv2.aruco.CORNER_REFINE_NONE):
    parameters = cv2.aruco.DetectorParameters()
    parameters.markerBorderBits = 2
    parameters.cornerRefinementMethod = refinement
    corners, ids, _ = cv2.aruco.ArucoDetector(dictionary("DICT_APRILTAG_36h11"), parameters).detectMarkers(image)
    found = [] if ids is None else zip(ids.ravel(), corners)
    return {f"t{tag}c{k}": xy for tag, four in found for k, xy in zip((1, 0, 3, 2), four.reshape(4, 2))}


def listed(found, corners, columns, rows):
    names = [f"r{row + 1}c{column + 1}" for row in range(rows) for column in range(columns)]
    return dict(zip(names, corners.reshape(-1, 2))) if found else {}


THEIRS = {
    "chessboard": {
        "findChessboardCorners": lambda image: listed(*cv2.findChessboardCorners(image, (9, 6)), 9, 6),
        "findChessboardCornersSB": lambda image: listed(*cv2.findChessboardCornersSB(image, (9, 6)), 9, 6),
    },
    "charuco": {"CharucoDetector": charuco},
    "aprilgrid": {
        "ArucoDetector": aprilgrid,
        "ArucoDetector, subpix": lambda image: aprilgrid(image, cv2.aruco.CORNER_REFINE_SUBPIX),
        "ArucoDetector, apriltag": lambda image: aprilgrid(image, cv2.aruco.CORNER_REFINE_APRILTAG),
    },
    "circles": {"findCirclesGrid": lambda image: listed(*cv2.findCirclesGrid(image, (10, 7)), 10, 7)},
    "rings": {},
    "puzzle": {},
}


def ours(word):
    def detect(image):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", cb.DoubtWarning)
            found = cb.detect(image, word)
        return {} if found is None else dict(zip(found.target, found.xy))

    return detect


def turned(found, truth):
    """Grids that look the same upside down, and chessboards from any corner: counted as the truth is."""
    names, xy = list(truth), np.array(list(truth.values()))
    nearest = {name: names[int(np.argmin(np.linalg.norm(xy - at, axis=1)))] for name, at in found.items()}
    return {nearest[name]: at for name, at in found.items()} if len(set(nearest.values())) == len(found) else found


def row(kind, name, detect, images):
    """One line of the table."""
    total, found_points, off, seconds = 0, 0, [], []
    for shot, grey in images:
        truth = dict(zip(shot.truth.target, shot.truth.xy))
        start = time.perf_counter()
        found = detect(grey)
        seconds.append(time.perf_counter() - start)
        if kind in ("circles", "chessboard"):
            found = turned(found, truth)
        total += len(truth)
        found_points += len(found)
        off += [xy - truth[point] for point, xy in found.items()]
    off = np.array(off).reshape(-1, 2)
    far = np.linalg.norm(off, axis=1) > 1.0
    middle = np.median(off, axis=0) if len(off) else (np.nan, np.nan)
    scatter = 1.4826 * np.median(np.abs(off - middle)) if len(off) else np.nan
    share = f"{found_points} of {total}"
    print(f"| {kind} | {name} | {share} | {far.sum()} | {middle[0]:+.2f}, {middle[1]:+.2f} | {scatter:.3f} | {1e3 * np.median(seconds):.1f} |")


def main():
    cv2.setNumThreads(1)
    print(f"calibench {cb.__version__}, OpenCV {cv2.__version__}, images of 1280 x 960 px, one thread\n")
    print("| board | detector | points found | beyond 1 px | median dx, dy, px | scatter, px | ms an image |")
    print("|---|---|--:|--:|--:|--:|--:|")
    for kind, word in WORDS.items():
        all_shots = [shot for distance, blur in [(640, 0.7), (1200, 0.7), (640, 2.0)] for shot in shots(kind, distance, blur)]
        images = [(shot, np.clip(np.rint(np.asarray(shot.image) * 255), 0, 255).astype(np.uint8)) for shot in all_shots]
        row(kind, "calibench", ours(word), images)
        for name, detect in THEIRS[kind].items():
            row(kind, name, detect, images)


if __name__ == "__main__":
    main()
