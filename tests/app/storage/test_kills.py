"""Some of the kills of `python -m tests.campaigns --only kills`, as that command does them."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs processes that can be forked")
def test_what_is_killed_while_it_saves_or_exports_loses_nothing():
    command = [sys.executable, "-m", "tests.campaigns", "--only", "kills", "--amount", "4"]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, cwd=Path(__file__).parents[3]
    )
    assert done.returncode == 0, done.stderr
    kills = [int(count) for count in re.findall(r"kills (\d+)", done.stdout)]
    assert len(kills) == 3
    assert sum(kills) == 4
