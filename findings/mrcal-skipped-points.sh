#!/usr/bin/env bash
# mrcal 2.2 takes points that are marked to be skipped (weight -1) into the poses that it starts from, with whatever coordinates stand there, though its documentation says
# "Any point where x<0 or y<0 or weight<0 is ignored": estimate_monocular_calobject_poses_Rt_tocam leaves out NaN alone. One corner of 54 that is not seen, at -1, -1 as
# compute_chessboard_corners itself stores it, turns the pose by 17 degrees; nine by 91. With NaN there the pose is exact. 2.3 to 2.5.2 ask for a weight above 0.
# mrcal-calibrate-cameras on 8 sets of 20 boards that reach over the edge of the frame, with "0 0 -" for what is not seen: one ends 750 px off (RMS 10.9 px), two without
# an uncertainty ("factorization computation failed"); with "nan nan -" all are sound.
# Seen: python3-mrcal 2.2-4+b1 of Debian 12, which this script asks for: it stands in no other index.
set -euo pipefail
case $(dpkg-query -W -f='${Version}' python3-mrcal 2>/dev/null) in
2.2-*) ;;
*) echo "wants Debian 12's python3-mrcal 2.2: apt-get install python3-mrcal" >&2; exit 2 ;;
esac
/usr/bin/python3 - <<'PYTHON'
import mrcal
import numpy as np

camera = ("LENSMODEL_PINHOLE", np.array([900.0, 900.0, 639.5, 479.5]))
true = np.vstack([mrcal.R_from_r(np.array([0.3, -0.4, 0.1])), [[-100.0, -60.0, 400.0]]])
pictured = mrcal.project(mrcal.transform_point_Rt(true, mrcal.ref_calibration_object(9, 6, 25.0)), *camera)


def turned(skipped, at):
    """By how many degrees the pose of an exact board is wrong of which the first corners are skipped, with `at` in their place."""
    observed = np.dstack([pictured, np.ones((6, 9))])
    observed.reshape(-1, 3)[:skipped] = [*at, -1.0]
    found = mrcal.estimate_monocular_calobject_poses_Rt_tocam(np.array([[0, 0]], dtype=np.int32), observed[None], 25.0, [camera])[0]
    return np.degrees(np.linalg.norm(mrcal.r_from_R(found[:3] @ true[:3].T)))


for skipped, at, stated in ((0, (0, 0), 0), (1, (-1, -1), 17.4), (9, (-1, -1), 91.3), (1, (0, 0), 17.3), (9, (np.nan, np.nan), 0)):
    seen = turned(skipped, at)
    print(f"mrcal 2.2: {skipped} of 54 corners skipped, {at} in their place: pose turned by {seen:.1f} degrees")
    assert abs(seen - stated) < 0.1, f"expected {stated}"
PYTHON
echo "as stated"
