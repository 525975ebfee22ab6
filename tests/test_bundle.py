"""What goes into bundles, as far as it can be told without building one, and traps of libraries."""

import ast
import importlib.util
import re
import runpy
import subprocess
import sys
import tomllib
from fnmatch import fnmatch
from importlib.metadata import requires, version
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BUNDLE = ROOT / ".ci" / "bundle"
LISTS = runpy.run_path(str(BUNDLE / "contents.py"))
# Everything that the bundle has, with nothing that it lacks.
LOADS = """
import importlib, pkgutil, runpy, sys
lists = runpy.run_path(sys.argv[1])
sys.modules.update(dict.fromkeys(lists["UNWANTED"]))
for name in ("app", "engine"):
    for module in pkgutil.walk_packages(importlib.import_module(name).__path__, name + "."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
for name in lists["HIDDEN"]:
    importlib.import_module(name)
"""
# The one GLFW that is loaded must be the one that Python speaks to.
LIBRARIES = """
import os, re, sys
for name in sys.argv[1:]:
    __import__(name)
import glfw
maps = open("/proc/self/maps").read()
loaded = {*re.findall(r"\\S*libglfw\\S*", maps), glfw.library.glfw._name}
print(*{os.path.realpath(path) for path in loaded}, sep="\\n")
"""


def python(code, *words):
    done = subprocess.run(
        [sys.executable, "-c", code, *map(str, words)],
        capture_output=True,
        text=True,
        cwd=ROOT,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_all_that_is_named_is_there():
    for module in (*LISTS["WHOLE"], *LISTS["HIDDEN"]):
        assert importlib.util.find_spec(module), module
    site = Path(importlib.util.find_spec("glfw").origin).parents[1]
    for pattern in LISTS["FONTS"]:
        assert list((site / "imgui_bundle").glob(pattern)), pattern
    for folder in LISTS["SPARED"]:
        # Wheels for other systems have other libraries.
        assert (site / folder).is_dir() or folder.startswith("glfw/"), folder


def test_all_that_lissom_needs_is_named():
    named = set(LISTS["DISTRIBUTIONS"])
    assert len(named) == len(LISTS["DISTRIBUTIONS"])
    for name in named:
        assert version(name)
    needed = [line for line in requires("lissom") if "extra == 'test'" not in line]
    assert {re.match(r"[\w-]+", line)[0] for line in needed} <= named
    theme = (ROOT / "app/ui/style/theme.py").read_text(encoding="utf-8")
    fonts = re.findall(r'"(?:fonts/)?([\w/-]+\.[ot]tf)"', theme)
    assert fonts
    for font in fonts:
        assert any(fnmatch(f"assets/fonts/{font}", pattern) for pattern in LISTS["FONTS"]), font


def test_nothing_asks_for_what_bundles_lack():
    python(LOADS, BUNDLE / "contents.py")


@pytest.mark.skipif(sys.platform != "linux", reason="asks Linux which libraries are loaded")
@pytest.mark.parametrize("order", [("imgui_bundle", "glfw"), ("glfw", "imgui_bundle")])
def test_whichever_comes_first_there_is_one_glfw(order):
    assert len(python(LIBRARIES, *order).split()) == 1


def test_lissom_takes_the_glfw_of_its_windows():
    """Elsewhere a second one would be loaded, which knows nothing of the window."""
    for path in (ROOT / "app").rglob("*.py"):
        text, names = path.read_text(encoding="utf-8"), []
        for node in ast.parse(text).body if "glfw" in text else ():
            if isinstance(node, ast.Import):
                names += [alias.name.split(".")[0] for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                names.append((node.module or "").split(".")[0])
        if "glfw" in names:
            assert "imgui_bundle" in names[: names.index("glfw")], path


def test_what_is_started_gets_the_libraries_of_the_system():
    environment = {"LD_LIBRARY_PATH": "/ours", "LD_LIBRARY_PATH_ORIG": "/theirs", "PATH": "/bin"}
    code = "import os, sys; print(sys.argv, os.environ.get('LD_LIBRARY_PATH'), flush=True)"
    for original, left in (("/theirs", "/theirs"), (None, None)):
        if original is None:
            del environment["LD_LIBRARY_PATH_ORIG"]
        done = subprocess.run(
            [sys.executable, BUNDLE / "program.py", "-I", "-S", "-c", code, "one", "2"],
            capture_output=True,
            text=True,
            env=environment,
            check=True,
        )
        assert done.stdout == f"['-c', 'one', '2'] {left}\n"


def test_the_debian_package_enters_lissom_for_everybody(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(BUNDLE))
    debian = runpy.run_path(str(BUNDLE / "debian.py"))
    licence = tmp_path / "_internal/lissom-1.dist-info/licenses/LICENSE"
    licence.parent.mkdir(parents=True)
    licence.write_text("as you like\n")
    files = debian["files"](tmp_path)
    assert b'Exec="/usr/bin/lissom" %f' in files["usr/share/applications/lissom.desktop"]
    for place in ("mime/packages/lissom.xml", "thumbnailers/lissom.thumbnailer"):
        assert f"usr/share/{place}" in files
    copyright_ = files["usr/share/doc/lissom/copyright"].decode()
    assert copyright_.endswith("as you like\n")
    assert f"numpy {version('numpy')}: BSD" in copyright_
    assert "see its folder" not in copyright_


def test_the_changelog_tells_of_this_version():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    unreleased, *released = re.findall(r"^## (.+)$", changelog, flags=re.MULTILINE)
    assert unreleased == "Unreleased"
    dated = [re.fullmatch(r"(\d+\.\d+\.\d+) \((\d{4}-\d\d-\d\d)\)", line) for line in released]
    assert dated[0][1] == settings["project"]["version"]
    dates = [match[2] for match in dated]
    assert dates == sorted(dates, reverse=True)
