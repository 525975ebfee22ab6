"""One window for all tests of the interface; each test finds it as it opens."""

from collections.abc import Iterator

import pytest
from harness import Harness

from app.document.keyframe import Target
from app.editor.actions import playback, posing
from app.editor.project import Project
from app.storage.assets import sample_images


@pytest.fixture(scope="session")
def _only_window() -> Harness:
    return Harness()


@pytest.fixture
def window(_only_window: Harness) -> Iterator[Harness]:
    _only_window.reset()
    yield _only_window
    problems = [toast.details for toast in _only_window.session.toasts if toast.details]
    assert not problems, problems[0]


@pytest.fixture
def bar(window: Harness) -> Project:
    """The sample of a bar, with a handle near each end, the second one selected."""
    project = window.open(sample_images() / "bar.png")
    width, height = project.document.canvas
    for share in (0.1, 0.9):
        posing.add_handle(window.session, complex(share * width, height / 2))
        window.frames(2)
    return project


@pytest.fixture
def bent(window: Harness, bar: Project) -> Project:
    """The bar, bent at its right end: keys at frames 0 and 24, the second one is shown."""
    playback.seek(window.session, 24)
    window.settle()
    width, height = bar.puppet.picture.size
    posing.wish(window.session, {1: Target(position=complex(0.85 * width, 0.9 * height))})
    window.settle()
    return bar


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--screenshots", metavar="DIR", help="write the screenshots of the main states to a folder"
    )
