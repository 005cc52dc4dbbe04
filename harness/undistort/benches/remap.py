"""Milliseconds to undistort 12 megapixels on one thread: calibench beside OpenCV's remap with ready maps, one after the other, as a table of Markdown.

    cargo build --release -p calibench-undistort --example time
    python harness/undistort/benches/remap.py target/release/examples/time

Needs opencv-python-headless (5 or 4). Counted is the time of the processor, the best of three: what else runs on the machine does not stand in it.
"""

import subprocess
import sys
import time

import cv2
import numpy as np

SIZE = (4000, 3000)
KERNELS = {"linear": cv2.INTER_LINEAR, "cubic": cv2.INTER_CUBIC, "lanczos4": cv2.INTER_LANCZOS4}
WANTED = {"linear": 1.5, "cubic": 1.5, "lanczos4": 3.0}


def remap(kernel, channels, bits):
    """The best of three, ms."""
    matrix = np.array([[3000, 0, 1990.0], [0, 3000, 1510], [0, 0, 1]])
    maps = cv2.initUndistortRectifyMap(matrix, np.array([-0.2, 0.08, 0.0005, -0.0003, 0]), None, matrix, SIZE, cv2.CV_32FC1)
    shape = SIZE[::-1] if channels == 1 else (*SIZE[::-1], channels)
    picture = np.random.default_rng(1).integers(0, 1 << bits, shape).astype(np.uint8 if bits == 8 else np.uint16)
    made, best = np.empty_like(picture), np.inf
    for _ in range(3):
        begin = time.process_time()
        cv2.remap(picture, *maps, kernel, dst=made)
        best = min(best, time.process_time() - begin)
    return 1e3 * best


def main():
    cv2.setNumThreads(1)
    lines = subprocess.run([sys.argv[1]], check=True, capture_output=True, text=True).stdout.split()
    ours = {tuple(line.split(",")[:3]): float(line.split(",")[3]) for line in lines}
    print(f"| kernel | channels | bits | calibench, ms | OpenCV {cv2.__version__}, ms | times as fast | wanted |\n|---|---|---|---|---|---|---|")
    for kernel, flag in KERNELS.items():
        for channels in (1, 3):
            for bits in (8, 16):
                theirs, mine = remap(flag, channels, bits), ours[kernel, str(channels), str(bits)]
                print(f"| {kernel} | {channels} | {bits} | {mine:.0f} | {theirs:.0f} | {theirs / mine:.1f} | {WANTED[kernel]} |")
    rest = ", ".join(f"{kernel} {ours[kernel, '1', '8']:.0f} and {ours[kernel, '3', '8']:.0f} ms" for kernel in ("lanczos3", "area", "spline"))
    print(f"\nWithout a counterpart (8 bits, grey and colour): {rest}. The map: {ours['map', '', '']:.0f} ms.")


if __name__ == "__main__":
    main()
