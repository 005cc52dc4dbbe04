"""A learned refiner: patches in, offsets out. The model is any ONNX file with an input (n, 1, side, side) and an output (n, 2), px, or more columns."""
import json
import sys

import numpy as np
import onnxruntime

options = onnxruntime.SessionOptions()
options.intra_op_num_threads = 1  # calibench starts one process a thread
model = onnxruntime.InferenceSession(sys.argv[1], options, providers=["CPUExecutionProvider"])
name, half = model.get_inputs()[0].name, model.get_inputs()[0].shape[2] // 2

stream = sys.stdin.buffer
stream.readline()
print(json.dumps({"version": "1"}), flush=True)
while line := stream.readline():
    asked = json.loads(line)
    image = np.frombuffer(stream.read(asked["bytes"]), "<f4").reshape(asked["height"], asked["width"])
    at = np.rint(np.array(asked["starts"]).reshape(-1, 2)).astype(int)
    inside = np.all((at >= half) & (at < np.array(image.shape[::-1]) - half), axis=1)
    patches = [image[y - half : y + half + 1, x - half : x + half + 1] for x, y in at[inside]]
    xy = [None] * len(at)
    if patches:
        offsets = model.run(None, {name: np.stack(patches)[:, None]})[0]
        for place, centre, offset in zip(np.flatnonzero(inside), at[inside], offsets):
            xy[place] = (centre + offset[:2]).tolist() if np.isfinite(offset[:2]).all() else None
    reasons = [None if found else "no corner in the patch" for found in xy]
    print(json.dumps({"image": asked["image"], "xy": xy, "reasons": reasons}), flush=True)
