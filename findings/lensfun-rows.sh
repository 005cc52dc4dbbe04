#!/usr/bin/env bash
# lensfun takes the pixels of a row four at a time where the processor has SSE: reciprocals are approximate, and a pixel gets factors of the one beside it. Asked for one
# pixel alone it computes the formula in single precision. Applications ask for rows; poly5 has no such way, and differs by how a row's positions are summed up.
# Seen: lensfunpy 1.18.0, lensfun 0.3.4 (Linux, x86-64, CPython 3.11). 1200 x 900 px, crop factor 1.5, rows beside single pixels:
#   ptlens a .01, b -.03, c .008: up to .055 px; poly3 k1 -.03: up to .26 px; poly5: up to .006 px
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/tools"
"$folder/tools/bin/pip" install --quiet --no-compile --disable-pip-version-check lensfunpy==1.18.0 numpy==2.2.6
cat > "$folder/asked.py" <<'PYTHON'
import platform

import lensfunpy
import numpy as np

WIDTH, HEIGHT = 1200, 900
BASE = """<lensdatabase version="1"><mount><name>Generic</name></mount><lens><maker>Maker</maker><model>Lens</model><mount>Generic</mount>
<cropfactor>1.5</cropfactor><aspect-ratio>3:2</aspect-ratio><type>rectilinear</type><calibration><distortion focal="18" {}/></calibration></lens></lensdatabase>"""


def apart(distortion):
    """The largest distance of a row's pixels from the same asked alone, and of these from the formula's own digits, px."""
    database = lensfunpy.Database(xml=BASE.format(distortion), load_common=False, load_bundled=False)
    modifier = lensfunpy.Modifier(database.lenses[0], 1.5, WIDTH, HEIGHT)
    modifier.initialize(18.0, 8.0, 1000.0, 1.0, pixel_format=np.uint8, flags=lensfunpy.ModifyFlags.DISTORTION)
    whole = modifier.apply_geometry_distortion()
    places = [(x, y) for y in range(0, HEIGHT, 53) for x in range(0, WIDTH, 5)]
    alone = np.array([modifier.apply_geometry_distortion(x, y, 1, 1)[0, 0] for x, y in places])
    rows = np.array([whole[y, x] for x, y in places])
    return np.hypot(*(rows - alone).T).max(), alone, np.array(places, float)


def formula(places, factor):
    """lensfun's documented model, its unit half of the shorter side of 3:2."""
    centre, unit = np.array([WIDTH - 1, HEIGHT - 1]) / 2, np.hypot(WIDTH - 1, HEIGHT - 1) / 2 / np.hypot(1.5, 1)
    flat = (places - centre) / unit
    return centre + flat * factor(np.hypot(*flat.T))[:, None] * unit


models = {
    "ptlens": ('model="ptlens" a="0.01" b="-0.03" c="0.008"', lambda r: 0.01 * r**3 - 0.03 * r**2 + 0.008 * r + 1.012),
    "poly3": ('model="poly3" k1="-0.03"', lambda r: 1.03 - 0.03 * r**2),
    "poly5": ('model="poly5" k1="-0.03" k2="0.004"', lambda r: 1 - 0.03 * r**2 + 0.004 * r**4),
}
sse = platform.machine() in ("x86_64", "AMD64")
for name, (distortion, factor) in models.items():
    off, alone, places = apart(distortion)
    own = np.hypot(*(alone - formula(places, factor)).T).max()
    print(f"lensfun {'.'.join(map(str, lensfunpy.lensfun_version[:3]))}, {name}: rows up to {off:.4f} px from single pixels, these {own:.5f} px from the formula")
    assert own < 1e-3, "not as stated"
    assert (0.03 < off < 0.5) if sse and name != "poly5" else off < 0.01, "not as stated"
PYTHON
"$folder/tools/bin/python" "$folder/asked.py"
echo "as stated"
