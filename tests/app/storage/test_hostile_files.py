"""Files of every kind that were tampered with: read as valid ones, or refused in plain words.

`python -m tests.campaigns --only readers` tries many more of them.
"""

import hypothesis
import pytest
from hostile_files import READERS, STEPS, Watch, read_changed
from hypothesis import HealthCheck, given, settings, strategies as st

INPUTS = 4
# What was found once: decoders that raise what nobody expected.
FOUND = [
    ("pictures", "a.avif", [(4, 0.5, 0.375, 0)]),
    ("pictures", "a.avif", [(0, 0.75, 0.0, 0)]),
    ("OpenRaster", "a.ora", [(0, 0.0, 0.0, 0), (9, 0.0, 0.0, 0)]),
]


@pytest.fixture(scope="module")
def watch():
    return Watch()


@pytest.mark.filterwarnings("ignore::UserWarning")  # of Pillow and zipfile, about the damage
@pytest.mark.parametrize("name", READERS)
def test_tampered_files_are_read_or_refused_in_words(tmp_path, watch, name):
    reader = READERS[name]

    @hypothesis.seed(0)
    @settings(max_examples=INPUTS, suppress_health_check=list(HealthCheck))
    @given(st.sampled_from(sorted(reader.samples())), STEPS)
    def read(sample, steps):
        read_changed(reader, sample, steps, tmp_path, watch)

    read()


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize(("name", "sample", "steps"), FOUND)
def test_what_was_found_once_is_refused_in_words(tmp_path, watch, name, sample, steps):
    read_changed(READERS[name], sample, steps, tmp_path, watch)
