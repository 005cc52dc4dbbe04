"""What weighs most in the wheel: by section, by crate and by function, as it lies in the wheel (compressed) and as it is loaded.

    just size-python

`nm` and `readelf` are Debian's binutils. The library that is looked at is the build's, which still has its symbols; the wheel has the
same without them. A function counts for the crate that it is written in, whatever it is made for.
"""

import re
import subprocess
import sys
import zipfile
import zlib
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
LIBRARY = ROOT / "target/release/lib_calibench.so"
#: So many crates and functions are listed.
CRATES, FUNCTIONS = 25, 15
#: What `<A as B>::c` and its like begin with, before the name of the first crate.
PATH = re.compile(r"^[<&*(\[ ]*(?:(?:dyn|mut|const|impl|unsafe|extern \"\w+\") )*[<&*(\[ ]*([A-Za-z_]\w*)::")
#: What was compiled for several instruction sets is one function in the list.
VERSIONS = re.compile(r"::(\w+)::\1_(default|avx|sse)\w*$")


def told(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def packed(data):
    """Bytes of it in a wheel."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    return len(packer.compress(data)) + len(packer.flush())


def sections(library):
    """Name, address, place and size of each section that is loaded from the file."""
    for line in told("readelf", "-SW", library).splitlines():
        found = re.match(r"\s*\[\s*\d+\] (\.\S+)\s+(\S+)\s+(\w{16}) (\w+) (\w+) \w\w\s+(\w*A\w*)", line)
        if found and found[2] != "NOBITS":
            yield found[1], int(found[3], 16), int(found[4], 16), int(found[5], 16)


def symbols(library):
    """Address, size and name of each function and constant; of several names at one place the first."""
    seen = set()
    for line in told("nm", "--defined-only", "-S", "--demangle", library).splitlines():
        found = re.match(r"(\w{16}) (\w{16}) [tTrRdDwWvV] (.*)", line)
        if found and found[1] not in seen:
            seen.add(found[1])
            yield int(found[1], 16), int(found[2], 16), found[3]


def crate(name):
    found = PATH.match(name)
    return found[1] if found else "C, and what has no name"


def function(name):
    return re.sub(r"::h[0-9a-f]{16}$", "", VERSIONS.sub(r"::\1", name.split(".llvm.")[0]))


def table(title, sizes, most):
    print(f"\n| {title} | kB in the wheel | kB loaded |\n|---|--:|--:|")
    rows = sorted(sizes.items(), key=lambda row: (-row[1][0], row[0]))
    for name, (small, whole) in rows[:most]:
        print(f"| `{name}` | {small / 1000:.0f} | {whole / 1000:.0f} |")
    if len(rows) > most:
        rest = [sum(size[place] for _, size in rows[most:]) / 1000 for place in (0, 1)]
        print(f"| {len(rows) - most} others | {rest[0]:.0f} | {rest[1]:.0f} |")


def main():
    if not LIBRARY.is_file():
        sys.exit(f"{LIBRARY}: is not there; run `just build`")
    data = LIBRARY.read_bytes()
    parts = list(sections(LIBRARY))
    by_crate, by_function = defaultdict(bytearray), defaultdict(bytearray)
    for address, size, name in symbols(LIBRARY):
        for _, start, place, length in parts:
            if start <= address < start + length:
                own = data[place + address - start : place + address - start + size]
                by_crate[crate(name)] += own
                by_function[function(name)] += own
    if not by_crate:
        sys.exit(f"{LIBRARY}: has no symbols; run `just size-python`")
    sized = lambda of: {name: (packed(bytes(own)), len(own)) for name, own in of.items()}
    for wheel in sorted((ROOT / "target/wheels").glob("calibench-*.whl")):
        inside = {info.filename: (info.compress_size, info.file_size) for info in zipfile.ZipFile(wheel).infolist()}
        print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.2f} MB")
        table("file", inside, 3)
    table("section", {name: (packed(data[place : place + size]), size) for name, _, place, size in parts}, 8)
    table("crate", sized(by_crate), CRATES)
    table("function or constant", sized(by_function), FUNCTIONS)


if __name__ == "__main__":
    main()
