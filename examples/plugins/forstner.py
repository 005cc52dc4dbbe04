"""Förstner's corner: the point nearest to the lines through the window's pixels, each along its edge."""
import json
import sys


def corner(grey, width, height, x, y, half):
    x0, y0 = round(x), round(y)
    if min(x0, y0) < half + 1 or x0 + half + 1 >= width or y0 + half + 1 >= height:
        return None, "the window leaves the image"
    sxx = sxy = syy = sx = sy = 0.0
    for r in range(y0 - half, y0 + half + 1):
        for c in range(x0 - half, x0 + half + 1):
            gx = grey[r * width + c + 1] - grey[r * width + c - 1]
            gy = grey[(r + 1) * width + c] - grey[(r - 1) * width + c]
            sxx, sxy, syy = sxx + gx * gx, sxy + gx * gy, syy + gy * gy
            sx, sy = sx + gx * gx * c + gx * gy * r, sy + gx * gy * c + gy * gy * r
    det = sxx * syy - sxy * sxy
    if det <= 1e-3 * (sxx + syy) ** 2:
        return None, "no corner"
    return [(syy * sx - sxy * sy) / det, (sxx * sy - sxy * sx) / det], None


stream = sys.stdin.buffer
half = json.loads(stream.readline())["parameters"]["window"] // 2
print(json.dumps({"version": "1"}), flush=True)
while line := stream.readline():
    asked = json.loads(line)
    grey = stream.read(asked["bytes"])
    found = [corner(grey, asked["width"], asked["height"], x, y, half) for x, y in asked["starts"]]
    print(json.dumps({"image": asked["image"], "xy": [xy for xy, _ in found], "reasons": [why for _, why in found]}), flush=True)
