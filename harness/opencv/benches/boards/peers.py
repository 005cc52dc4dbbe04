#!/usr/bin/env python3
"""mrcal's solution of a board problem that the benchmark `boards` wrote: seconds, RMS and parameters, one line.

    peers.py FOLDER ROUNDS

FOLDER holds `camera.txt` (columns, rows of the image; fx, fy, cx, cy, k1, k2, p1, p2, k3 to start from), `views.csv` (a start pose each: rotation by
rows, translation; x right, y down, z forward) and `corners.csv` (x, y of 6 rows of 9 corners, 25 apart, for each view). Output:
`seconds rms fx fy cx cy k1 k2 p1 p2 k3`; the time is mrcal's optimisation alone, the best of some rounds. Exit code 3: mrcal is not on this machine.
"""

import sys
import time


def main(folder, rounds):
    try:
        import mrcal
        import numpy as np
    except ImportError:
        return 3
    camera = np.loadtxt(f"{folder}/camera.txt", ndmin=1)
    views = np.loadtxt(f"{folder}/views.csv", delimiter=",", ndmin=2)
    corners = np.loadtxt(f"{folder}/corners.csv", delimiter=",", ndmin=2).reshape(len(views), 6, 9, 2)
    observations = np.concatenate([corners, np.ones(corners.shape[:3] + (1,))], axis=-1)
    poses = [np.concatenate([mrcal.r_from_R(view[:9].reshape(3, 3)), view[9:]]) for view in views]
    indices = np.zeros((len(views), 3), dtype=np.int32)
    indices[:, 0], indices[:, 2] = np.arange(len(views)), -1
    best = None
    for _ in range(rounds):
        problem = dict(
            intrinsics=camera[2:].reshape(1, 9).copy(),
            extrinsics_rt_fromref=None,
            frames_rt_toref=np.array(poses),
            points=None,
            observations_board=observations.copy(),
            indices_frame_camintrinsics_camextrinsics=indices,
            observations_point=None,
            indices_point_camintrinsics_camextrinsics=None,
            lensmodel="LENSMODEL_OPENCV5",
            imagersizes=camera[:2].astype(np.int32).reshape(1, 2),
            calibration_object_spacing=25.0,
            do_optimize_calobject_warp=False,
            do_apply_outlier_rejection=False,
            do_apply_regularization=False,
        )
        start = time.perf_counter()
        stats = mrcal.optimize(**problem)
        seconds = time.perf_counter() - start
        best = seconds if best is None else min(best, seconds)
    residuals = stats["x"][: 2 * 54 * len(views)]
    rms = np.sqrt(np.sum(residuals**2) / (54 * len(views)))
    print(best, rms, *problem["intrinsics"][0])
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2])))
