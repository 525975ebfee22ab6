"""`.ci/setup` and `.ci/start` on simulated machines, with a package manager of the test's own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).parents[1] / ".ci"
NEEDED = {"python3", "python3-venv", "libegl1", "libgl1", "libgl1-mesa-dri"}
TESTING = {"xvfb", "xdotool", "shared-mime-info"}
WELCOME = {"libosmesa6", "chromium"}
# As apt-get does, it knows no package before an update, and installs all that it is asked for or
# nothing. Options begin with a dash.
APT_GET = """
echo "$*" >> "$MACHINE/calls"
if [ "$1" = update ]; then touch "$MACHINE/updated"; exit; fi
[ -e "$MACHINE/updated" ] || exit 100
shift
for word in "$@"; do
    case $word in -*) ;; *) grep -qx "$word" "$MACHINE/known" || exit 100 ;; esac
done
for word in "$@"; do
    case $word in -*) ;; *) echo "$word" >> "$MACHINE/installed" ;; esac
done
"""
DPKG = """
shift
for word in "$@"; do grep -qx "$word" "$MACHINE/installed" || exit 1; done
"""
SUDO = """
exec "$@"
"""
NPM = """
echo "$@" > "$MACHINE/npm"
"""
UNAME = """
echo "$SYSTEM"
"""
PYTHON = """
mkdir -p .venv/bin
for program in pip lissom; do
    printf '#!/bin/sh\\necho "$@" >> "$MACHINE/'$program'"\\n' > .venv/bin/$program
    chmod +x .venv/bin/$program
done
"""
EXPORT = "export sample_images/giraffe.lissom --out giraffe_frames"
WINDOW = "sample_images/giraffe.lissom"


@pytest.fixture
def machine(tmp_path):
    """A machine with these packages known and installed.

    Returns what is installed afterwards, and what was said.
    """
    if sys.platform == "win32":
        pytest.skip("needs bash")
    programs = tmp_path / "programs"
    programs.mkdir()
    texts = {
        "apt-get": APT_GET,
        "dpkg": DPKG,
        "sudo": SUDO,
        "python3": PYTHON,
        "npm": NPM,
        "uname": UNAME,
    }
    for name, text in texts.items():
        (programs / name).write_text(f"#!/bin/sh{text}")
        (programs / name).chmod(0o755)
    (tmp_path / "checkout" / ".ci").mkdir(parents=True)
    for name in ("setup", "start"):
        (tmp_path / "checkout" / ".ci" / name).write_bytes((SCRIPTS / name).read_bytes())

    def run(*arguments, known, installed=(), script="setup", **variables):
        (tmp_path / "known").write_text("\n".join([*known, ""]))
        (tmp_path / "installed").write_text("\n".join([*installed, ""]))
        path = f"{programs}{os.pathsep}{os.environ['PATH']}"
        environment = {**os.environ, "PATH": path, "MACHINE": str(tmp_path), **variables}
        said = subprocess.run(
            ["bash", tmp_path / "checkout" / ".ci" / script, *arguments],
            env=environment,
            check=True,
            stdout=subprocess.PIPE,
            text=True,
        ).stdout
        return set((tmp_path / "installed").read_text().split()), said

    return run


def test_a_bare_machine_gets_everything(machine, tmp_path):
    known = NEEDED | TESTING | WELCOME
    installed, _ = machine(known=known)
    assert installed == NEEDED | {"libosmesa6"}
    assert not (tmp_path / "npm").exists()
    installed, said = machine("test", known=known)
    assert installed == known
    (told,) = (line for line in said.splitlines() if "To be installed" in line)
    assert all(package in told for package in known)
    assert (tmp_path / "npm").read_text().split()[-1] == "gltf-validator"


@pytest.mark.parametrize("present", [set(), {"libosmesa6"}, {"chromium"}])
def test_what_is_welcome_is_installed_also_where_nothing_needed_is_missing(machine, present):
    needed = NEEDED | TESTING
    installed, said = machine("test", known=needed | WELCOME, installed=needed | present)
    assert installed == needed | WELCOME
    (told,) = (line for line in said.splitlines() if "To be installed" in line)
    assert {word.strip(";.") for word in told.split()} & (needed | WELCOME) == WELCOME - present


def test_a_machine_whose_mesa_has_no_osmesa_gets_the_rest(machine):
    assert machine(known=NEEDED)[0] == NEEDED
    assert machine("test", known=NEEDED | TESTING)[0] == NEEDED | TESTING
    # Also where the rest is there, and all that is welcome cannot be had.
    assert machine(known=NEEDED, installed=NEEDED)[0] == NEEDED


def test_where_all_is_there_nothing_is_asked_of_the_package_manager(machine, tmp_path):
    _, said = machine(known=NEEDED, installed=NEEDED | {"libosmesa6"})
    assert not (tmp_path / "calls").exists()
    assert said.startswith("Into .venv go, from PyPI: Lissom and the libraries")
    assert "To be installed" not in said
    assert (tmp_path / "pip").read_text().split()[-1] == "."


def test_a_package_that_is_needed_and_missing_is_an_error(machine):
    with pytest.raises(subprocess.CalledProcessError):
        machine(known=NEEDED - {"libegl1"})


@pytest.mark.parametrize(
    ("system", "display", "wayland", "has_screen"),
    [
        ("Linux", "", "", False),
        ("Linux", ":0", "", True),
        ("Linux", "", "wayland-0", True),
        ("Darwin", "", "", True),
    ],
)
def test_start_exports_and_opens_a_sample(machine, tmp_path, system, display, wayland, has_screen):
    screen = {"SYSTEM": system, "DISPLAY": display, "WAYLAND_DISPLAY": wayland}
    machine(known=NEEDED, script="start", **screen)
    called = (tmp_path / "lissom").read_text().splitlines()
    assert called == ([EXPORT, WINDOW] if has_screen else [EXPORT])
