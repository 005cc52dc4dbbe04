"""A calibrator: lines of JSON, asked on standard input and answered on standard output. What stands below `calibrate` is the protocol; put your own system into it."""
import json
import math
import os
import sys

answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)  # what a library prints is no answer

CAMERA = """%YAML:1.0
---
image_width: {size[0]}
image_height: {size[1]}
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: {matrix}
distortion_coefficients: !!opencv-matrix
   rows: {count}
   cols: 1
   dt: d
   data: {distortion}
"""


def calibrate(task):
    """The camera of a task. Until you change it, that of OpenCV's calibrateCamera."""
    views = [image["points"] for image in task["images"] if image["points"]]
    objects = [np.float32([task["points"][place][1:4] for place, _, _ in points]) for points in views]
    images = [np.float32([[x, y] for _, x, y in points]) for points in views]
    rms, matrix, distortion, _, _, sigmas, *_ = cv2.calibrateCameraExtended(objects, images, tuple(task["size"]), None, None)
    camera = CAMERA.format(size=task["size"], matrix=matrix.ravel().tolist(), count=5, distortion=distortion.ravel()[:5].tolist())
    names = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"]
    sigmas = {name: sigma for name, sigma in zip(names, sigmas.ravel().tolist()) if math.isfinite(sigma)}
    return {"status": "calibrated", "camera": camera, "sigmas": sigmas, "scaled": "sigma0", "rms_px": rms}


def say(answer):
    print(json.dumps(answer), file=answers, flush=True)


sys.stdin.readline()
try:
    import cv2
    import numpy as np
except ImportError as error:
    sys.exit(say({"error": f"{error}: OpenCV for Python is what this calibrator calls until you change it"}))
say({"version": cv2.__version__})
for line in sys.stdin:
    task = json.loads(line)
    try:
        answer = calibrate(task)
    except Exception as error:
        answer = {"status": "failed", "messages": [f"{type(error).__name__}: {error}"]}
    say({"task": task["task"], **answer})
