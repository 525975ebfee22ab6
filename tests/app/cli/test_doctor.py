import re
import shutil

import pytest
from drawings import BACKENDS, HAS_OSMESA

from app.cli import machine_checks
from app.cli.main import main
from app.render.gpu.context import BackendReport
from app.render.view import View


def test_it_draws_with_every_backend_and_says_what_is_missing(capsys, monkeypatch):
    monkeypatch.setattr(machine_checks.sys, "platform", "linux")
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr(machine_checks, "install_hint", lambda extra: f"install {extra}")
    for variable in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(variable, raising=False)
    assert main(["doctor"]) == 0
    said = capsys.readouterr().out
    assert "ok  rendering with egl: " in said
    assert ("ok" if HAS_OSMESA else "--") + "  rendering with osmesa: " in said
    assert "OpenGL 4" in said or "OpenGL 3.3" in said
    assert "--  display for the window: none" in said
    assert "apt install zenity" in said
    assert "--  mp4, webm, mov: av is not installed: install video\n" in said
    assert "--  Photoshop files: psd-tools is not installed: install psd\n" in said
    assert "--  lissom figures: matplotlib is not installed: install figures\n" in said
    assert said.endswith("Lissom can render here.\n")


def test_what_is_there_is_named(capsys, monkeypatch):
    monkeypatch.setattr(machine_checks.sys, "platform", "linux")
    monkeypatch.setattr(shutil, "which", lambda program: program == "kdialog" or None)
    monkeypatch.setenv("WAYLAND_DISPLAY", "wayland-7")
    main(["doctor"])
    said = capsys.readouterr().out
    assert "ok  display for the window: WAYLAND_DISPLAY=wayland-7" in said
    assert "ok  file dialogs of the system: kdialog" in said
    assert "ok  mp4, webm, mov: av " in said
    assert re.search(r"^ok  Photoshop files: psd-tools \d", said, re.MULTILINE)
    assert "numpy " in said


def test_without_a_backend_that_works_the_status_is_1(capsys, monkeypatch):
    monkeypatch.setattr(
        machine_checks,
        "probe_backend",
        lambda backend: BackendReport(backend=backend, problem="sudo apt install it"),
    )
    assert main(["doctor"]) == 1
    said = capsys.readouterr().out
    assert "--  rendering with egl: sudo apt install it" in said
    assert "cannot render here" in said


@pytest.mark.parametrize("backend", BACKENDS)
def test_wrong_pictures_are_noticed(backend, monkeypatch):
    assert machine_checks._draws_exactly(backend)
    monkeypatch.setattr(
        machine_checks, "canvas_view", lambda size: View(centre=8.5 + 6j, scale=1, size=size)
    )
    assert not machine_checks._draws_exactly(backend)
    assert not machine_checks._rendering(backend).works
