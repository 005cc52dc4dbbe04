"""multical: its workspace from detections on, as `multical calibrate` runs it: calibrateCamera, poses, then its bundle adjustment with outliers left out.
The grid is told as the corners of a ChArUco board, which it knows."""
import argparse
import importlib.metadata
import tempfile

import asked
import multical.camera
import numpy as np
from multical import tables
from multical.board import CharucoBoard
from multical.config.arguments import CameraOpts, OptimizerOpts, RuntimeOpts
from multical.config.workspace import optimize
from multical.optimization.calibration import error_stats
from multical.workspace import Workspace
from structs.struct import struct



class OneThread:
    """In place of multiprocessing's ThreadPool: every system has one thread, and its semaphores would be files outside of the folder that a program may write to."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def starmap(self, function, arguments):
        return [function(*of) for of in arguments]


multical.camera.ThreadPool = OneThread
options = argparse.ArgumentParser()
options.add_argument("--every-view", action="store_true", help="in place of its choice of 50 at most, which takes no set of views with equally many points")
options = options.parse_args()


def calibrate(task):
    spacing, columns, rows, cells = asked.grid(task["points"])
    board = CharucoBoard((columns + 1, rows + 1), spacing, 0.75 * spacing, aruco_dict="5X5_1000", min_points=10)
    names, places, _, images = asked.views(task)
    ids = [np.array([cells[place][0] * columns + cells[place][1] for place in of]) for of in places]
    camera, runtime = CameraOpts(), RuntimeOpts()
    if options.every_view:
        camera.limit_intrinsic = None
    np.random.seed(runtime.seed)
    with tempfile.TemporaryDirectory() as folder:
        workspace = Workspace(folder)
        workspace.names = struct(camera=["camera"], image=names, board=["board"])
        workspace.image_size, workspace.boards = [tuple(task["size"])], [board]
        workspace.detected_points = [[[struct(corners=np.array(xy), ids=of)] for of, xy in zip(ids, images)]]
        workspace.point_table = tables.make_point_table(workspace.detected_points, [board])
        workspace.calibrate_single(camera.distortion_model, camera.intrinsic_error_limit, max_images=camera.limit_intrinsic)
        workspace.initialise_poses(exclude_bad_poses=runtime.exclude_bad_poses, pose_error_limit=runtime.pose_error_limit)
        optimize(workspace, OptimizerOpts())
    found = workspace.latest_calibration
    (fx, _, cx), (_, fy, cy), _ = found.cameras[0].intrinsic
    used = found.inliers[0, :, 0]
    return {
        "camera": asked.opencv_yaml(task["size"], [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], np.ravel(found.cameras[0].dist)),
        "rms_px": error_stats(found.reprojection_inliers).rms,
        "outliers": [[view, i] for view, of in enumerate(ids) for i, place in enumerate(of) if not used[view, place]],
    }


asked.serve(importlib.metadata.version("multical"), calibrate)
