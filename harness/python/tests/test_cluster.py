"""Many machines: here some workers of one."""

import os
import signal
import sys
import time
import warnings

import pytest
from conftest import PROGRAM, ROOT
from test_run import SCENARIO, files

import calibench as cb

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def client():
    warnings.simplefilter("ignore")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True) as cluster:
        with distributed.Client(cluster) as client:
            yield client


def test_the_records_are_those_of_one_run(client, tmp_path, project):
    from calibench import cluster

    whole = cb.run(SCENARIO, methods=["forstner", "pixel"], trials=6, records=tmp_path / "whole")
    ours = cluster.run(SCENARIO, client, parts=4, methods=["forstner", "pixel"], trials=6, records=tmp_path / "ours")
    whole, ours = files(whole.folder), files(ours.folder)
    assert all(whole[name] == ours[name] for name in whole if not name.startswith("."))
    assert not any((tmp_path / "ours/.parts").rglob("part.json"))


def test_a_worker_that_is_killed_costs_its_part_alone(client, tmp_path, project):
    from calibench import cluster

    flag = tmp_path / "killed"

    def setup():
        """Kills its own process, three times in all."""
        count = len(list(flag.parent.glob("killed*")))
        if count < 3:
            (flag.parent / f"killed{count}").touch()
            os.kill(os.getpid(), signal.SIGKILL)

    whole = cb.run(SCENARIO, methods=["pixel"], trials=4, records=tmp_path / "whole")
    ours = cluster.run(SCENARIO, client, parts=3, methods=["pixel"], trials=4, records=tmp_path / "ours", setup=setup, retries=10)
    assert len(list(tmp_path.glob("killed*"))) == 3
    whole, ours = files(whole.folder), files(ours.folder)
    assert all(whole[name] == ours[name] for name in whole if not name.startswith("."))


def test_what_was_stopped_goes_on(client, tmp_path, project):
    from calibench import cluster

    # What is cancelled may run on for a while: each run has marks of its own.
    def marking(name, most):
        folder = tmp_path / name
        folder.mkdir()

        def once():
            """Fails after that many parts."""
            (folder / f"{time.monotonic_ns()}-{os.getpid()}").touch()
            if len(list(folder.iterdir())) > most:
                raise RuntimeError("stopped")

        return once

    keys = dict(parts=4, methods=["pixel"], trials=4, records=tmp_path / "ours", retries=0)
    with pytest.raises(RuntimeError, match="stopped"):
        cluster.run(SCENARIO, client, setup=marking("first", 2), **keys)
    kept = len(list((tmp_path / "ours/.parts").rglob("part.json")))
    assert kept >= 1 and not (tmp_path / "ours" / SCENARIO).exists()
    cluster.run(SCENARIO, client, setup=marking("again", 4), **keys)
    assert len(list((tmp_path / "again").iterdir())) == 4 - kept


def test_mistakes_are_named(client, tmp_path, project):
    from calibench import cluster

    with pytest.raises(cb.InputError, match="parts"):
        cluster.run(SCENARIO, client, parts=0, records=tmp_path)
    with pytest.raises(cb.InputError, match="operators/target"):
        cluster.run("operators/target", client, parts=2, records=tmp_path)
    with pytest.raises(cb.InputError, match="did you mean"):
        cluster.run(SCENARIO, client, parts=2, methods=["forster"], records=tmp_path, retries=0)


@pytest.mark.skipif(not PROGRAM.is_file(), reason=f"no program at {PROGRAM}")
def test_the_benchmark_compares_the_same_records():
    """Two seconds of trials say nothing of speed."""
    sys.path.insert(0, str(ROOT / "harness/python/benches"))
    import cluster as bench

    trials, times, other = bench.measured(2, rounds=1)
    assert trials >= bench.PARTS and len(times) == 1 and all(seconds > 0 for seconds in times[0]) and other == []
