"""What is missing is told with the command that brings it here, wherever Lissom was installed."""

import importlib.metadata
import platform
import re
import shutil
import sys
from typing import get_args

import pytest

from app import errors


@pytest.fixture
def home(tmp_path, monkeypatch):
    """An environment without any of the libraries, which has its pip and is in use."""
    programs = tmp_path / "lissom" / "bin"
    programs.mkdir(parents=True)
    monkeypatch.setattr(platform, "system", lambda: "Linux")
    monkeypatch.setattr(sys, "prefix", str(programs.parent))
    monkeypatch.setattr(sys, "executable", str(programs / "python"))
    monkeypatch.setattr(shutil, "which", lambda name: str(programs / name))
    monkeypatch.setattr(errors, "find_spec", lambda name: name if name == "pip" else None)
    return programs.parent


def test_every_extra_has_its_library():
    assert set(errors.LIBRARIES) == set(get_args(errors.Extra))
    said = importlib.metadata.metadata("lissom").get_all("Provides-Extra")
    assert set(errors.LIBRARIES) == set(said) - {"test"}
    for extra, library in errors.LIBRARIES.items():
        assert re.match(r"[\w-]+", errors.required_library(extra))[0] == library
        assert errors.install_hint(extra) == ""


@pytest.mark.usefixtures("home")
def test_an_environment_that_is_in_use_takes_it_by_its_pip():
    assert errors.install_hint("video") == "pip install 'lissom[video]'"


def test_another_environment_is_named(home, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: f"/usr/bin/{name}")
    assert errors.install_hint("psd") == f"{home}/bin/python -m pip install 'lissom[psd]'"
    monkeypatch.setattr(shutil, "which", lambda _: None)
    assert errors.install_hint("psd") == f"{home}/bin/python -m pip install 'lissom[psd]'"


def test_pipx_puts_it_beside(home):
    (home / "pipx_metadata.json").touch()
    assert errors.install_hint("psd") == f"pipx inject lissom '{errors.required_library('psd')}'"


def test_uv_has_no_pip(home, monkeypatch):
    receipt = home / "uv-receipt.toml"
    receipt.touch()
    told = f"uv pip install --python {home} '{errors.required_library('figures')}'"
    assert errors.install_hint("figures") == told
    receipt.unlink()
    monkeypatch.setattr(errors, "find_spec", lambda _: None)
    assert errors.install_hint("figures") == told


@pytest.mark.usefixtures("home")
def test_a_bundle_has_all_of_them_or_is_broken(monkeypatch):
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    assert "install it again" in errors.install_hint("video")


def test_windows_takes_other_quotes(home, monkeypatch):
    monkeypatch.setattr(platform, "system", lambda: "Windows")
    assert errors.install_hint("video") == 'pip install "lissom[video]"'
    (home / "pipx_metadata.json").touch()
    assert (
        errors.install_hint("video") == f'pipx inject lissom "{errors.required_library("video")}"'
    )
