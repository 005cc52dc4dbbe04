"""How far twins can be trusted: the table of docs/twin.md, remade from folders of photographs that stay where they are.

    python3 harness/twin/benches/sets.py SETS.csv [NAME...] [--halves] > table.md

SETS.csv has name, folder, board and words that say whose photographs they are. Each row is one twin: of the operators that had no part in making it the hold-out in the
twin over that in the photographs. With --halves the twin is made of every second photograph, and its hold-outs are held against those of the others.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAM = Path(__file__).resolve().parents[3] / "target/release/calibench"
PICTURES = {".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff"}
#: A twin is made of as many photographs or more.
FEWEST = 8


def twin(photographs, board):
    """What `twin` answers, its exit code and its seconds; None where there is no twin."""
    with tempfile.TemporaryDirectory() as there:
        start = time.perf_counter()
        words = [PROGRAM, "twin", *photographs, "--board", board, "--json", "--quiet", "-o", Path(there) / "twin"]
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
        seconds = time.perf_counter() - start
        if done.returncode not in (0, 3):
            return None, (done.stderr.strip().splitlines() or ["?"])[-1], seconds
        return json.loads(done.stdout), done.returncode, seconds


def ratios(made, held):
    """Hold-outs of the twin over those of photographs, by operator; the maker of the twin is left out."""
    of = {operator["method"]: operator for operator in held["operators"]}
    found = {}
    for operator in made["operators"]:
        photographs = of.get(operator["method"], {}).get("held_out_px")
        if not operator["is_maker"] and operator["twin_held_out_px"] and photographs:
            found[operator["method"]] = operator["twin_held_out_px"] / photographs
    return found


def line(whose, board, made, held, code, seconds):
    found = ratios(made, held)
    within = sum(0.9 <= ratio <= 1.1 for ratio in found.values())
    worst = max(found, key=lambda method: abs(found[method] - 1))
    by = {operator["method"]: operator["held_out_px"] for operator in held["operators"]}
    choice = min((operator for operator in made["operators"] if operator["method"] in found), key=lambda operator: operator["twin_held_out_px"])["method"]
    regret = by[choice] / min(by[method] for method in found)
    doubts = "no" if code == 0 else f"yes ({len(made['doubts'])})"
    print(f"| {whose} | {board} | {within} of {len(found)} | {min(found.values()):.2f} to {max(found.values()):.2f} | `{worst}` | `{choice}`: {regret:.2f} | {doubts} | {seconds:.0f} |", flush=True)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("sets", type=Path)
    options.add_argument("names", nargs="*")
    options.add_argument("--halves", action="store_true")
    chosen = options.parse_args()
    print("| photographs | board | operators within 10 % | ratios | farthest off | least in the twin: in the photographs times the least | in doubt | s |")
    print("| --- | --- | ---: | --- | --- | --- | --- | ---: |")
    with open(chosen.sets, newline="") as file:
        for row in csv.DictReader(file):
            if chosen.names and row["name"] not in chosen.names:
                continue
            photographs = sorted(path for path in (chosen.sets.parent / row["folder"]).iterdir() if path.suffix.lower() in PICTURES)
            parts = [photographs[::2], photographs[1::2]] if chosen.halves else [photographs]
            if any(len(part) < FEWEST for part in parts):
                print(f"{row['name']}: {len(photographs)} photographs are too few", file=sys.stderr)
                continue
            answers = [twin(part, row["board"]) for part in parts]
            for place, (made, code, seconds) in enumerate(answers):
                held = answers[len(answers) - 1 - place][0]
                if made is None or held is None:
                    print(f"| {row['whose']} | {row['board']} | no twin: {code} | | | | | {seconds:.0f} |", flush=True)
                else:
                    line(row["whose"], row["board"], made, held, code, seconds)


if __name__ == "__main__":
    os.environ.setdefault("RAYON_NUM_THREADS", str(os.cpu_count() or 1))
    main()
