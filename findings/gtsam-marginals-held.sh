#!/usr/bin/env bash
# gtsam 4.3.0's Marginals say that a variable is known exactly, all of it, where one of its components is held by a constraint (noiseModel.Constrained with one sigma of
# zero, as one holds the skew of a camera): the covariance is zeros, and nothing is said. 4.2.2 has it right, so have both the estimate and the covariance of neighbours;
# in 4.3.0 a small sigma in place of the constraint, 1e-9, mends it. Of a calibration with Cal3DS2 and its skew held that way, every sigma of the camera is zero.
# Seen: gtsam 4.2.2 and 4.3.0 (Linux, CPython 3.11). Variance of a mean of four observations of .5 (true .0625), the other component held: 4.2.2 .0625, 4.3.0 .0000.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/held.py" <<'PYTHON'
import sys

import gtsam
import numpy as np
from gtsam import noiseModel


def marginals(held):
    """Of a point of which four observations say the first component, and `held` the second; and of its neighbour."""
    graph, start = gtsam.NonlinearFactorGraph(), gtsam.Values()
    start.insert(1, np.zeros(2))
    start.insert(2, np.zeros(2))
    graph.add(gtsam.PriorFactorVector(1, np.zeros(2), held))
    for observed in (0.0, 0.1, 0.2, 0.3):
        graph.add(gtsam.PriorFactorVector(1, np.array([observed, 0.0]), noiseModel.Isotropic.Sigma(2, 0.5)))
    graph.add(gtsam.BetweenFactorVector(1, 2, np.ones(2), noiseModel.Isotropic.Sigma(2, 0.3)))
    result = gtsam.LevenbergMarquardtOptimizer(graph, start).optimize()
    assert np.allclose(result.atVector(1), [0.15, 0.0]), "not as stated"
    found = gtsam.Marginals(graph, result)
    return found.marginalCovariance(1)[0, 0], found.marginalCovariance(2)[0, 0]


spread = np.array([1e6, 0.0])
for name, held, stated in (
    ("constraint", noiseModel.Constrained.MixedSigmas(1000.0, spread), 0.0 if sys.argv[1] == "4.3.0" else 0.25 / 4),
    ("small sigma", noiseModel.Diagonal.Sigmas(spread + [0.0, 1e-9]), 0.25 / 4),
):
    own, neighbour = marginals(held)
    print(f"gtsam {sys.argv[1]}: {name}: variance {own:.4f} (true .0625), of the neighbour {neighbour:.4f} (true .1525)")
    assert np.isclose(own, stated, atol=1e-9) and np.isclose(neighbour, 0.25 / 4 + 0.09), "not as stated"
PYTHON
for version in "4.2.2 1.26.4" "4.3.0 2.2.6"; do
    read -r gtsam numpy <<< "$version"
    python3 -m venv "$folder/$gtsam"
    "$folder/$gtsam/bin/pip" install --quiet --disable-pip-version-check "gtsam==$gtsam" "numpy==$numpy"
    "$folder/$gtsam/bin/python" "$folder/held.py" "$gtsam"
done
echo "as stated"
