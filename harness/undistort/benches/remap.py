"""Milliseconds to undistort 12 megapixels on one thread: calibench beside OpenCV's remap with ready maps, by turns, as a table of Markdown.

    cargo build --release --workspace --example time
    python harness/undistort/benches/remap.py target/release/examples/time [ROUNDS]

Needs opencv-python-headless (5 or 4). Counted is the time of the processor, the least of all turns: what else runs on the machine costs caches alone.
"""

import subprocess
import sys
import time

import cv2
import numpy as np

SIZE = (4000, 3000)
KERNELS = {"linear": cv2.INTER_LINEAR, "cubic": cv2.INTER_CUBIC, "lanczos4": cv2.INTER_LANCZOS4}
WANTED = {"linear": 1.5, "cubic": 1.5, "lanczos4": 3.0}


class Remap:
    """OpenCV's part: maps and pictures are made once."""

    def __init__(self):
        matrix = np.array([[3000, 0, 1990.0], [0, 3000, 1510], [0, 0, 1]])
        self.maps = cv2.initUndistortRectifyMap(matrix, np.array([-0.2, 0.08, 0.0005, -0.0003, 0]), None, matrix, SIZE, cv2.CV_32FC1)
        self.pictures = {}
        for channels in (1, 3):
            for bits in (8, 16):
                shape = SIZE[::-1] if channels == 1 else (*SIZE[::-1], channels)
                picture = np.random.default_rng(1).integers(0, 1 << bits, shape).astype(np.uint8 if bits == 8 else np.uint16)
                self.pictures[channels, bits] = picture, np.empty_like(picture)

    def times(self):
        """Milliseconds by kernel, channels and bits: the least of three."""
        found = {}
        for kernel, flag in KERNELS.items():
            for (channels, bits), (picture, made) in self.pictures.items():
                best = np.inf
                for _ in range(3):
                    begin = time.process_time()
                    cv2.remap(picture, *self.maps, flag, dst=made)
                    best = min(best, time.process_time() - begin)
                found[kernel, str(channels), str(bits)] = 1e3 * best
        return found


def ours(program):
    """The same of calibench, and of what OpenCV has no counterpart for."""
    lines = subprocess.run([program], check=True, capture_output=True, text=True).stdout.split()
    return {tuple(line.split(",")[:3]): float(line.split(",")[3]) for line in lines}


def least(found, more):
    return {key: min(value, found.get(key, value)) for key, value in more.items()}


def main():
    cv2.setNumThreads(1)
    program, rounds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 3
    remap, mine, theirs = Remap(), {}, {}
    for _ in range(rounds):
        mine, theirs = least(mine, ours(program)), least(theirs, remap.times())
    print(f"| kernel | channels | bits | calibench, ms | OpenCV {cv2.__version__}, ms | times as fast | wanted |\n|---|---|---|---|---|---|---|")
    for key, other in theirs.items():
        kernel, channels, bits = key
        print(f"| {kernel} | {channels} | {bits} | {mine[key]:.0f} | {other:.0f} | {other / mine[key]:.1f} | {WANTED[kernel]} |")
    rest = [f"{kernel} {mine[kernel, '1', '8']:.0f} and {mine[kernel, '3', '8']:.0f} ms" for kernel in ("lanczos3", "area", "spline")]
    print(f"\nWithout a counterpart (8 bits, grey and colour): {', '.join(rest)}. The map: {mine['map', '', '']:.0f} ms.")


if __name__ == "__main__":
    main()
