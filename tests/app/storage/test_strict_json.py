import json

import pytest

from app.errors import LissomError
from app.storage import NOT_FINITE, strict_json


def test_values_are_written_as_they_are_read():
    content = {"a": [1, 0.5, "\x1b"], "b": None}
    assert json.loads(strict_json(content)) == content == json.loads(strict_json(content, indent=1))
    assert strict_json([1, 2]) == "[1,2]"


@pytest.mark.parametrize("number", [float("inf"), float("-inf"), float("nan")])
def test_numbers_that_are_not_finite_are_refused(number):
    with pytest.raises(LissomError, match=NOT_FINITE):
        strict_json({"seconds": [number]})
