#!/usr/bin/env python3
"""OpenCV's `calibrateCamera` on the files that the benchmark `files` wrote, as a Python user would call it: from `points.csv` and `control.csv` in FOLDER.

    peer.py FOLDER WIDTH HEIGHT

Output: OpenCV's version, RMS (2D, px), fx, fy, cx, cy, k1, k2, p1, p2, k3. Exit code 3: no OpenCV on this machine.
"""

import csv
import sys


def main(folder, width, height):
    try:
        import cv2
        import numpy as np
    except ImportError:
        return 3
    with open(f"{folder}/control.csv", newline="") as file:
        known = {row[0]: [float(value) for value in row[1:4]] for row in list(csv.reader(file))[1:]}
    views = {}
    with open(f"{folder}/points.csv", newline="") as file:
        rows = csv.reader(file)
        next(rows)
        for image, target, x, y in rows:
            objects, points = views.setdefault(image, ([], []))
            objects.append(known[target])
            points.append((float(x), float(y)))
    objects = [np.array(view[0], np.float32) for view in views.values()]
    points = [np.array(view[1], np.float32) for view in views.values()]
    rms, matrix, distortion = cv2.calibrateCamera(objects, points, (width, height), None, None)[:3]
    print(cv2.__version__, rms, matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2], *distortion.ravel())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))
