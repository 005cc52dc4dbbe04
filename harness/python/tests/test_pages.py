"""docs/: every command on a page answers what the page shows, and what the program tells of itself makes pages."""

import subprocess
import sys

import pytest
from conftest import PROGRAM, ROOT

sys.path.insert(0, str(ROOT / "docs/book"))
import keys
import pages

# Pages whose shell blocks a test of their own runs.
ELSEWHERE = {"ci.md": "test_ci_page.py"}


def named(page):
    return str(page.relative_to(pages.DOCS))


ALL = {named(page): page for page in pages.pages()}
RUN = [name for name, page in ALL.items() if any(isinstance(step, pages.Command) for step in pages.steps(page.read_text(encoding="utf-8")))]
needs_program = pytest.mark.skipif(not PROGRAM.is_file(), reason=f"no program at {PROGRAM}")


@needs_program
@pytest.mark.parametrize("name", RUN)
def test_commands_answer_what_the_page_shows(name, tmp_path):
    left_out = {words for page, words, _ in pages.not_run() if page == name}
    complaints, _ = pages.run(ALL[name], tmp_path, PROGRAM, left_out)
    assert not complaints, "\n\n".join(complaints)


def test_what_is_not_run_is_listed_and_is_little():
    listed = pages.not_run()
    assert len(listed) <= 10 and all(why for *_, why in listed)
    unlisted = [(name, words) for name, words in shell_blocks() + indented() if (name, words) not in {row[:2] for row in listed} and name not in ELSEWHERE]
    assert not unlisted, "commands that no test runs: make them ```console"
    commands = {(name, step.words) for name in RUN for step in pages.steps(ALL[name].read_text(encoding="utf-8")) if isinstance(step, pages.Command)}
    assert {row[:2] for row in listed} <= commands | set(shell_blocks()) | set(indented())
    for name, test in ELSEWHERE.items():
        assert name in (ROOT / "harness/python/tests" / test).read_text(encoding="utf-8")


def shell_blocks():
    """Every block of a shell that is no console: page and first line."""
    found = ((name, block) for name, page in ALL.items() for block in pages.FENCE.finditer(page.read_text(encoding="utf-8")))
    return [(name, block[2].splitlines()[0]) for name, block in found if block[1] in pages.SHELLS]


def indented():
    """Every command of an indented block: page and words."""
    return [(name, words) for name, page in ALL.items() for words in pages.indented(page.read_text(encoding="utf-8"))]


def test_every_page_is_in_the_summary():
    summary = (pages.DOCS / "SUMMARY.md").read_text(encoding="utf-8")
    missing = [name for name in ALL if f"]({name})" not in summary and name != "SUMMARY.md"]
    assert not missing


def test_commands_of_indented_blocks_are_seen():
    text = "    calibench a --b   # c\n\n    calibench-1.png\n    $ just x\n\n```text\n    calibench in a fence\n```\n"
    assert pages.indented(text) == ["calibench a --b", "just x"]


def test_no_page_runs_in_the_project():
    with pytest.raises(ValueError, match="lies in the project"):
        pages.Shell(ROOT / "target/page", PROGRAM)


def test_pages_that_teach_are_short():
    long = {name: count for name, page in ALL.items() if name.startswith("learn/") and (count := len(page.read_text(encoding="utf-8").split())) > 900}
    assert not long, "words of a page: split it"


def test_what_is_shown_is_compared():
    assert pages.matches(["a 1", "..."], ["a 1", "b", "c"]) and pages.matches(["..."], [])
    assert pages.matches(["in ... s"], ["in 0.3 s"]) and pages.matches([], [])
    assert not pages.matches([], ["a"]) and not pages.matches(["a 1"], ["a 2"])
    assert not pages.matches(["a", "c"], ["a", "b", "c"]) and not pages.matches(["a ... c"], ["a", "c"])


@needs_program
def test_faults_on_a_page_are_found(tmp_path):
    page = tmp_path / "page.md"
    sound = "Save it as `a.txt`:\n\n```text\n12\n```\n\n```console\n$ cat a.txt\n12\n$ false\n$ echo $?\n1\n$ cd /; calibench --version\ncalibench ...\n```\n"
    sound = "<!-- first: ours CHANGELOG.md; project corners/noise -->\n\n```console\n$ ls\nCHANGELOG.md\nmethods\nreference\nscenarios\n$ calibench show corners/noise -o b.png | head -1\n# corners/noise\n```\n" + sound
    faults = {"CHANGELOG.md; ": "none.md; ", "project corners": "project corner", "\n12\n$ false": "\n13\n$ false", "$ echo $?\n1\n": "", "\n12\n```\n": "\n14\n```\n", "calibench --version": "calibench --verzion"}
    for number, (right, wrong) in enumerate([("", ""), *faults.items(), ("", "<!-- figure: a.png | words -->\n")]):
        assert right in sound
        page.write_text(sound.replace(right, wrong, 1))
        complaints, _ = pages.run(page, tmp_path / str(number), PROGRAM)
        assert bool(complaints) == (number > 0), (right, wrong, complaints)


@needs_program
def test_the_program_tells_pages_of_its_commands_and_keys():
    help = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
    names = keys.commands(PROGRAM)
    assert len(names) > 25 and all(f"  {name} " in help for name in names)
    page = keys.command_page(PROGRAM, "calibrate")
    assert "--board-shape <SHAPE>" in page and "--root" not in page and "--root" in keys.command_list(PROGRAM)
    listed = keys.key_list(PROGRAM)
    for name, one in keys.tables(PROGRAM):
        assert f"`{name}`" in listed or f"`[{name}]`" in listed
        text = keys.key_page(name, one) or ""
        assert all(f"`{key}`" in text for key in (keys.inner(one) or {"properties": {}})["properties"])
    shown = dict(keys.tables(PROGRAM))
    assert "`full_well`" in keys.key_page("sensor", shown["sensor"]) and 'kind = "random"' in keys.key_page("stations", shown["stations"])
