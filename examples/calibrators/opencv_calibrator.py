"""OpenCV: calibrateCamera, calibrateCameraRO, fisheye.calibrate, omnidir.calibrate (contrib)."""
import argparse

import asked
import cv2
import numpy as np

options = argparse.ArgumentParser()
options.add_argument("--call", default="calibrateCamera", choices=["calibrateCamera", "calibrateCameraRO", "fisheye", "omnidir"])
options.add_argument("--iterations", type=int, help="with 1e-12 as the change to stop at; else the call's own criteria")
options.add_argument("--start", action="store_true", help="from the start camera; else it finds one of its own")
options.add_argument("--defaults", action="store_true", help="of fisheye: no flags at all; else extrinsics recomputed and no skew, as its sample has it")
options = options.parse_args()

FLAGS = {
    "opencv4": cv2.CALIB_FIX_K3,
    "opencv5": 0,
    "opencv8": cv2.CALIB_RATIONAL_MODEL,
    "opencv12": cv2.CALIB_RATIONAL_MODEL + cv2.CALIB_THIN_PRISM_MODEL,
    "opencv14": cv2.CALIB_RATIONAL_MODEL + cv2.CALIB_THIN_PRISM_MODEL + cv2.CALIB_TILTED_MODEL,
}
LENS = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4", "tx", "ty"]
CRITERIA = cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS


def poses(names, rvecs, tvecs):
    return {name: [*cv2.Rodrigues(np.float64(r))[0].ravel(), *np.ravel(t)] for name, r, t in zip(names, rvecs, tvecs)}


def guess(task):
    start = task["start"]
    return None if not options.start else np.array([[start["f"], 0, start["cx"]], [0, start["f"], start["cy"]], [0, 0, 1]])


def pinhole(task):
    names, places, objects, images = asked.views(task)
    objects, images = [np.float32(of) for of in objects], [np.float32(of) for of in images]
    size, flags, answer = tuple(task["size"]), FLAGS[task["model"]], {}
    matrix = guess(task)
    flags += cv2.CALIB_USE_INTRINSIC_GUESS if matrix is not None else 0
    criteria = {"criteria": (CRITERIA, options.iterations, 1e-12)} if options.iterations else {}
    if options.call == "calibrateCamera":
        rms, matrix, lens, rvecs, tvecs, sigmas, *_ = cv2.calibrateCameraExtended(objects, images, size, matrix, None, flags=flags, **criteria)
    else:
        # It takes views that show the whole board, in one order; held are the first point, the last of its row, and the height of the last.
        whole = [i for i, of in enumerate(places) if len(of) == len(task["points"])]
        if not whole:
            raise ValueError("no view shows all points, and calibrateCameraRO takes no other")
        if len(whole) < len(places):
            answer["messages"] = [f"{len(places) - len(whole)} views that do not show all points are left out"]
        order = [np.argsort(places[i]) for i in whole]
        names, objects, images = [names[i] for i in whole], [objects[i][o] for i, o in zip(whole, order)], [images[i][o] for i, o in zip(whole, order)]
        board = objects[0]
        row = np.flatnonzero(np.isclose(board[:, 1], board[0, 1]))
        fixed = int(row[np.argmax(np.abs(board[row, 0] - board[0, 0]))])
        rms, matrix, lens, rvecs, tvecs, shape, sigmas, *_ = cv2.calibrateCameraROExtended(
            objects, images, size, fixed, matrix, None, flags=flags, **criteria
        )
        answer["board_shape"] = shape.reshape(-1, 3)
    count = int(task["model"][6:])
    sigmas = dict(zip(["fx", "fy", "cx", "cy", *LENS[:count]], sigmas.ravel()))
    camera = asked.opencv_yaml(size, matrix, lens.ravel()[:count])
    return {**answer, "camera": camera, "sigmas": sigmas, "scaled": "sigma0", "rms_px": rms, "poses": poses(names, rvecs, tvecs)}


def fisheye_flag(name):
    """5.0 has them in cv2 alone."""
    return getattr(cv2.fisheye if hasattr(cv2.fisheye, name) else cv2, name)


def fisheye(task):
    names, _, objects, images = asked.views(task)
    # Rows, not the columns that findChessboardCorners returns: 5.0.0 takes no other.
    objects, images = [np.float64(of)[None] for of in objects], [np.float64(of)[None] for of in images]
    matrix = guess(task)
    flags = 0 if options.defaults else fisheye_flag("CALIB_RECOMPUTE_EXTRINSIC") + fisheye_flag("CALIB_FIX_SKEW")
    flags += fisheye_flag("CALIB_USE_INTRINSIC_GUESS") if matrix is not None else 0
    criteria = {"criteria": (CRITERIA, options.iterations, 1e-12)} if options.iterations else {}
    rms, matrix, lens, rvecs, tvecs = cv2.fisheye.calibrate(objects, images, tuple(task["size"]), matrix, np.zeros(4), flags=flags, **criteria)
    camera = asked.opencv_yaml(task["size"], matrix, lens.ravel(), fisheye=True)
    return {"camera": camera, "rms_px": rms, "poses": poses(names, rvecs, tvecs)}


def omnidir(task):
    names, _, objects, images = asked.views(task)
    objects, images = [np.float64(of)[:, None] for of in objects], [np.float64(of)[:, None] for of in images]
    # It has no criteria of its own: those of its tutorial.
    criteria = (CRITERIA, options.iterations or 200, 1e-12 if options.iterations else 1e-4)
    rms, matrix, xi, lens, rvecs, tvecs, used = cv2.omnidir.calibrate(
        objects, images, tuple(task["size"]), None, None, None, cv2.omnidir.CALIB_FIX_SKEW, criteria
    )
    used = used.ravel()
    left_out = [names[i] for i in range(len(names)) if i not in used]
    messages = [f"left out: {', '.join(left_out)}"] if left_out else []
    camera = asked.opencv_yaml(task["size"], matrix, lens.ravel(), xi=float(np.ravel(xi)[0]))
    return {"camera": camera, "rms_px": rms, "poses": poses([names[i] for i in used], rvecs, tvecs), "messages": messages}


def calibrate(task):
    cv2.setNumThreads(task["threads"])
    return {"fisheye": fisheye, "omnidir": omnidir}.get(options.call, pinhole)(task)


asked.serve(cv2.__version__, calibrate)
