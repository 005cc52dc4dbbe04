"""pycolmap: poses by its RANSAC at the start camera, then its bundle adjustment of poses and the camera, the board's points held; covariance by its estimator."""
import asked
import numpy as np
import pycolmap

MODELS = {
    "opencv4": ("OPENCV", "fx fy cx cy k1 k2 p1 p2"),
    "opencv8": ("FULL_OPENCV", "fx fy cx cy k1 k2 p1 p2 k3 k4 k5 k6"),
    "opencv-fisheye": ("OPENCV_FISHEYE", "fx fy cx cy k1 k2 k3 k4"),
}


def calibrate(task):
    model, names = MODELS[task["model"]]
    names, start = names.split(), task["start"]
    # COLMAP's pixels: the centre of the first is (0.5, 0.5).
    params = [start["f"], start["f"], start["cx"] + 0.5, start["cy"] + 0.5] + [0.0] * (len(names) - 4)
    camera = pycolmap.Camera(camera_id=1, model=model, width=task["size"][0], height=task["size"][1], params=params)
    camera.has_prior_focal_length = True
    board = pycolmap.Reconstruction()
    board.add_camera_with_trivial_rig(camera)
    config = pycolmap.BundleAdjustmentConfig()
    seen = {}
    messages = []
    pycolmap.set_random_seed(0)
    for image_id, (name, places, objects, images) in enumerate(zip(*asked.views(task)), 1):
        xy = np.array(images) + 0.5
        found = pycolmap.estimate_and_refine_absolute_pose(xy, np.array(objects), camera) if len(xy) >= 3 else None
        if found is None:
            messages.append(f"no pose of {name}")
            continue
        image = pycolmap.Image(image_id=image_id, name=name, camera_id=1, points2D=[pycolmap.Point2D(of) for of in xy])
        board.add_image_with_trivial_frame(image, found["cam_from_world"])
        config.add_image(image_id)
        for i, place in enumerate(places):
            seen.setdefault(place, []).append(pycolmap.TrackElement(image_id, i))
    for place, elements in seen.items():
        config.add_constant_point(board.add_point3D(task["points"][place][1:4], pycolmap.Track(elements)))

    options = pycolmap.BundleAdjustmentOptions(refine_principal_point=True, print_summary=False)
    options.ceres.solver_options.num_threads = task["threads"]
    adjuster = pycolmap.create_default_ceres_bundle_adjuster(options, config, board)
    summary = adjuster.solve()
    if not summary.is_solution_usable():
        return {"status": "failed", "messages": [*messages, asked.short(summary.brief_report())]}
    camera = board.cameras[1]
    answer = {
        "camera": f"# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n1 {model} {camera.width} {camera.height} {' '.join(map(repr, camera.params.tolist()))}\n",
        "rms_px": board.compute_mean_reprojection_error() if board.update_point_3d_errors() is None else None,
        "poses": {image.name: [*pose(image).rotation.matrix().ravel(), *pose(image).translation] for image in board.images.values()},
        "scaled": "unit",
    }
    covariances = pycolmap.estimate_ba_covariance(pycolmap.BACovarianceOptions(), board, adjuster)
    covariance = None if covariances is None else covariances.get_other_params_cov(camera.params)
    if covariance is None:
        messages.append("no covariance")
    else:
        answer["covariance"] = {"names": names, "matrix": covariance}
    if "NO_CONVERGENCE" in str(summary.termination_type):
        messages.append(asked.short(summary.brief_report()))
    return {**answer, "messages": messages}


def pose(image):
    return image.cam_from_world() if callable(image.cam_from_world) else image.cam_from_world


asked.serve(pycolmap.__version__, calibrate)
