"""Runs of the tests are repeatable: what they draw depends on themselves alone."""

import sys

from hypothesis.internal.conjecture import providers

import app.document  # noqa: F401 - a local module with constants, whichever others are loaded


def test_hypothesis_draws_no_constants_of_loaded_modules():
    assert "app.document" in sys.modules
    found = providers._get_local_constants()
    assert not any(found.set_for_type(kind) for kind in ("integer", "float", "bytes", "string"))
