"""`lissom`: the entry point, its subcommands, and the boundary that turns errors into messages."""

import argparse
import importlib
import os
import sys
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from app.cli.console import Parser, StatusLine, exit_with_error, print_notice
from app.cli.process import (
    SignalHandler,
    discard_output,
    has_running_threads,
    reopen_std_streams,
    require_memory,
    use_one_thread,
)
from app.errors import EXPECTED_ERRORS, REINSTALL, listen_to_progress

EXIT_FAILED, EXIT_PIPE_CLOSED = 1, 141

TOO_LITTLE_MEMORY = (
    "not enough memory for this; ask for fewer triangles or a smaller picture, or allow "
    "Lissom more of it"
)
# Subcommand → its summary. The module of this name in app.cli.commands loads fast; what computes is
# loaded when it runs, after the arguments are checked.
COMMANDS = {
    "window": "Open the window, with a picture or a project if one is named.",
    "domain": "Find a picture's outline; build the cage and the triangulation.",
    "deform": "Drag handles of a shape within bounds, from file to file.",
    "pose": "Make a project from a picture and a script of handles and keys.",
    "move": "Make a project in which a drawing walks, waves or sways, by a ready motion.",
    "certify": "Tell how far an animation distorts its drawing, and prove its keyframes.",
    "interpolate": "In-betweens of keyframes at points, from file to file.",
    "figures": "Make the figures of the paper anew, with what was measured beside them.",
    "export": "Render an animation to picture files or video.",
    "thumbnail": "Write the small picture of a project, as file managers ask for it.",
    "desktop": "Enter Lissom into the menu of applications, or take it out again.",
    "manual": "Copy the manual, pages that any browser shows, into a folder.",
    "doctor": "Tell what works on this machine, and what to install where it does not.",
}


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command of the program and return its exit status."""
    use_one_thread()
    reopen_std_streams()
    words = list(sys.argv[1:] if argv is None else argv)
    if not words or (words[0] not in COMMANDS and not words[0].startswith("-")):
        words = ["window", *words]
    endings = SignalHandler()
    try:
        require_memory()
        with endings, StatusLine() as status_line, listen_to_progress(status_line.show_progress):
            try:
                arguments = build_parser(words).parse_args(words)
                command = importlib.import_module(f"app.cli.commands.{arguments.command}")
                status = int(command.run(arguments))
            finally:
                # Here, because at Python's own end nobody could handle a closed pipe.
                sys.stdout.flush()
    except EXPECTED_ERRORS as error:
        exit_with_error(str(error))
    except ImportError as error:
        exit_with_error(
            f"a library cannot be loaded ({error}); give it more memory, or {REINSTALL}"
        )
    except (MemoryError, RuntimeError) as error:
        if isinstance(error, RuntimeError) and "start new thread" not in str(error):
            return _report(error, words)
        exit_with_error(TOO_LITTLE_MEMORY)
    except KeyboardInterrupt:
        print(f"lissom: interrupted by {endings.signal_name}", file=sys.stderr, flush=True)
        if has_running_threads():
            # Running jobs may take long, and libraries must not be taken down under their threads.
            os._exit(endings.exit_status)
        return endings.exit_status
    except BrokenPipeError:
        # The reader of the output has closed it.
        discard_output()
        return EXIT_PIPE_CLOSED
    except OSError as error:
        discard_output()
        exit_with_error(
            f"cannot use {error.filename or 'standard output'}: {error.strerror or error}"
        )
    except Exception as error:  # noqa: BLE001 - the command line: unexpected errors
        return _report(error, words)
    return status


def _report(error: Exception, words: Sequence[str]) -> int:
    """Print a report of the program's own failure that may be passed on."""
    reports = importlib.import_module("app.reports")
    files = [Path(word) for word in words if {".", os.sep}.intersection(word)]
    trace = reports.format_trace(error, files)
    print(reports.format_problem_report(graphics="", actions=(), trace=trace), file=sys.stderr)
    print_notice(
        "this command failed, as told above; nothing is sent, and names of files are left out"
    )
    return EXIT_FAILED


def build_parser(words: Sequence[str]) -> argparse.ArgumentParser:
    """Return the parser; only the subcommand in `words` is loaded."""
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
            command = importlib.import_module(f"app.cli.commands.{name}")
            command.add_arguments(subparser)
            subparser.epilog = command.EPILOG
    return parser


if __name__ == "__main__":
    raise SystemExit(main())
