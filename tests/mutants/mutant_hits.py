"""Notes which tests call a function that is to be mutated: a plugin of pytest, and what it calls."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

SEEN: set[int] = set()
STATE = {"test": ""}


def hit(number: int) -> None:
    """Note that the test that runs has called a function; once a test and process."""
    if number in SEEN:
        return
    SEEN.add(number)
    # A test's child processes find its name in the environment.
    test = STATE["test"] or os.environ.get("PYTEST_CURRENT_TEST", "").rpartition(" ")[0]
    with Path(os.environ["MUTANT_HITS"]).open("a") as file:
        file.write(f"{number}\t{test}\n")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Tell apart what each test calls."""
    SEEN.clear()
    STATE["test"] = item.nodeid
    try:
        return (yield)
    finally:
        STATE["test"] = ""
