"""`lissom certify`: what is proven of an animation, and where it is not."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from app.cli.main import main
from app.document import Document, Meshing, new_figure
from app.storage import load_project, save_project

SAMPLE = Path(__file__).parents[3] / "sample_images/giraffe.lissom"


def certified(capsys, *words):
    status = main(["certify", str(SAMPLE), *words])
    return status, capsys.readouterr().out


def test_in_betweens_are_proven_between_frames_too(capsys):
    status, said = certified(capsys, "--json")
    assert status == 0
    for interval in json.loads(said)["intervals"]:
        proven = interval["proven"]
        assert proven["never_folds"]
        assert proven["unsettled_frames"] == []
        # Above what is measured, and near it.
        for name, sign, by in zip(
            ("k", "sigma_a", "sigma_b"), (1, 1, -1), proven["excess"], strict=True
        ):
            assert 0 <= sign * (proven[name] - interval[name]) <= 0.004
            assert by == pytest.approx(sign * (proven[name] - interval[f"{name}_keys"]))


def test_frames_that_fold_are_named(capsys):
    status, said = certified(capsys, "--variant", "linear")
    assert status == 1
    assert "NOT PROVEN" in said
    assert "may fold       frames 12, 13, 14, 15, 16, 17, 18\n" in said
    _, said = certified(capsys, "--variant", "linear", "--json")
    first, second, _ = json.loads(said)["intervals"]
    assert not first["proven"]["never_folds"]
    assert first["sigma_b"] < 0
    assert second["proven"]["never_folds"]


def test_where_every_layer_stands_still_there_is_nothing_to_certify(tmp_path, capsys):
    (drawn,) = load_project(SAMPLE).figures
    still = replace(new_figure(drawn.picture, drawn.domain, Meshing()), still=True)
    path = tmp_path / "still.lissom"
    save_project(path, Document(figures=(still,)))
    assert main(["certify", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"figures": {}}
