"""docs/other-languages.md: its lines print what the page shows, where the languages are installed."""

import re
import shutil
import subprocess
import sys

import pytest
from conftest import PROGRAM, ROOT

sys.path.insert(0, str(ROOT / "docs/book"))
import pages

PAGE = ROOT / "docs/other-languages.md"
PRINTS = re.compile(r"`((Rscript|octave-cli) [^`]+)` prints:\n\n```text\n(.*?)```", re.DOTALL)
SHOWN = PRINTS.findall(PAGE.read_text(encoding="utf-8"))


def missing(program):
    """Why lines for this program cannot be run here; None if they can."""
    if shutil.which(program) is None:
        return f"no {program} on the path"
    if program == "Rscript" and subprocess.run([program, "-e", "library(jsonlite)"], capture_output=True, check=False).returncode:
        return "R has no package jsonlite"
    return None


@pytest.fixture(scope="module")
def shell(tmp_path_factory):
    """A shell after the page's commands, with its files."""
    if not PROGRAM.is_file():
        pytest.skip(f"no program at {PROGRAM}")
    shell = pages.Shell(tmp_path_factory.mktemp("languages") / "page", PROGRAM)
    for step in pages.steps(PAGE.read_text(encoding="utf-8")):
        if isinstance(step, pages.File):
            shell.write(step)
        else:
            answered, code = shell.run(step.words)
            assert code == 0, "\n".join(answered)
    yield shell
    shell.close()


@pytest.mark.parametrize(("words", "program", "shown"), SHOWN, ids=[words for words, *_ in SHOWN])
def test_lines_print_what_the_page_shows(words, program, shown, request):
    why = missing(program)
    if why:
        pytest.skip(f"{words}: {why}")
    answered, code = request.getfixturevalue("shell").run(f"{words} 2> /dev/null")
    assert code == 0 and pages.matches(shown.splitlines(), answered), "\n".join(answered)


def test_every_file_of_the_page_is_run_and_is_short():
    files = [step for step in pages.steps(PAGE.read_text(encoding="utf-8")) if isinstance(step, pages.File)]
    assert {file.name for file in files} == {words.split()[-1] for words, *_ in SHOWN} and len(files) == 4
    for file in files:
        assert all(len(line) <= 96 for line in file.text.splitlines()) and len(file.text.splitlines()) <= 12, file.name
