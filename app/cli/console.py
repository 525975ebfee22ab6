"""Messages of a command on the terminal."""

import argparse
import sys
import time
from collections.abc import Sequence
from typing import Any, NoReturn, Self

from app.errors import display_message, few_notices, printable
from app.texts import N_, _, message_of, ngettext
from engine.errors import Message

EXIT_ERROR = 2
NO_WHOLE = N_("expected a whole number, not {text!r}")
NO_NUMBER = N_("expected a number, not {text!r}")
# Texts of argparse, which takes them from the catalogue too.
ARGPARSE_TEXTS = (
    N_("usage: "),
    N_("positional arguments"),
    N_("options"),
    N_("show this help message and exit"),
    N_("argument %(argument_name)s: %(message)s"),
    N_("the following arguments are required: %s"),
    N_("one of the arguments %s is required"),
    N_("not allowed with argument %s"),
    N_("unrecognized arguments: %s"),
    N_("expected one argument"),
    N_("expected at least one argument"),
    N_("ambiguous option: %(option)s could match %(matches)s"),
    N_("ignored explicit argument %r"),
    N_("invalid choice: %(value)r (choose from %(choices)s)"),
    N_("invalid %(type)s value: %(value)r"),
)
vars(argparse).update(_=_, ngettext=ngettext)
PATIENCE = 0.5  # seconds before progress is shown


class Parser(argparse.ArgumentParser):
    """An argument parser with one-line errors, as for every other failure."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.register("type", int, _whole)
        self.register("type", float, _number)

    def error(self, message: str) -> NoReturn:
        """Report bad usage and exit."""
        exit_with_error(
            _("{message} (see '{program} --help')").format(message=message, program=self.prog)
        )


def _whole(text: str) -> int:
    try:
        return int(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(_(NO_WHOLE).format(text=text)) from error


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(_(NO_NUMBER).format(text=text)) from error


def exit_with_error(message: str) -> NoReturn:
    """Print one line of error and exit with the status of bad input."""
    line = _("lissom: error: {message}").format(message=display_message(message))
    print(line, file=sys.stderr)
    raise SystemExit(EXIT_ERROR)


def print_line(message: str) -> None:
    """Print the result of a command, on one line or several."""
    print(printable(message, keeps_lines=True))


def print_notice(message: str) -> None:
    print(f"lissom: {display_message(message)}", file=sys.stderr)


def print_notices(messages: Sequence[str | Message]) -> None:
    """Print the first notices, and the number of the others."""
    for message in few_notices([message_of(message) for message in messages]):
        print_notice(message)


class StatusLine:
    """A status line on a terminal; without a terminal it prints nothing.

    The end of the `with` block clears the line.
    """

    def __init__(self) -> None:
        self._is_seen = sys.stderr.isatty()
        self._begun = time.monotonic()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.show("")

    def show(self, text: str) -> None:
        """Replace the shown text."""
        if self._is_seen:
            print(f"\r\x1b[K{display_message(text)}", end="", file=sys.stderr, flush=True)

    def show_progress(self, share: float) -> None:
        """Show the finished share of a long computation, from 0 to 1."""
        if time.monotonic() - self._begun > PATIENCE:
            text = _("preparing the outline: {share:.0%}").format(share=share)
            self.show(text if share < 1.0 else "")
