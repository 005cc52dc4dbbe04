"""mrcal: mrcal-calibrate-cameras, run in this process, and mrcal's projection uncertainty at infinity."""
import argparse
import importlib.metadata
import math
import pathlib
import re
import runpy
import shutil
import subprocess
import sys
import tempfile

import asked
import mrcal
import numpy as np

options = argparse.ArgumentParser()
options.add_argument("--splined", action="store_true", help="LENSMODEL_SPLINED_STEREOGRAPHIC in place of the model that is asked for")
options.add_argument("--knots", type=int, nargs=2, default=[16, 12])
options = options.parse_args()


def version():
    try:
        return importlib.metadata.version("mrcal")
    except importlib.metadata.PackageNotFoundError:
        said = subprocess.run(["dpkg-query", "-W", "-f=${Version}", "python3-mrcal"], capture_output=True, text=True, check=True)
        return said.stdout.split("-")[0]


def lens(task):
    if not options.splined:
        return "LENSMODEL_OPENCV" + task["model"][6:]
    # Its field of view has to be named: that of a stereographic lens of the start's focal length, and a fifth more.
    fov = min(round(1.2 * 4 * math.degrees(math.atan(task["size"][0] / 4 / task["start"]["f"]))), 300)
    return f"LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx={options.knots[0]}_Ny={options.knots[1]}_fov_x_deg={fov}"


def calibrate(task):
    spacing, columns, rows, cells = asked.grid(task["points"])
    metre = 1 / asked.METRES[task["unit"]]
    names, places, _, images = asked.views(task)
    with tempfile.TemporaryDirectory() as folder:
        corners = pathlib.Path(folder, "corners.vnl")
        with corners.open("w") as file:
            print("# filename x y level", file=file)
            for view, (of, xys) in enumerate(zip(places, images)):
                # 2.2 starts poses from all points that have coordinates, those to be skipped among them: nan.
                seen = {cells[place]: xy for place, xy in zip(of, xys)}
                for cell in np.ndindex(rows, columns):
                    x, y = seen.get(cell, (math.nan, math.nan))
                    print(f"view{view:05}.png {x!r} {y!r} {0 if cell in seen else '-'}", file=file)
        words = [
            f"--corners-cache={corners}", f"--lensmodel={lens(task)}", f"--focal={task['start']['f']}", f"--object-spacing={spacing / metre}",
            f"--object-width-n={columns}", f"--object-height-n={rows}", "--imagersize", *map(str, task["size"]), f"--outdir={folder}", "view*.png",
        ]
        tool = shutil.which("mrcal-calibrate-cameras")
        sys.argv = [tool, *words]
        np.random.seed(0)  # of the small numbers that it starts distortions with
        with asked.printed() as printed:
            try:
                runpy.run_path(tool, run_name="__main__")
            except SystemExit as end:
                if end.code:
                    raise RuntimeError(f"mrcal-calibrate-cameras ends with {end.code}: {printed.getvalue()}") from end
        model = mrcal.cameramodel(f"{folder}/camera-0.cameramodel")

    inputs = model.optimization_inputs()
    observed = inputs["observations_board"]
    used = observed[..., 2] > 0
    # 2.5 has a message under the name that 2.2 has.
    frames = inputs["rt_ref_frame"] if "rt_ref_frame" in inputs else inputs["frames_rt_toref"]
    answer = {
        "rms_px": float(re.findall("## RMS error: (\\S+)", printed.getvalue())[-1]),
        "scaled": "sigma0",
        "outliers": [[view, i] for view, of in enumerate(places) for i, place in enumerate(of) if not used[view][cells[place]]],
        "poses": {name: [*mrcal.R_from_r(rt[:3]).ravel(), *(rt[3:] * metre)] for name, rt in zip(names, frames)},
    }
    grid = np.array(task["grid"], float)
    rays = mrcal.unproject(grid, *model.intrinsics(), normalize=True)
    seen = np.isfinite(rays).all(1)
    try:
        covariance = mrcal.projection_uncertainty(rays[seen], model, atinfinity=True, what="covariance")
        uncertainty = np.full((len(grid), 3), np.nan)
        uncertainty[seen] = np.column_stack([covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]])
        answer["uncertainty"] = [list(of) if np.isfinite(of).all() else None for of in uncertainty]
    except Exception as error:
        answer["messages"] = [asked.short(error)]
    if options.splined:
        answer["rays"] = [list(ray) if valid else None for ray, valid in zip(rays, seen)]
    else:
        name, intrinsics = model.intrinsics()
        answer["camera"] = repr({"lensmodel": name, "intrinsics": intrinsics.tolist(), "extrinsics": [0.0] * 6, "imagersize": task["size"]}) + "\n"
    shape = mrcal.ref_calibration_object(columns, rows, spacing / metre, calobject_warp=inputs["calobject_warp"])
    answer["board_shape"] = [shape[cell] * metre for cell in cells]
    return answer


asked.serve(version(), calibrate)
