"""calibsense: instrument (calibrateCamera or fisheye.calibrate, and a covariance of its own), and with --diagnose what its `diagnose` finds critical."""
import argparse
import dataclasses

import asked
import calibsense as cs

options = argparse.ArgumentParser()
options.add_argument("--diagnose", action="store_true", help="with cross-validation, as `calibsense diagnose`")
options = options.parse_args()

NAMES = {"taux": "tx", "tauy": "ty"}


def calibrate(task):
    spacing, columns, rows, cells = asked.grid(task["points"])
    board = cs.Checkerboard(columns=columns, rows=rows, square_size=spacing, units=task["unit"])
    ids = [row * columns + column for row, column in cells]
    views = tuple(cs.ViewObservations(name, [ids[place] for place in of], xy) for name, of, _, xy in zip(*asked.views(task)))
    session = cs.CalibrationSession(cs.ObservationSet(board, tuple(task["size"]), views))
    fisheye = task["model"] == "opencv-fisheye"
    asked_for = cs.RefitOptions(model="fisheye") if fisheye else cs.RefitOptions(model="pinhole", distortion_terms=int(task["model"][6:]))
    fit = cs.instrument(session, asked_for)
    doubts = []
    if options.diagnose:
        try:
            fit = dataclasses.replace(fit, cross_validation=cs.cross_validate(session, asked_for))
        except cs.CalibSenseError as error:
            doubts.append(f"out-of-sample error not measured: {error}")
        doubts += [f"{found.title}: {found.summary}" for found in cs.diagnose(fit, session.observations, fit.cross_validation).critical]
    if not fit.conditioning.identifiable:
        doubts.append("this capture does not determine every parameter")
    if not fit.at_optimum:
        doubts.append("these parameters are not at an optimum")
    camera = fit.camera
    distortion = camera.distortion if fisheye else camera.distortion[: int(task["model"][6:])]
    per_mm = 0.001 / asked.METRES[task["unit"]]
    return {
        "status": "doubtful" if doubts else "calibrated",
        "messages": [asked.short(doubt) for doubt in doubts],
        "camera": asked.opencv_yaml(task["size"], camera.camera_matrix, distortion, fisheye=fisheye),
        "covariance": {"names": [NAMES.get(name, name) for name in fit.covariance.intrinsic_names], "matrix": fit.covariance.intrinsic},
        "scaled": "sigma0",
        "rms_px": fit.rms,
        "poses": {name: [*pose.rotation.ravel(), *(pose.translation * per_mm)] for name, pose in zip(fit.view_ids, fit.poses)},
    }


asked.serve(cs.__version__, calibrate)
