"""Workers that wait until a test lets them go on."""

import importlib
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import ParamSpec, TypeVar

import pytest

Given = ParamSpec("Given")
Returned = TypeVar("Returned")


@contextmanager
def held_up(monkeypatch: pytest.MonkeyPatch, *places: str) -> Iterator[threading.Event]:
    """Let workers wait where they call some functions, until the block ends or the gate is set."""
    gate = threading.Event()

    def waiting(real: Callable[Given, Returned]) -> Callable[Given, Returned]:
        @wraps(real)
        def waits(*arguments: Given.args, **options: Given.kwargs) -> Returned:
            gate.wait()
            return real(*arguments, **options)

        return waits

    with monkeypatch.context() as patch:
        for place in places:
            module, _, name = place.rpartition(".")
            patch.setattr(place, waiting(getattr(importlib.import_module(module), name)))
        try:
            yield gate
        finally:
            gate.set()
