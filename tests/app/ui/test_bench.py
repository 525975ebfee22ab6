"""The measurements of the window, cut short, in a process of their own."""

import subprocess
import sys

SCRIPT = """
from app.cli.bench.ui import Extent, tables
small = {"triangles": 1_000, "reach": 4, "size": (640, 440), "variant": "nu"}
for table in tables(Extent(repeats=1, frames=2, moves=2, idle=0.1, **small)):
    assert all(row.seconds is None or row.seconds > 0 for row in table.rows), table
    print(len(table.rows))
"""


def test_everything_is_measured():
    result = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout.split() == ["2", "2", "4", "14", "2", "3", "2", "1"]


SCENES = """
from app.cli.bench.scenes import SceneExtent, tables
extent = SceneExtent(layers=2, side=160, figures=1, triangles=1_000, frames=2, reach=4)
for table in tables(extent):
    assert all(row.seconds is None or row.seconds > 0 for row in table.rows), table
    print(len(table.rows))
"""


def test_scenes_are_measured():
    result = subprocess.run(
        [sys.executable, "-c", SCENES], capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout.split() == ["3", "4", "1"]
