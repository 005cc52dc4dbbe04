"""What commands answer with --json passes their schemas, in the hands of another validator, and holds no key that they do not describe."""

import json

import pytest
from conftest import ROOT

jsonschema = pytest.importorskip("jsonschema")

COMMANDS = ["calibrate", "camera", "convert", "diff", "judge", "measure"]


def strict(schema):
    """The schema without room for keys that it does not name; each must say what it means."""
    if isinstance(schema, dict):
        if "properties" in schema:
            schema["additionalProperties"] = False
            for name, one in schema["properties"].items():
                assert one.get("description") or "$ref" in one or "anyOf" in one, name
        for one in schema.values():
            strict(one)
    elif isinstance(schema, list):
        for one in schema:
            strict(one)
    return schema


@pytest.fixture
def board(program, tmp_path):
    """Images of a chessboard, rendered; their names, and the files that other commands read."""
    program("--root", ROOT, "render", "testfields/chessboard", "-o", "board", "-q")
    images = sorted(str(path.relative_to(tmp_path)) for path in (tmp_path / "board").glob("*.png"))
    program("detect", *images, "--chessboard", "9x6", "-o", "points.csv", "-q")
    # No corner is near the borders, where the model of the five coefficients folds: that is said, and the camera is written.
    program("calibrate", *images, "--chessboard", "9x6:25", "-o", "camera.yaml", "-q", code=3)
    return images


def test_every_answer_passes_its_schema(program, board, tmp_path):
    (tmp_path / "starts.csv").write_text("image,target,x,y\ngone.png,r1c1,5,5\n" + f"{board[0].split('/')[1]},edge,1,1\n")
    (tmp_path / "rig.txt").write_text("1 PINHOLE 640 480 500 500 320 240\n2 OPENCV_FISHEYE 640 480 300 300 320 240 0.1 0 0 0\n")
    models = ["--model", "opencv4", "--model", "opencv5", "--splits", "2"]
    asked = {
        "calibrate": [[*board, "--chessboard", "9x6:25", "--compare", "fx,fy,cx,cy;fx,fy,cx,cy,k1", "--snoop"], [*board[:3], "--chessboard", "9x6:25"]],
        "camera": [["camera.yaml"], ["rig.txt", "--camera", "2"]],
        "convert": [["camera.yaml", "--to", "colmap"], ["rig.txt", "--all", "--to", "kalibr"], ["camera.yaml", "--to", "photogrammetric", "--naive", "--pitch", "5"]],
        "diff": [["camera.yaml", "camera.yaml"], ["camera.yaml", "board/camera.toml", "--points", "points.csv", "--distance", "2"]],
        "judge": [[*board, "--chessboard", "9x6:25", *models], [*board, "--chessboard", "9x6:25", *models, "--camera", "camera.yaml"]],
        "measure": [[*board, "--points", "points.csv", "-m", "parametric_corner"], [*board, "--points", "starts.csv", "-m", "pixel"]],
    }
    assert sorted(asked) == COMMANDS
    for command, all_words in asked.items():
        schema = strict(json.loads(program("schema", command)))
        jsonschema.Draft202012Validator.check_schema(schema)
        for words in all_words:
            try:
                text = program(command, *words, "--json")
            except AssertionError:
                text = program(command, *words, "--json", code=3)
            answer = json.loads(text)
            jsonschema.validate(answer, schema, cls=jsonschema.Draft202012Validator)
            assert (answer["command"], answer["schema"]) == (command, schema["properties"]["schema"]["const"])
