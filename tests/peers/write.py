"""Writes a camera file with a tool's own package, and projects points by the tool.

    python write.py TOOL FILE < points.json > pixels.json

The camera is of 1200 x 900 px; points and pixels are those of project.py.
"""

import json
import sys

import numpy as np

sys.dont_write_bytecode = True
import project  # noqa: E402

SIZE = [1200, 900]
MATRIX = np.array([[1400.0, 0, 610], [0, 1403, 440], [0, 0, 1]])
FIVE = np.array([-0.08, 0.02, 3e-4, -6e-4, -0.002])
FOUR = np.array([-0.02, 0.003, -0.001, 1e-4])


def mtx(path, points):
    """As OpenCV's tutorial saves what calibrateCamera returns."""
    np.savez(path, mtx=MATRIX, dist=FIVE[None], rvecs=np.zeros((3, 3, 1)), tvecs=np.ones((3, 3, 1)), image_size=SIZE)
    return project.projected(MATRIX, FIVE, False, points)


def halves(path, points):
    """Compressed, of 16 and 32 bits, by columns, in another order of bytes."""
    matrix, distortion = MATRIX.astype(">f4"), FIVE.astype("<f2")
    np.savez_compressed(path, K=np.asfortranarray(matrix), D=distortion[:, None], width=np.int32(SIZE[0]), height=np.uint16(SIZE[1]))
    return project.projected(matrix, distortion, False, points)


def fisheye(path, points):
    np.savez(path, K=MATRIX, D=FOUR[:, None], fisheye=True, img_size=np.array(SIZE))
    return project.projected(MATRIX, FOUR, True, points)


def storage(path, points):
    """OpenCV's FileStorage of halves and whole numbers, under names of one's own."""
    import cv2

    whole, half = np.rint(MATRIX).astype(np.int32), FIVE[None].astype(np.float16)
    out = cv2.FileStorage(path, cv2.FILE_STORAGE_WRITE)
    for name, value in (("M1", whole), ("D1", half)):
        out.write(name, value)
    out.write("image_width", SIZE[0])
    out.write("image_height", SIZE[1])
    out.release()
    return project.projected(whole, half, False, points)


def anipose(path, points):
    from aniposelib.cameras import CameraGroup, FisheyeCamera

    camera = FisheyeCamera(matrix=MATRIX, dist=FOUR, size=SIZE, rvec=np.zeros(3), tvec=np.zeros(3), name="A")
    CameraGroup([camera]).dump(path)
    return camera.project(points).reshape(-1, 2)


def caliscope(path, points):
    from caliscope.cameras.camera_array import CameraArray, CameraData

    camera = CameraData(cam_id=3, size=tuple(SIZE), matrix=MATRIX, distortions=FIVE)
    CameraArray({3: camera}).to_toml(path)
    return project.projected(MATRIX, FIVE, False, points)


TOOLS = {f.__name__: f for f in (mtx, halves, fisheye, storage, anipose, caliscope)}

if __name__ == "__main__":
    json.dump(np.asarray(TOOLS[sys.argv[1]](sys.argv[2], np.array(json.load(sys.stdin), dtype=float)), dtype=float).tolist(), sys.stdout)
