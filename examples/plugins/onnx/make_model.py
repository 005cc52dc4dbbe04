"""Writes refiner.onnx: Förstner's corner as a network, in place of one that was learned.  python3 make_model.py refiner.onnx"""
import sys

import numpy as np
from onnx import TensorProto, helper, numpy_helper, save

WINDOW = 11
half = WINDOW // 2
y, x = np.mgrid[-half : half + 1, -half : half + 1].astype(np.float32)
# Central differences along x and y; then moments of their products over the window.
gradients = np.zeros((2, 1, 3, 3), np.float32)
gradients[0, 0, 1] = gradients[1, 0, :, 1] = [-1, 0, 1]
constants = {"gradients": gradients, "x": x, "y": y, "axes": np.array([1, 2, 3]), "split": np.array([1, 1])}
nodes = [
    helper.make_node("Conv", ["patch", "gradients"], ["g"]),
    helper.make_node("Split", ["g", "split"], ["gx", "gy"], axis=1),
    *(helper.make_node("Mul", [a, b], [a + b]) for a, b in [("gx", "gx"), ("gx", "gy"), ("gy", "gy")]),
    *(helper.make_node("Mul", [a, b], [a + b]) for a, b in [("gxgx", "x"), ("gxgy", "y"), ("gxgy", "x"), ("gygy", "y")]),
    helper.make_node("Add", ["gxgxx", "gxgyy"], ["px"]),
    helper.make_node("Add", ["gxgyx", "gygyy"], ["py"]),
    *(helper.make_node("ReduceSum", [a, "axes"], [s], keepdims=0) for a, s in [("gxgx", "a"), ("gxgy", "b"), ("gygy", "c"), ("px", "p"), ("py", "q")]),
    *(helper.make_node("Mul", [a, b], [a + b]) for a, b in ["ac", "bb", "cp", "bq", "aq", "bp"]),
    *(helper.make_node("Sub", [a, b], [d]) for a, b, d in [("ac", "bb", "det"), ("cp", "bq", "u"), ("aq", "bp", "v")]),
    *(helper.make_node("Div", [a, "det"], [o]) for a, o in [("u", "dx"), ("v", "dy")]),
    *(helper.make_node("Unsqueeze", [o, "one"], [o + "1"]) for o in ["dx", "dy"]),
    helper.make_node("Concat", ["dx1", "dy1"], ["offset"], axis=1),
]
constants["one"] = np.array([1])
graph = helper.make_graph(
    nodes,
    "forstner",
    [helper.make_tensor_value_info("patch", TensorProto.FLOAT, ["n", 1, WINDOW + 2, WINDOW + 2])],
    [helper.make_tensor_value_info("offset", TensorProto.FLOAT, ["n", 2])],
    [numpy_helper.from_array(value, name) for name, value in constants.items()],
)
save(helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=9), sys.argv[1])
