"""When an X server goes away, unsaved work is kept first; `test_process.py` asks without one."""

import shutil

import numpy as np
import pytest

from tests.campaigns.windows import lost_displays


@pytest.mark.long
@pytest.mark.skipif(shutil.which("Xvfb") is None, reason="there is no X server to end")
def test_edits_survive_the_end_of_the_display():
    assert lost_displays(np.random.default_rng(0), 1)["most edits lost"] == 0
