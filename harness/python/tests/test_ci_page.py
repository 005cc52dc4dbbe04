"""docs/ci.md: what it tells a project to copy works, and fails where accuracy is worse."""

import os
import re
import shutil
import subprocess

import pytest
from conftest import PROGRAM, ROOT

yaml = pytest.importorskip("yaml")

PAGE = (ROOT / "docs/ci.md").read_text(encoding="utf-8")


def blocks(language):
    """The page's blocks of a language, in order."""
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)


@pytest.fixture
def shell(tmp_path):
    """Runs lines as a workflow does, with the program on the path."""
    if not PROGRAM.is_file():
        pytest.skip(f"no program at {PROGRAM}")
    bin = tmp_path / "bin"
    bin.mkdir()
    (bin / "calibench").symlink_to(PROGRAM)

    def run(lines, folder, code=0):
        path = f"{bin}{os.pathsep}{os.environ['PATH']}"
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", lines], cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True)
        assert done.returncode == code, f"{lines}\n{done.stdout}{done.stderr}"
        return done.stdout + done.stderr

    return run


def test_a_project_that_copies_the_page_has_a_gate_that_fails(shell, tmp_path):
    here = tmp_path / "project"
    here.mkdir()
    shell("git init -q", here)
    begin, accept = blocks("bash")
    declared, listed = blocks("toml")
    shell(begin, here)
    gate = here / "gate"
    (gate / "methods/mine.toml").write_text(declared)
    program = gate / "methods/forstner.py"
    shutil.copy(ROOT / "examples/plugins/forstner.py", program)
    with open(gate / "scenarios/first/corners.toml", "a", encoding="utf-8") as scenario:
        scenario.write("\n" + listed)
    shell(accept, gate)
    assert "gate/methods/forstner.py" in shell("git diff --cached --name-only", here)

    workflow = yaml.safe_load(blocks("yaml")[1])["jobs"]["gate"]
    assert workflow["defaults"]["run"]["working-directory"] == "gate"
    steps = [step for step in workflow["steps"] if "run" in step]
    for step in steps:
        shell(step["run"], gate)
    kept = next(step["with"]["path"].split() for step in workflow["steps"] if "upload" in step.get("uses", ""))
    assert len(kept) == 2 and all((here / path).exists() for path in kept)

    text = program.read_text()
    worse = text.replace("- sxy * sy) / det", "- sxy * sy) / det + 0.2")
    assert worse != text
    program.write_text(worse)
    compare = next(step for step in steps if step["name"] == "Compare with the baseline")
    assert "mine" in shell(compare["run"], gate, code=1)


def test_the_workflow_gives_the_action_what_it_asks_for():
    action, workflow = (yaml.safe_load(text) for text in blocks("yaml"))
    step = next(step for step in workflow["jobs"]["gate"]["steps"] if step.get("uses", "").startswith("./"))
    assert set(step["with"]) == {name for name, given in action["inputs"].items() if given["required"]}
    assert f"`{step['uses'][2:]}/action.yml`" in PAGE
    for one in action["runs"]["steps"]:
        assert "uses" in one or one["shell"] == "bash"
        subprocess.run(["bash", "-n", "-c", one.get("run", ":")], check=True)
