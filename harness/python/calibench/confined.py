"""How plug-ins are started: this process restricts itself, then becomes the program. Not for users."""

import argparse
import sys

from ._calibench import confine


def main() -> int:
    arguments = argparse.ArgumentParser(prog="python -m calibench.confined")
    arguments.add_argument("--scratch", required=True)
    arguments.add_argument("--closed")
    arguments.add_argument("--open", action="append", default=[])
    arguments.add_argument("--memory", type=int, required=True)
    arguments.add_argument("command", nargs="+")
    given = arguments.parse_args()
    # It returns only where it cannot.
    print(confine(given.scratch, given.closed, given.open, given.memory, given.command), file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
