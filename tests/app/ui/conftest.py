"""One window for all tests of the interface; each test finds it as it opens."""

from collections.abc import Iterator

import pytest
from bars import bend_bar, open_bar
from harness import Harness

from app.editor.project import Project


@pytest.fixture(scope="session")
def _only_window() -> Harness:
    return Harness()


@pytest.fixture
def window(_only_window: Harness) -> Iterator[Harness]:
    _only_window.reset()
    yield _only_window
    problems = [toast.details for toast in _only_window.session.notices.toasts if toast.details]
    assert not problems, problems[0]


@pytest.fixture
def everything(window: Harness) -> None:
    """Prepare all in-betweens, corrections, series and measures, as the program does unasked."""
    window.session.settings.prepares_ahead = True


@pytest.fixture
def painted(window: Harness) -> None:
    """Draw the viewport in frames of which no picture is taken, too."""
    window.paints = True


@pytest.fixture
def bar(window: Harness) -> Project:
    """The sample of a bar, with a handle near each end, the second one selected."""
    return window.again(open_bar)


@pytest.fixture
def bent(window: Harness) -> Project:
    """The bar, bent at its right end: keys at frames 0 and 24, the second one is shown."""
    return window.again(bend_bar, None, "auto-pins")


@pytest.fixture
def loose(window: Harness) -> Project:
    """The same bar, none of whose handles stays between its keys."""
    return window.again(bend_bar, None, "loose")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--screenshots", metavar="DIR", help="write the screenshots of the main states to a folder"
    )
