"""Installs the package from the workspace's own build: what `just python` calls. The wheel that is given away is built by `just wheel`."""

import shutil
import sys
import sysconfig
from pathlib import Path

HERE = Path(__file__).resolve().parent
BUILT = {"linux": "lib_calibench.so", "darwin": "lib_calibench.dylib", "win32": "_calibench.dll"}


def main() -> None:
    library = HERE.parents[1] / "target/release" / BUILT.get(sys.platform, BUILT["linux"])
    if not library.is_file():
        sys.exit(f"{library} is not there: run `just build`")
    package = Path(sysconfig.get_path("purelib")) / "calibench"
    if package.exists():
        shutil.rmtree(package)
    shutil.copytree(HERE / "calibench", package, ignore=shutil.ignore_patterns("__pycache__", "_calibench.*so"))
    shutil.copy2(library, package / ("_calibench.pyd" if sys.platform == "win32" else "_calibench.abi3.so"))


if __name__ == "__main__":
    main()
