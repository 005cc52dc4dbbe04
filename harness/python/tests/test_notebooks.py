"""The notebooks run, show what they show, and are typed."""

import subprocess
import sys

import pytest
from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "examples/python").glob("*.ipynb"))


def cells(notebook, kind="code"):
    import nbformat

    return [cell for cell in nbformat.read(notebook, as_version=4).cells if cell.cell_type == kind]


def shown(cell):
    return "".join(output.text for output in cell.outputs if output.output_type == "stream" and output.name == "stdout")


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.name)
def test_it_runs_and_shows_what_it_shows(notebook):
    nbclient = pytest.importorskip("nbclient")
    import nbformat

    there = nbformat.read(notebook, as_version=4)
    again = nbformat.read(notebook, as_version=4)
    nbclient.NotebookClient(again, timeout=120, resources={"metadata": {"path": str(notebook.parent)}}).execute()
    for before, now in zip(there.cells, again.cells):
        if before.cell_type == "code":
            assert shown(now) == shown(before), before.source
    assert any(shown(cell) for cell in there.cells if cell.cell_type == "code")


def test_the_code_is_typed(tmp_path):
    pytest.importorskip("mypy")
    files = []
    for notebook in NOTEBOOKS:
        files.append(tmp_path / f"{notebook.stem}.py")
        files[-1].write_text("\n\n".join(cell.source for cell in cells(notebook)))
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", *files], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout


def test_the_stubs_are_those_of_the_package():
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-m", "mypy.stubtest", "calibench"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_the_package_itself_is_typed():
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "-p", "calibench"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_wrong_types_are_found(tmp_path):
    """The stubs can fail."""
    pytest.importorskip("mypy")
    file = tmp_path / "wrong.py"
    file.write_text('import calibench as cb\n\ncb.calibrate([], "9x6:25", size=640)\nx: int = cb.Camera.read("a").model\n')
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", file], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 1 and done.stdout.count("error:") == 2, done.stdout
