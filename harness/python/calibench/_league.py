"""Callables as calibrators."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, Dict


def answer(calibrate: Callable[[Dict[str, Any]], Mapping[str, Any]], line: bytes) -> str:
    """The line that answers a line, as between calibench and a program."""
    task = json.loads(line)
    said = calibrate(task)
    if not isinstance(said, Mapping):
        raise TypeError(f"expected a dict with 'camera' or 'rays', or with 'status'; found {type(said).__name__}")
    said = {"status": "calibrated", **said, "task": task["task"]}
    for key in ("rays", "uncertainty"):
        if key in said:
            said[key] = [None if row is None or any(value != value for value in row) else [*map(float, row)] for row in said[key]]
    return json.dumps(said, allow_nan=False, default=_plain)


def _plain(value: Any) -> Any:
    """Arrays and numbers of numpy's as JSON has them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no place in an answer")
