"""What the tests share: the program beside the package, and a clean folder."""

import csv
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = Path(os.environ.get("CALIBENCH_PROGRAM", ROOT / "target/release/calibench"))


@pytest.fixture
def program(tmp_path):
    """Runs the command line in a clean folder; gives what it prints, of what it refuses why."""
    if not PROGRAM.is_file():
        pytest.skip(f"no program at {PROGRAM}")

    def run(*words, code=0):
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == code, done.stderr
        return done.stderr if code == 2 else done.stdout

    return run


@pytest.fixture
def project(monkeypatch):
    """The current folder is the project."""
    monkeypatch.chdir(ROOT)
    return ROOT


def rows(path):
    """The rows of a CSV file."""
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def same(a, b):
    """Whether two arrays are the same to the last bit, NaN too."""
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    return a.shape == b.shape and bool(np.all((a == b) | (np.isnan(a) & np.isnan(b))))
