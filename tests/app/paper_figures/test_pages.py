"""Figures as files: pictures and one page, from the command line."""

import re

import numpy as np
import pytest
from PIL import Image

from app.cli.commands.figures import FIGURES
from app.cli.main import main
from app.paper_figures.plots.table import MAKERS


def test_the_usage_names_every_figure_that_there_is():
    assert tuple(MAKERS) == FIGURES


def test_a_figure_and_its_page_are_written(tmp_path, capsys):
    out = tmp_path / "new" / "figures"
    out.parent.mkdir()
    assert main(["figures", "--out", str(out), "--only", "3", "--triangles", "1000"]) == 0
    assert {path.name for path in out.iterdir()} == {"figure_3.png", "figures.html"}
    picture = np.asarray(Image.open(out / "figure_3.png").convert("RGB")).astype(int)
    # Five checkers of two colours on white.
    assert 0.05 < (np.ptp(picture, axis=2) > 60).mean() < 0.5
    page = (out / "figures.html").read_text(encoding="utf-8")
    assert page.count("<figure ") == 1
    assert "18.0000°" in page
    assert "18.0000°" in capsys.readouterr().out
    assert not re.findall(r'(?:src|href)="(?!data:)', page)


def test_without_matplotlib_it_says_how_to_install_that(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("app.errors.find_spec", lambda _: None)
    with pytest.raises(SystemExit):
        main(["figures", "--out", str(tmp_path / "out")])
    assert "matplotlib, which is not installed: " in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--only", "2"], "invalid choice"),
        (["--triangles", "10"], "between 1,000"),
        (["--largest", "10"], "at least 1,000"),
    ],
)
def test_bad_requests_are_refused(tmp_path, capsys, words, message):
    with pytest.raises(SystemExit) as leaving:
        main(["figures", "--out", str(tmp_path), *words])
    assert leaving.value.code == 2
    assert message in capsys.readouterr().err
