#!/usr/bin/env bash
# OpenCV draws AprilTags on their heads: the pictures of generateImageMarker (drawMarker) for DICT_APRILTAG_16h5, 25h9 and 36h11 are those of the AprilTag project, which npm's
# apriltag and moms-apriltag draw alike, turned by half a turn. It is one convention in drawing and in finding, so that OpenCV alone agrees with itself; a sheet printed from
# the one and measured with the other has its corners shifted by two places, and poses turned by 180 degrees about the tag's normal.
# CORNER_REFINE_APRILTAG moves the origin as well: to the outer corner of the first pixel, where every other refinement has the centre. Its corners are .5 px right and below.
# Seen: opencv-contrib-python-headless 4.6.0.66, 4.14.0.94 and 5.0.0.93, opencv-contrib-python 5.1.0.95 (Linux, CPython 3.11), all alike; apriltag 2.0.3 of npm.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
(cd "$folder" && npm install --silent --no-audit --no-fund apriltag@2.0.3 >/dev/null)
cat > "$folder/draw.js" <<'JAVASCRIPT'
const { AprilTagFamily } = require('apriltag');
const draw = (name) => {
    const family = new AprilTagFamily(require(`apriltag/families/${name}.json`));
    return [...Array(20).keys()].map((tag) => family.render(tag).map((row) => row.map((cell) => (cell === 'w' ? 255 : 0))));
};
console.log(JSON.stringify(Object.fromEntries(['16h5', '25h9', '36h11'].map((name) => [name, draw(name)]))));
JAVASCRIPT
node "$folder/draw.js" > "$folder/tags.json"
cat > "$folder/head.py" <<'PYTHON'
import json
import sys

import cv2
import numpy as np
from moms_apriltag.generator2 import TagGenerator2

aruco = cv2.aruco
draw = getattr(aruco, "drawMarker", None) or aruco.generateImageMarker
for name, drawn in json.load(open(sys.argv[1])).items():
    codes = aruco.getPredefinedDictionary(getattr(aruco, "DICT_APRILTAG_" + name))
    for tag, picture in enumerate(np.array(drawn, np.uint8)):
        own = draw(codes, tag, len(picture) - 2)
        assert np.array_equal(np.rot90(own, 2), picture[1:-1, 1:-1]), (name, tag)
        assert name == "25h9" or np.array_equal(TagGenerator2("tag" + name).generate(tag), picture[1:-1, 1:-1]), (name, tag)
    print(f"{cv2.__version__}: {tag + 1} tags of {name}: OpenCV's are the AprilTag project's, turned by 180 degrees")

codes = aruco.getPredefinedDictionary(aruco.DICT_APRILTAG_36h11)
image = np.full((240, 240), 220, np.uint8)
image[40:200, 40:200] = np.minimum(cv2.resize(draw(codes, 7, 8), (160, 160), interpolation=cv2.INTER_NEAREST), 220)
corners = np.array([[40, 40], [200, 40], [200, 200], [40, 200]]) - 0.5
for refinement, expected in (("NONE", 0.0), ("SUBPIX", 0.0), ("CONTOUR", 0.0), ("APRILTAG", 0.5)):
    parameters = aruco.DetectorParameters() if hasattr(aruco, "ArucoDetector") else aruco.DetectorParameters_create()
    parameters.cornerRefinementMethod = getattr(aruco, "CORNER_REFINE_" + refinement)
    if hasattr(aruco, "ArucoDetector"):
        found = aruco.ArucoDetector(codes, parameters).detectMarkers(image)[0]
    else:
        found = aruco.detectMarkers(image, codes, parameters=parameters)[0]
    off = (found[0][0] - corners).mean(0)
    print(f"{cv2.__version__}: {refinement}: corners {off[0]:+.2f} {off[1]:+.2f} px from where they are")
    assert np.allclose(off, expected, atol=0.03), f"expected {expected}"
PYTHON
for package in opencv-contrib-python-headless==4.6.0.66 opencv-contrib-python-headless==4.14.0.94 opencv-contrib-python-headless==5.0.0.93 opencv-contrib-python==5.1.0.95; do
    version=${package#*==}
    python3 -m venv "$folder/$version"
    numpy='numpy==2.2.6'
    [ "$version" = 4.6.0.66 ] && numpy='numpy==1.26.4'
    "$folder/$version/bin/pip" install --quiet --no-compile --disable-pip-version-check "$package" "$numpy"
    "$folder/$version/bin/pip" install --quiet --no-compile --disable-pip-version-check --no-deps moms-apriltag==2023.1.15 colorama
    "$folder/$version/bin/python" "$folder/head.py" "$folder/tags.json"
done
echo "as stated"
