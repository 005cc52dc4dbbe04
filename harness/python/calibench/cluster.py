"""Runs on many machines, through Dask.

A part of a run is a function of the scenario's text, the seed and its range of trials, and needs nothing of the others. So any
worker computes any part; one that dies costs its part alone, which is tried again elsewhere; what has come back lies on disk,
and a run that was stopped goes on from there.
"""

from __future__ import annotations

import hashlib
import io
import os
import shutil
import tarfile
import tempfile
import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, List, Optional, Sequence, Tuple, Union

from ._calibench import InputError, Records, merge, run_part, shipped

if TYPE_CHECKING:
    from distributed import Client

#: A scenario as it is sent: its name, its text, the name and the bytes of its camera's file.
_Shipped = Tuple[str, str, Tuple[Tuple[str, bytes], ...]]


def run(
    scenario: str,
    client: "Client",
    *,
    parts: int,
    records: Union[str, "os.PathLike[str]"],
    methods: Sequence[str] = (),
    trials: Optional[int] = None,
    seed: Optional[int] = None,
    retries: int = 3,
    setup: Optional[Callable[[], Any]] = None,
    root: Union[None, str, "os.PathLike[str]"] = None,
) -> Records:
    """Run a scenario on the workers of a Dask client; the records are those of one run, byte for byte.

    The parts lie in `records/.parts` until all are there; a run that was stopped and is asked for again computes what
    is missing. A worker that dies costs the part that it was at, which is tried again `retries` times. `setup` is called on the
    worker before each part: there it imports the module that declares methods of one's own.

    Workers need this version of calibench, and use the threads that Dask gives them.
    """
    from distributed import as_completed

    if parts < 1:
        raise InputError(f"parts: {parts}; expected 1 or more")
    name, text, files, revision = shipped(scenario, root=root)
    sent = (name, text, tuple((str(own), path.read_bytes()) for own, path in files))
    options = {"methods": list(methods), "trials": trials, "seed": seed, "revision": revision}
    # Parts of another run are none of this one's.
    identity = hashlib.sha256(repr((sent, sorted(options.items()), parts)).encode()).hexdigest()[:16]
    kept = Path(records) / ".parts" / name / identity
    missing = [number for number in range(1, parts + 1) if not _is_there(kept, number, parts, name)]
    futures = [
        client.submit(_part, sent, f"{number}/{parts}", options, setup, retries=retries, pure=False, key=f"calibench-{name}-{number}-of-{parts}-{uuid.uuid4()}")
        for number in missing
    ]
    try:
        for future in as_completed(futures):  # type: ignore[no-untyped-call,unused-ignore]
            _keep(future.result(), kept)
            future.release()
    except BaseException:
        client.cancel(futures)  # type: ignore[no-untyped-call,unused-ignore]
        raise
    merged = merge([kept], records)
    shutil.rmtree(kept)
    return merged[0]


def _part(sent: _Shipped, part: str, options: "dict[str, Any]", setup: Optional[Callable[[], Any]]) -> bytes:
    """A part as the bytes of an archive: runs on a worker."""
    if setup is not None:
        setup()
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        scenario = _unpacked(sent, here)
        run_part(scenario, part, here / "parts", threads=_threads(), root=here, **options)
        archive = io.BytesIO()
        with tarfile.open(fileobj=archive, mode="w") as tar:
            tar.add(here / "parts", arcname=".", filter=_plain)
        return archive.getvalue()


def _threads() -> int:
    """The threads of this worker; those of the machine outside of one."""
    from distributed import get_worker

    try:
        return int(get_worker().state.nthreads)
    except ValueError:
        return os.cpu_count() or 1


def _plain(entry: tarfile.TarInfo) -> tarfile.TarInfo:
    """Without the worker's user and times."""
    entry.uid = entry.gid = entry.mtime = 0
    entry.uname = entry.gname = ""
    return entry


def _unpacked(sent: _Shipped, here: Path) -> str:
    """A project that holds the scenario alone; its name there."""
    name, text, files = sent
    if name.startswith("local/"):
        raise InputError(f"{name}: a scenario of a file of one's own; expected one of a project, in its folder scenarios/")
    (here / "reference").mkdir()
    file = here / "scenarios" / f"{name}.toml"
    file.parent.mkdir(parents=True)
    file.write_text(text, encoding="utf-8")
    for own, content in files:
        beside = file.parent / own
        beside.parent.mkdir(parents=True, exist_ok=True)
        beside.write_bytes(content)
    return name


def _is_there(kept: Path, number: int, parts: int, name: str) -> bool:
    return (kept / f"{number}-of-{parts}" / name / "part.json").is_file()


def _keep(archive: bytes, kept: Path) -> None:
    """Puts a part beside the others, whole or not at all."""
    kept.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=kept, prefix=".incoming-") as folder:
        with tarfile.open(fileobj=io.BytesIO(archive)) as tar:
            tar.extractall(folder)  # noqa: S202 - of our own workers
        for part in _folders(Path(folder)):
            target = kept / part.name
            if not target.exists():
                part.rename(target)


def _folders(folder: Path) -> List[Path]:
    return sorted(entry for entry in folder.iterdir() if entry.is_dir())

