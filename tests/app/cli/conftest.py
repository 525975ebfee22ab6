"""Fixtures for commands that run in the tests' own process."""

from collections.abc import Iterator

import moderngl
import pytest

from app.cli import project_export
from app.render.gpu.context import create_context


@pytest.fixture(scope="module")
def kept_context() -> Iterator[moderngl.Context]:
    """A context that stays when a command lets it go: each would translate its shaders anew."""
    context = create_context()
    release, context.release = context.release, lambda: None
    yield context
    release()


@pytest.fixture
def one_context(kept_context: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the exports of a module draw in one context."""

    def again() -> moderngl.Context:
        kept_context.__enter__()
        return kept_context

    monkeypatch.setattr(project_export, "create_context", again)
