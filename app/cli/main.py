"""`lissom`: the entry point, its subcommands, and the boundary where errors become words."""

import argparse
import importlib
import os
import sys
from collections.abc import Sequence
from importlib.metadata import version
from typing import NoReturn

from app.errors import EXPECTED_ERRORS

EXIT_ERROR = 2
EXIT_INTERRUPTED = 130

# Subcommand → the module in app.cli that defines `add_arguments(parser)` and `run(arguments)`.
COMMANDS = {
    "domain": "Find a picture's outline; build the cage and the triangulation.",
}


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one line, as those of every other failure."""

    def error(self, message: str) -> NoReturn:
        """Report bad usage and leave."""
        fail(f"{message} (see '{self.prog} --help')")


def fail(message: str) -> NoReturn:
    """Print one line of error and leave with the exit status of bad input."""
    line = " ".join(message.split())
    print(f"lissom: error: {line}", file=sys.stderr)
    raise SystemExit(EXIT_ERROR)


def notice(message: str) -> None:
    """Tell the person what was done on their behalf."""
    print(f"lissom: {message}", file=sys.stderr)


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command of the program and return its exit status."""
    # Before NumPy is loaded: the matrices are small, and a second BLAS thread on a busy core can
    # make a solver step fifty times slower.
    for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    words = list(sys.argv[1:] if argv is None else argv)
    arguments = build_parser(words).parse_args(words)
    try:
        return int(importlib.import_module(f"app.cli.{arguments.command}").run(arguments))
    except EXPECTED_ERRORS as error:
        fail(str(error))
    except MemoryError:
        fail("not enough memory for this; ask for fewer triangles or a smaller picture")
    except KeyboardInterrupt:
        print("lissom: interrupted", file=sys.stderr)
        return EXIT_INTERRUPTED


def build_parser(words: Sequence[str]) -> argparse.ArgumentParser:
    """Return the parser; only the subcommand that `words` names is loaded."""
    parser = Parser(
        prog="lissom",
        description="Pose a drawing with a few handles and get in-betweens that never fold.",
    )
    parser.add_argument("--version", action="version", version=f"lissom {version('lissom')}")
    subparsers = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, summary in COMMANDS.items():
        subparser = subparsers.add_parser(
            name,
            help=summary,
            description=summary,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        if name in words:
            importlib.import_module(f"app.cli.{name}").add_arguments(subparser)
    return parser


if __name__ == "__main__":
    raise SystemExit(main())
