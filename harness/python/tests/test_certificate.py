"""The certificate in the hands of another library: every figure that `calibrate` said stands on it, and it is what PDF/A asks for."""

import hashlib
import json
import re
import subprocess

import pytest
from conftest import ROOT

pypdf = pytest.importorskip("pypdf")


@pytest.fixture
def calibrated(program, tmp_path):
    """Rendered photographs of a board, calibrated with a certificate, a report and the answer for programs; the answer."""
    program("--root", ROOT, "render", "testfields/chessboard", "-o", "board", "-q")
    (tmp_path / "photos").mkdir()
    for path in (tmp_path / "board").glob("*.png"):
        path.rename(tmp_path / "photos" / path.name)
    words = ["calibrate", "photos", "--board", "9x6:25", "--model", "photogrammetric", "--pitch", "6", "-o", "camera.toml", "--length", "r1c1,r6c9", "-q"]
    words += ["--certificate", "camera.pdf", "--by", "Our laboratory", "--place", "Our town", "--report", "report", "--json"]
    try:
        return json.loads(program(*words))
    except AssertionError:
        return json.loads(program(*words, code=3))


def two_digits(sigma):
    return f"{sigma:.{max(0, 1 - int(f'{sigma:.1e}'.split('e')[1]))}f}"


def three_digits(value):
    return f"{value:.{max(0, 2 - int(f'{value:.2e}'.split('e')[1]))}f}"


def test_every_figure_that_calibrate_said_is_on_it(calibrated, tmp_path):
    reader = pypdf.PdfReader(tmp_path / "camera.pdf")
    assert len(reader.pages) == 2
    text = "\n".join(page.extract_text() for page in reader.pages)
    camera, counts = calibrated["cameras"][0], calibrated["counts"]
    by_name = {one["parameter"]: one for one in camera["solved"]}
    seen = 0
    for one in camera["camera"]["parameters"]:
        assert one["name"] in text
        if one["name"] in by_name and 1e-6 < one["sigma"]:
            sigma = two_digits(one["sigma"])
            value = f"{one['value']:.{len(sigma.partition('.')[2])}f}"
            assert value in text and sigma in text, (one, text)
            assert two_digits(by_name[one["name"]]["sigma_by_images"]) in text
            seen += 1
    assert seen >= 3
    for number in [counts["image_points"], counts["observations"], counts["unknowns"], counts["redundancy"]]:
        assert str(number) in text
    over = camera["over_frame"]
    for px in [over["formal_px"], over["by_images_px"], calibrated["rms_px"], calibrated["sigma0"] * calibrated["sigma_px"]]:
        assert three_digits(px) in text, px
    # The budget: what leaving images out shows beyond the adjustment makes the sum, and k is Student's.
    assert three_digits(max(over["formal_px"], over["by_images_px"])) + " px" in text
    length = calibrated["lengths"][0]
    assert (two_digits(length["sigma"]) if length["sigma"] > 0 else f"{length['length']:.6f}") in text
    for words in ["chessboard:9x6:25", "Our laboratory", "Our town", "640 \u00d7 480 px", "taken as exact", "not evaluated", "No accredited calibration"]:
        assert words in text, words
    for doubt in calibrated["doubts"]:
        assert doubt.split()[0] in text and "in doubt" in reader.metadata.title
    for path in sorted((tmp_path / "photos").iterdir()):
        assert path.name in text and hashlib.sha256(path.read_bytes()).hexdigest() in text
    assert hashlib.sha256((tmp_path / "camera.toml").read_bytes()).hexdigest() in text


def test_it_holds_what_pdf_a_asks_for(calibrated, tmp_path):
    reader = pypdf.PdfReader(tmp_path / "camera.pdf")
    root = reader.trailer["/Root"]
    xmp = root["/Metadata"].get_data().decode()
    assert "<pdfaid:part>3</pdfaid:part>" in xmp and "<pdfaid:conformance>B</pdfaid:conformance>" in xmp
    assert f">{reader.metadata.title}<" in xmp and f"<pdf:Producer>{reader.metadata.producer}<" in xmp
    intent = root["/OutputIntents"][0]
    assert intent["/S"] == "/GTS_PDFA1" and intent["/DestOutputProfile"]["/N"] == 3
    assert intent["/DestOutputProfile"].get_data()[36:40] == b"acsp"
    assert "/ID" in reader.trailer and "/Encrypt" not in reader.trailer
    assert [one.get_object()["/AFRelationship"] for one in root["/AF"]] == ["/Source"] * 2
    for page in reader.pages:
        assert set(page["/Resources"]) == {"/Font"} and "/Annots" not in page
        used = page.get_contents().get_data()
        for font in page["/Resources"]["/Font"].values():
            below = font["/DescendantFonts"][0].get_object()
            assert below["/FontDescriptor"]["/FontFile2"].get_data()[:4] == b"\0\1\0\0" and "/ToUnicode" in font
            assert below["/CIDToGIDMap"] == "/Identity" and re.match(r"/[A-Z]{6}\+NotoSans", below["/BaseFont"])
        # No letter that the font does not have, no colour but grey and red, green, blue; no transparency.
        assert not re.search(rb"<(....)*0000(....)*> Tj", used) and b" gs" not in used and b" k\n" not in used


def test_the_digest_is_computed_without_calibench(calibrated, program, tmp_path):
    reader = pypdf.PdfReader(tmp_path / "camera.pdf")
    files = {name: one[0] for name, one in reader.attachments.items()}
    assert sorted(files) == ["certificate.json", "files.sha256"]
    digest = hashlib.sha256(files["certificate.json"] + files["files.sha256"]).hexdigest()
    text = "\n".join(page.extract_text() for page in reader.pages)
    assert digest in text and " ".join(re.findall("....", digest)[:4]) in text
    (tmp_path / "files.sha256").write_bytes(files["files.sha256"])
    subprocess.run(["sha256sum", "-c", "--quiet", "files.sha256"], cwd=tmp_path, check=True)
    record = json.loads(files["certificate.json"])
    assert record["record"]["calibration"] == calibrated
    said = program("certificate", "--verify", "camera.pdf")
    assert f"stated    {digest}\ncomputed  {digest}\n" in said and "byte for byte" in said


def test_what_changed_is_named(calibrated, program, tmp_path):
    code = 3 if calibrated["doubts"] else 0
    program("certificate", "report", "-o", "again.pdf", "--by", "Our laboratory", "--place", "Our town", code=code)
    assert (tmp_path / "again.pdf").read_bytes() == (tmp_path / "camera.pdf").read_bytes()
    photo = sorted((tmp_path / "photos").iterdir())[2]
    whole = photo.read_bytes()
    photo.write_bytes(whole + b"\n")
    said = program("certificate", "--verify", "camera.pdf", code=1)
    assert f"changed   photos/{photo.name}\n" in said
    photo.unlink()
    assert " files are not found: photos/" in program("certificate", "--verify", "camera.pdf", code=2)
    photo.write_bytes(whole)
    pdf = (tmp_path / "camera.pdf").read_bytes()
    (tmp_path / "signed.pdf").write_bytes(pdf + b"\n% a signature")
    assert "14 bytes behind them" in program("certificate", "--verify", "signed.pdf", code=3)
    (tmp_path / "forged.pdf").write_bytes(pdf.replace(b"chessboard:9x6:25", b"chessboard:9x6:26"))
    program("certificate", "--verify", "forged.pdf", code=1)
    # A record that was changed in the folder of a report is no report.
    record = tmp_path / "report/certificate.json"
    record.write_text(record.read_text().replace("9x6:25", "9x6:26"))
    assert "certificate.json: is not as it was written" in program("certificate", "report", "-o", "again.pdf", code=2)


def test_what_is_no_input_is_refused(calibrated, program, tmp_path):
    refused = [
        (["certificate", "photos", "-o", "a.pdf"], "holds no certificate.json"),
        (["certificate", "report", "-o", "a.txt"], "a certificate ends in .pdf"),
        (["certificate", "report", "-o", "a.pdf", "--camera", "left"], "no camera is called `left`"),
        (["certificate", "--verify", "camera.toml"], "no certificate of calibench is attached"),
        (["certificate", "--verify", "none.pdf"], "none.pdf"),
        (["calibrate", "photos", "--board", "9x6:25", "--by", "me"], "--by: for a certificate"),
    ]
    for words, why in refused:
        assert why in program(*words, code=2), words
