"""`.ci/setup` on machines that are not there, with a package manager of the test's own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

SETUP = Path(__file__).parents[1] / ".ci" / "setup"
NEEDED = {"python3", "python3-venv", "libegl1", "libgl1", "libgl1-mesa-dri"}
TESTING = {"xvfb", "xdotool"}
# As apt-get does, it knows no package before an update, and installs all that it is asked for or
# nothing. Options begin with a dash; -s only tells whether the rest would work.
APT_GET = """
words="$*"; echo "$words" >> "$MACHINE/calls"
if [ "$1" = update ]; then touch "$MACHINE/updated"; exit; fi
[ -e "$MACHINE/updated" ] || exit 100
shift
for word in "$@"; do
    case $word in -*) ;; *) grep -qx "$word" "$MACHINE/known" || exit 100 ;; esac
done
case $words in *" -s "*) exit ;; esac
for word in "$@"; do
    case $word in -*) ;; *) echo "$word" >> "$MACHINE/installed" ;; esac
done
"""
DPKG = """
shift
for word in "$@"; do grep -qx "$word" "$MACHINE/installed" || exit 1; done
"""
SUDO = """
[ "$1" = apt-get ] && exec "$@"
"""
NPM = """
echo "$@" > "$MACHINE/npm"
"""
PYTHON = """
mkdir -p .venv/bin
printf '#!/bin/sh\\necho "$@" > "$MACHINE/pip"\\n' > .venv/bin/pip
chmod +x .venv/bin/pip
"""


@pytest.fixture
def machine(tmp_path):
    """A machine with these packages known and installed; returns what is installed afterwards."""
    if sys.platform == "win32":
        pytest.skip("needs bash")
    programs = tmp_path / "programs"
    programs.mkdir()
    texts = {"apt-get": APT_GET, "dpkg": DPKG, "sudo": SUDO, "python3": PYTHON, "npm": NPM}
    for name, text in texts.items():
        (programs / name).write_text(f"#!/bin/sh{text}")
        (programs / name).chmod(0o755)
    (tmp_path / "checkout" / ".ci").mkdir(parents=True)
    copy = tmp_path / "checkout" / ".ci" / "setup"
    copy.write_bytes(SETUP.read_bytes())

    def run(*arguments, known, installed=()):
        (tmp_path / "known").write_text("\n".join([*known, ""]))
        (tmp_path / "installed").write_text("\n".join([*installed, ""]))
        path = f"{programs}{os.pathsep}{os.environ['PATH']}"
        environment = {**os.environ, "PATH": path, "MACHINE": str(tmp_path)}
        subprocess.run(["bash", copy, *arguments], env=environment, check=True)
        return set((tmp_path / "installed").read_text().split())

    return run


def test_a_bare_machine_gets_everything(machine, tmp_path):
    known = NEEDED | TESTING | {"libosmesa6", "chromium"}
    assert machine(known=known) == NEEDED | {"libosmesa6"}
    assert not (tmp_path / "npm").exists()
    assert machine("test", known=known) == known
    assert (tmp_path / "npm").read_text().split()[-1] == "gltf-validator"


def test_a_machine_whose_mesa_has_no_osmesa_gets_the_rest(machine):
    assert machine(known=NEEDED) == NEEDED
    assert machine("test", known=NEEDED | TESTING) == NEEDED | TESTING


def test_where_all_is_there_nothing_is_asked_of_the_package_manager(machine, tmp_path):
    machine(known=NEEDED, installed=NEEDED)
    assert not (tmp_path / "calls").exists()
    assert (tmp_path / "pip").read_text().split()[-1] == "."


def test_a_package_that_is_needed_and_missing_is_an_error(machine):
    with pytest.raises(subprocess.CalledProcessError):
        machine(known=NEEDED - {"libegl1"})
