"""Two workers of Dask beside two processes started by hand: minutes of the same trials, and how much of their speed the workers reach.

    just perf-cluster [MINUTES]

By hand: `calibench run --part 1/2` and `2/2`, each on one thread, then `calibench merge`. On Dask: `calibench.cluster.run` on two workers of one thread,
which are there already. Both take turns, ROUNDS times; medians are compared. Exit code 1 where the records are not the same bytes, or below 90 %.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = Path(os.environ.get("CALIBENCH_PROGRAM", ROOT / "target/release/calibench"))
SCENARIO = "galo-2011/network"
#: Those of the scenario that the package has, too: a trial takes a tenth of a second and more, as where many machines are asked for.
METHODS = ["pixel", "forstner:window=9", "forstner:window=15", "harris_paraboloid:window=11", "lsm", "parametric_junction:arms=2"]
WORKERS, PARTS, ROUNDS = 2, 16, 3
#: What is asked for: of the speed of processes started by hand.
WANTED = 0.9


def program(*words):
    return subprocess.Popen([PROGRAM, "--root", ROOT, "-q", *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def part(k, trials, parts):
    methods = [word for method in METHODS for word in ("-m", method)]
    return program("run", SCENARIO, *methods, "--trials", trials, "--part", f"{k}/{WORKERS}", "-o", parts, "--threads", 1)


def ended(*processes):
    for process in processes:
        said = process.communicate()[1]
        if process.returncode != 0:
            sys.exit(said)


def by_hand(trials, folder):
    """Seconds from the start of the processes to the merged records."""
    started = time.perf_counter()
    parts = folder / "parts"
    ended(*[part(k, trials, parts) for k in range(1, WORKERS + 1)])
    ended(program("merge", parts, "-o", folder / "records"))
    return time.perf_counter() - started


def on_dask(trials, folder, client):
    """Seconds from the call to the merged records."""
    from calibench import cluster

    started = time.perf_counter()
    cluster.run(SCENARIO, client, parts=PARTS, methods=METHODS, trials=trials, records=folder / "records", root=ROOT)
    return time.perf_counter() - started


def trials_in(seconds):
    """How many trials two processes do in that time, about: as fast as in their first seconds."""
    few = 10
    with tempfile.TemporaryDirectory() as folder:
        started = time.perf_counter()
        ended(part(1, few * WORKERS, Path(folder)))
        return max(PARTS, round(WORKERS * few * seconds / (time.perf_counter() - started)))


def files(folder):
    """All files but hidden ones, by their paths."""
    paths = (path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    return {path: (folder / path).read_bytes() for path in paths if not any(part.startswith(".") for part in path.parts)}


def measured(seconds, rounds):
    """Seconds by hand and on Dask, in turns, for the same trials; how many these are; the records that were not the same bytes."""
    from distributed import Client, LocalCluster

    trials, times, other = trials_in(seconds), [], set()
    with LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=None, processes=True) as workers, Client(workers) as client:
        for _ in range(rounds):
            with tempfile.TemporaryDirectory() as hand, tempfile.TemporaryDirectory() as dask:
                times.append((by_hand(trials, Path(hand)), on_dask(trials, Path(dask), client)))
                ours, theirs = (files(Path(folder) / "records") for folder in (dask, hand))
                assert ours, "there are no records"
                other |= {str(path) for path in ours.keys() | theirs.keys() if ours.get(path) != theirs.get(path)}
    return trials, times, sorted(other)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("minutes", nargs="?", type=float, default=5.0, help="how long two processes take for the trials [default: 5]")
    options.add_argument("--rounds", type=int, default=ROUNDS)
    asked = options.parse_args()
    warnings.simplefilter("ignore")
    trials, times, other = measured(60 * asked.minutes, asked.rounds)
    print(f"{SCENARIO}, {trials} trials, {WORKERS} workers, {PARTS} parts")
    print("\n| | by hand, s | on Dask, s | of its speed |\n|---|--:|--:|--:|")
    for turn, (hand, dask) in enumerate(times, 1):
        print(f"| round {turn} | {hand:.1f} | {dask:.1f} | {100 * hand / dask:.1f} % |")
    reached = statistics.median(hand / dask for hand, dask in times)
    same = f"DIFFER: {', '.join(other)}" if other else "of the same bytes"
    print(f"\n{100 * reached:.1f} % of the speed of processes started by hand (wanted: {100 * WANTED:.0f} %); records {same}")
    if other:
        print("Records carry the revision of the code: files of the checkout that were changed meanwhile make them differ.")
    sys.exit(0 if not other and reached >= WANTED else 1)


if __name__ == "__main__":
    main()
