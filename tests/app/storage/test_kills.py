"""Some of what `python -m tests.campaigns --only kills faults` does, as that command does it."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.long
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs processes that can be forked")
def test_what_is_killed_or_refused_while_it_saves_or_exports_loses_nothing():
    command = [sys.executable, "-m", "tests.campaigns", "--only", "kills", "faults"]
    done = subprocess.run(
        [*command, "--amount", "3"],
        capture_output=True,
        text=True,
        check=False,
        cwd=Path(__file__).parents[3],
    )
    assert done.returncode == 0, done.stderr
    assert [int(count) for count in re.findall(r"kills (\d+)", done.stdout)] == [1, 1, 1]
    assert [int(count) for count in re.findall(r"refused (\d+)", done.stdout)] == [2, 9]
