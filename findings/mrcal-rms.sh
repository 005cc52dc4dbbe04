#!/usr/bin/env bash
# mrcal's RMS is per coordinate: rms_reproj_error__pixels of optimize is sqrt(sum(dx^2 + dy^2) / (2 points)), what OpenCV would return divided by sqrt(2), of the points that were
# kept; and its noise, observed_pixel_uncertainty, by which projection_uncertainty is scaled, is the standard deviation of the same residuals, dx and dy together, over
# all of them and not over the redundancy.
# Seen: python3-mrcal 2.2-4+b1 of Debian 12, which this script asks for: 20 boards of 10 x 10 points, noise of .3 px in each coordinate.
set -euo pipefail
case $(dpkg-query -W -f='${Version}' python3-mrcal 2>/dev/null) in
2.2-*) ;;
*) echo "wants Debian 12's python3-mrcal 2.2: apt-get install python3-mrcal" >&2; exit 2 ;;
esac
/usr/bin/python3 - <<'PYTHON'
import mrcal
import numpy as np

VIEWS, SIGMA = 20, 0.3
draws = np.random.default_rng(0)
matrix = np.array([[900.0, 900.0, 639.5, 479.5]])
poses = np.array([[*draws.uniform(-0.4, 0.4, 3), draws.uniform(-150, -50), draws.uniform(-120, -60), draws.uniform(350, 600)] for _ in range(VIEWS)])
board = mrcal.ref_calibration_object(10, 10, 25.0)
exact = np.array([mrcal.project(mrcal.transform_point_rt(pose, board), "LENSMODEL_PINHOLE", matrix[0]) for pose in poses])
observed = np.concatenate([exact + draws.normal(0, SIGMA, exact.shape), np.ones(exact.shape[:-1] + (1,))], -1)
inputs = dict(
    intrinsics=matrix.copy(), extrinsics_rt_fromref=np.zeros((0, 6)), frames_rt_toref=poses.copy(), points=None, observations_board=observed,
    indices_frame_camintrinsics_camextrinsics=np.array([[i, 0, -1] for i in range(VIEWS)], np.int32), observations_point=None,
    indices_point_camintrinsics_camextrinsics=None, lensmodel="LENSMODEL_PINHOLE", imagersizes=np.array([[1280, 960]], np.int32),
    do_optimize_intrinsics_core=True, do_optimize_extrinsics=True, do_optimize_frames=True, do_optimize_calobject_warp=False,
    calibration_object_spacing=25.0, do_apply_outlier_rejection=False, do_apply_regularization=False,
)
said = mrcal.optimize(**inputs)
again = [mrcal.project(mrcal.transform_point_rt(pose, board), "LENSMODEL_PINHOLE", inputs["intrinsics"][0]) for pose in inputs["frames_rt_toref"]]
off = observed[..., :2] - np.array(again)
rms, point, coordinate = said["rms_reproj_error__pixels"], np.sqrt((off**2).sum(-1).mean()), np.sqrt((off**2).mean())
print(f"mrcal 2.2: RMS {rms:.5f} px; per point {point:.5f}, per coordinate {coordinate:.5f}")
assert np.isclose(rms, coordinate, rtol=1e-5), "not as stated"
model = mrcal.cameramodel(optimization_inputs=inputs, icam_intrinsics=0)
ray = np.array([0.1, 0.1, 1.0])
default, of_one = [mrcal.projection_uncertainty(ray, model=model, what="worstdirection-stdev", observed_pixel_uncertainty=noise) for noise in (None, 1.0)]
redundancy = off.size - 4 - 6 * VIEWS
print(f"mrcal 2.2: noise of uncertainties {default / of_one:.5f} px; by the redundancy {np.sqrt((off**2).sum() / redundancy):.5f}")
assert np.isclose(default / of_one, off.std(), rtol=1e-5) and redundancy < 0.98 * off.size, "not as stated"
PYTHON
echo "as stated"
