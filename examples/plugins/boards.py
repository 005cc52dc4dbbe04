"""OpenCV's detectors of boards, whichever version is installed (4.7 or later): asked for a board, it answers with the board's points by name."""

import json
import sys

try:
    import cv2
    import numpy as np
except ImportError as missing:
    input()
    print(json.dumps({"error": f"Python has no {missing.name}"}), flush=True)
    sys.exit()


def dictionary(name):
    return cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, name))


def size(text):
    return tuple(map(int, text.split("x")))


def chessboard(image, words, asked):
    columns_and_rows = size(words[0])
    search = cv2.findChessboardCornersSB if asked.get("sb") else cv2.findChessboardCorners
    found, corners = search(image, columns_and_rows)
    return in_rows(corners, columns_and_rows) if found else []


def circles(image, words, flag):
    columns_and_rows = size(words[0])
    found, centres = cv2.findCirclesGrid(image, columns_and_rows, flags=flag)
    return in_rows(centres, columns_and_rows) if found else []


def in_rows(points, columns_and_rows):
    columns, _ = columns_and_rows
    return [(f"r{i // columns + 1}c{i % columns + 1}", xy) for i, xy in enumerate(points.reshape(-1, 2).tolist())]


def charuco(image, words):
    columns, rows = size(words[0])
    board = cv2.aruco.CharucoBoard((columns, rows), float(words[1]), float(words[2]), dictionary(words[3]))
    board.setLegacyPattern("legacy" in words)
    corners, ids, _, _ = cv2.aruco.CharucoDetector(board).detectBoard(image)
    found = [] if ids is None else zip(ids.ravel().tolist(), corners.reshape(-1, 2).tolist())
    return [(f"r{i // (columns - 1) + 1}c{i % (columns - 1) + 1}", xy) for i, xy in found]


def aprilgrid(image, words, asked):
    parameters = cv2.aruco.DetectorParameters()
    parameters.markerBorderBits = 1 if "border1" in words else 2
    parameters.cornerRefinementMethod = int(asked.get("refinement", 1))
    corners, ids, _ = cv2.aruco.ArucoDetector(dictionary("DICT_APRILTAG_36h11"), parameters).detectMarkers(image)
    found = [] if ids is None else zip(ids.ravel().tolist(), corners)
    # Upper left first and clockwise as ArUco reads a tag; Kalibr's tags stand upside down and are counted the other way round.
    return [(f"t{tag}c{corner}", xy) for tag, four in found for corner, xy in zip((1, 0, 3, 2), four.reshape(4, 2).tolist())]


def gridboard(image, words, asked):
    parameters = cv2.aruco.DetectorParameters()
    parameters.markerBorderBits = 2 if "border2" in words else 1
    parameters.cornerRefinementMethod = int(asked.get("refinement", 1))
    corners, ids, _ = cv2.aruco.ArucoDetector(dictionary(words[3]), parameters).detectMarkers(image)
    found = [] if ids is None else zip(ids.ravel().tolist(), corners)
    return [(f"t{tag}c{corner}", xy) for tag, four in found for corner, xy in enumerate(four.reshape(4, 2).tolist())]


def find(image, board, asked):
    kind, *words = board.split(":")
    if kind == "chessboard":
        return chessboard(image, words, asked)
    if kind == "charuco":
        return charuco(image, words)
    if kind == "aprilgrid":
        return aprilgrid(image, words, asked)
    if kind == "gridboard":
        return gridboard(image, words, asked)
    return circles(image, words, cv2.CALIB_CB_ASYMMETRIC_GRID if kind == "acircles" else cv2.CALIB_CB_SYMMETRIC_GRID)


def main():
    asked = json.loads(sys.stdin.buffer.readline())["parameters"]
    cv2.setNumThreads(1)
    print(json.dumps({"version": cv2.__version__}), flush=True)
    for line in sys.stdin.buffer:
        request = json.loads(line)
        grey = np.frombuffer(sys.stdin.buffer.read(request["bytes"]), np.uint8).reshape(request["height"], request["width"])
        # What the board does not have, a tag of another one for instance, is not answered.
        found = [(name, xy) for name, xy in find(grey, request["board"], asked) if name in set(request["names"])]
        first = dict(reversed(found))
        print(json.dumps({"image": request["image"], "names": list(first), "xy": list(first.values())}), flush=True)


main()
