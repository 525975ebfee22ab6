"""Which tests call the functions that mistakes are made in: a plugin of pytest, and its counter.

What a fixture or a cache keeps was computed for the first test that asked for it; it counts for
all that get it. The file that MUTANT_HITS names gets a line for each function and test that calls
it (number, test), and for each test (`test`, its name, its seconds, its outcome).
"""

import functools
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

# Not pytest, which would be slow to import in the child processes of tests.
from pluggy import HookimplMarker

if TYPE_CHECKING:
    import pytest

hookimpl = HookimplMarker("pytest")

SEEN: set[int] = set()
STATE = {"test": ""}
# What is being computed to be kept, and what it called until now.
RECORDING: list[set[int]] = []
# What fixtures called, by their definitions.
KEPT: dict[int, set[int]] = {}
SECONDS: dict[str, float] = {}
FAILED: set[str] = set()


def hit(number: int) -> None:
    """Note that the test that runs has called a function; once a test and process."""
    for called in RECORDING:
        called.add(number)
    if number in SEEN:
        return
    SEEN.add(number)
    # A test's child processes find its name in the environment.
    test = STATE["test"] or os.environ.get("PYTEST_CURRENT_TEST", "").rpartition(" ")[0]
    if test:
        _write(number, test)


def _write(*words: object) -> None:
    if "MUTANT_HITS" in os.environ:
        with Path(os.environ["MUTANT_HITS"]).open("a", encoding="utf-8") as file:
            file.write("\t".join(map(str, words)) + "\n")


@contextmanager
def _recorded() -> Iterator[set[int]]:
    """Note what is called meanwhile, by any thread."""
    called: set[int] = set()
    RECORDING.append(called)
    try:
        yield called
    finally:
        # Not by `remove`, to which all empty sets are alike.
        RECORDING[:] = [each for each in RECORDING if each is not called]


def pytest_runtest_logstart(nodeid: str) -> None:
    """Tell apart what each test calls."""
    SEEN.clear()
    STATE["test"] = nodeid


def pytest_runtest_logfinish() -> None:
    """Let nothing count for a test that has ended."""
    STATE["test"] = ""


@hookimpl(wrapper=True)
def pytest_fixture_setup(fixturedef: "pytest.FixtureDef[object]") -> Iterator[None]:
    """Note what a fixture calls."""
    with _recorded() as called:
        KEPT[id(fixturedef)] = called
        return (yield)


def pytest_runtest_call(item: Any) -> None:
    """Let what the fixtures of a test called count for it."""
    for fixtures in item._fixtureinfo.name2fixturedefs.values():
        for fixture in fixtures:
            for number in KEPT.get(id(fixture), ()):
                hit(number)


def pytest_runtest_logreport(report: "pytest.TestReport") -> None:
    """Note how long a test took, and whether it passed."""
    if hasattr(report, "node"):
        return  # told to the process that hands out the tests, by the one that ran it
    test = report.nodeid
    SECONDS[test] = SECONDS.get(test, 0.0) + report.duration
    if report.failed:
        FAILED.add(test)
    if report.when == "teardown":
        outcome = "failed" if test in FAILED else "passed"
        _write("test", test, f"{SECONDS.pop(test):.3f}", outcome)


_lru_cache = functools.lru_cache


def _cache_calls(function: Callable[..., object], /) -> Any:
    """Stand in for `functools.cache`."""
    return _lru_cache_calls(None)(function)


def _lru_cache_calls(
    maxsize: Callable[..., object] | int | None = 128,
    typed: bool = False,  # noqa: FBT001, FBT002 - as that of functools
) -> Any:
    """Stand in for `functools.lru_cache`: what is kept counts for every test that gets it."""
    if callable(maxsize):
        return _lru_cache_calls()(maxsize)

    def decorated(function: Callable[..., object]) -> Callable[..., object]:
        if not _is_own(function):
            return _lru_cache(maxsize, typed)(function)

        @_lru_cache(maxsize, typed)
        @functools.wraps(function)
        def computed(*words: object, **named: object) -> tuple[object, frozenset[int]]:
            with _recorded() as called:
                return function(*words, **named), frozenset(called)

        @functools.wraps(function)
        def kept(*words: object, **named: object) -> object:
            value, called = computed(*words, **named)
            for number in called:
                hit(number)
            return value

        for name in ("cache_info", "cache_clear", "cache_parameters"):
            setattr(kept, name, getattr(computed, name))
        return kept

    return decorated


def _is_own(function: Callable[..., object]) -> bool:
    """Tell whether a function is the project's own."""
    while isinstance(function, functools.partial):
        function = function.func
    code = getattr(function, "__code__", None)
    file = Path(code.co_filename) if code else Path()
    return file.is_relative_to(Path.cwd()) and "site-packages" not in file.parts


# In the process of the tests, and before anything of the project is imported: PYTEST_PLUGINS must
# name this, as the processes of xdist load what -p names too late.
if "MUTANT_HITS" in os.environ and "pytest" in sys.modules:
    functools.lru_cache = _lru_cache_calls
    functools.cache = _cache_calls
