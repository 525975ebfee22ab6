"""The bench, cut short: parts in one call, and parts that fail."""

import importlib
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.bench import __main__ as whole, memory, part, scenes
from tests.bench.__main__ import PARTS

ROOT = Path(__file__).parents[1]


def bench(*words: str, **variables: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tests.bench", "--brief", *words]
    environment = {**os.environ, **variables}
    return subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )


def rows_of_tables(said: str) -> list[int]:
    machine, *tables = said.split("\n\n")
    assert "cores" in machine
    return [len(table.splitlines()) - 1 for table in tables]


def test_opening_a_drawing_is_measured():
    opening = next(iter(scenes.tables(scenes.BRIEF)))
    assert "2 layers of 160 pixels" in opening.title
    read, shown, until_here = opening.rows
    assert 0 < read.seconds <= shown.seconds
    assert (until_here.seconds, until_here.note) == (None, memory.most_held())


@pytest.mark.long
def test_a_part_that_draws_needs_no_display():
    done = bench("scenes", DISPLAY="", WAYLAND_DISPLAY="")
    assert done.returncode == 0, done.stderr
    assert rows_of_tables(done.stdout) == [3, 4, 1]


# In place of the parts: only one of them measures something.
FAILING = """
import sys
assert sys.argv[1:] == [sys.argv[1], "--brief"]
print("\\nrows\\n  one" if sys.argv[1] == "deform" else sys.exit("it is broken"), flush=True)
"""


def test_bench_tries_all_parts_when_some_fail(tmp_path, monkeypatch, capfd):
    folder = tmp_path / "tests" / "bench"
    folder.mkdir(parents=True)
    (folder / "part.py").write_text(FAILING)
    monkeypatch.setattr(whole, "ROOT", tmp_path)
    monkeypatch.setattr(sys, "argv", ["bench", "domain", "deform", "export", "--brief"])
    assert whole.main() == 1
    out, err = capfd.readouterr()
    assert rows_of_tables(out) == [1]
    assert err.count("it is broken") == 2
    assert err.splitlines()[-1] == "failed: domain, export"


def test_part_prints_its_tables(monkeypatch, capsys):
    measured = SimpleNamespace(
        BRIEF="little", Extent=lambda: "much", tables=lambda extent: (extent, "another table")
    )
    monkeypatch.setitem(sys.modules, "tests.bench.domain", measured)
    for words, extent in (["--brief"], "little"), ([], "much"):
        monkeypatch.setattr(sys, "argv", ["part", "domain", *words])
        part.main()
        assert capsys.readouterr().out == f"\n{extent}\n\nanother table\n"


@pytest.mark.long
def test_all_parts_are_tried_though_some_fail(tmp_path):
    # Only the deformer's does without Pillow.
    (tmp_path / "PIL.py").write_text("raise ImportError('Pillow is broken')")
    done = bench("domain", "deform", "export", PYTHONPATH=str(tmp_path))
    assert done.returncode == 1
    assert rows_of_tables(done.stdout) == [9]
    assert done.stderr.count("\nImportError: Pillow is broken") == 2
    assert done.stderr.splitlines()[-1] == "failed: domain, export"


def test_every_part_is_there():
    for name in PARTS:
        module = importlib.import_module(f"tests.bench.{name}")
        assert callable(module.tables)
        assert isinstance(module.BRIEF, module.Extent)


def test_a_part_that_is_not_there_is_refused():
    done = bench("everything")
    assert done.returncode == 2
    assert "there is no part everything" in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="Windows does not tell")
def test_the_memory_of_a_command_is_its_own():
    ours = bytearray(2**28)
    small, large = (
        memory.run_measured(sys.executable, "-c", f"bytearray({size})") for size in (0, 2**27)
    )
    assert len(ours) > 2**27
    least, most = (float(run.memory.split()[0]) for run in (small, large))  # GiB
    assert least < 0.1
    assert 0.125 <= most < 0.25


def test_where_the_system_does_not_tell_memory_is_not_measured(monkeypatch):
    monkeypatch.setattr(memory.sys, "platform", "win32")
    assert memory.most_held() == "memory is not measured here"
