"""One window for all tests of the interface; each test finds it as it opens."""

from collections.abc import Iterator

import pytest
from ui.harness import Harness


@pytest.fixture(scope="session")
def _only_window() -> Harness:
    return Harness()


@pytest.fixture
def window(_only_window: Harness) -> Iterator[Harness]:
    _only_window.reset()
    yield _only_window
    problems = [toast.details for toast in _only_window.session.toasts if toast.details]
    assert not problems, problems[0]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--screenshots", metavar="DIR", help="write the screenshots of the main states to a folder"
    )
