"""What a command says to the person who runs it."""

import argparse
import sys
import time
from collections.abc import Sequence
from typing import NoReturn, Self

from app.errors import display_message, few_notices, printable

EXIT_ERROR = 2
PATIENCE = 0.5  # seconds before a person is told how far a computation is


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one line, as those of every other failure."""

    def error(self, message: str) -> NoReturn:
        """Report bad usage and leave."""
        exit_with_error(f"{message} (see '{self.prog} --help')")


def exit_with_error(message: str) -> NoReturn:
    """Print one line of error and leave with the exit status of bad input."""
    print(f"lissom: error: {display_message(message)}", file=sys.stderr)
    raise SystemExit(EXIT_ERROR)


def print_line(message: str) -> None:
    """Print what a command found or made, on one line or several."""
    print(printable(message, keeps_lines=True))


def print_notice(message: str) -> None:
    """Tell the person what was done on their behalf."""
    print(f"lissom: {display_message(message)}", file=sys.stderr)


def print_notices(messages: Sequence[str]) -> None:
    """Tell the person several things; of many the first ones, and how many more there are."""
    for message in few_notices(messages):
        print_notice(message)


class StatusLine:
    """One line on a terminal that tells what is going on; without a terminal it says nothing.

    At the end of its `with` it is left empty for whatever is printed next.
    """

    def __init__(self) -> None:
        self._is_seen = sys.stderr.isatty()
        self._begun = time.monotonic()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.show("")

    def show(self, text: str) -> None:
        """Put a text in place of the one before."""
        if self._is_seen:
            print(f"\r\x1b[K{display_message(text)}", end="", file=sys.stderr, flush=True)

    def show_progress(self, share: float) -> None:
        """Tell how much of what takes long is done, from 0 to 1."""
        if time.monotonic() - self._begun > PATIENCE:
            self.show(f"preparing the outline: {share:.0%}" if share < 1.0 else "")
