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
from app.texts import N_, _, message_of

EXIT_FAILED, EXIT_PIPE_CLOSED = 1, 141

TOO_LITTLE_MEMORY = N_(
    "there is not enough memory; choose fewer triangles or a smaller picture, or give Lissom more "
    "memory"
)
# Subcommand → its summary. The module of this name in app.cli.commands loads fast; what computes is
# loaded when it runs, after the arguments are checked.
COMMANDS = {
    "window": _("Open the window, with a picture or a project if you name one."),
    "domain": _("Find the outline of a picture, and build its cage and triangles."),
    "deform": _("Drag the handles of a shape within limits, from file to file."),
    "pose": _("Make a project from a picture and a script of handles and keys."),
    "move": _(
        "Make a project in which a motion preset moves a drawing: walk, wave, sway and more."
    ),
    "certify": _("Measure how far an animation distorts its drawing, and prove its limits."),
    "interpolate": _("Make in-betweens of keyframes, from file to file."),
    "figures": _("Draw the paper's figures, with measured numbers beside them."),
    "export": _("Render an animation to picture files or video."),
    "thumbnail": _("Write the thumbnail of a project, for file managers."),
    "desktop": _("Add Lissom to the applications menu, or remove it."),
    "manual": _("Copy the manual, a set of pages for any browser, into a folder."),
    "doctor": _("Check what works on this machine, and what to install."),
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
        exit_with_error(message_of(error))
    except ImportError as error:
        exit_with_error(
            _("a library cannot be loaded ({error}); give Lissom more memory, or {remedy}").format(
                error=error, remedy=_(REINSTALL)
            )
        )
    except (MemoryError, RuntimeError) as error:
        if isinstance(error, RuntimeError) and "start new thread" not in str(error):
            return _report(error, words)
        exit_with_error(_(TOO_LITTLE_MEMORY))
    except KeyboardInterrupt:
        print_notice(_("interrupted by {signal}").format(signal=endings.signal_name))
        sys.stderr.flush()
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
            _("cannot use {file}: {reason}").format(
                file=error.filename or _("standard output"), reason=error.strerror or error
            )
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
    print_notice(_("this command failed; the report above names no files, and nothing is sent"))
    return EXIT_FAILED


def build_parser(words: Sequence[str]) -> argparse.ArgumentParser:
    """Return the parser; only the subcommand in `words` is loaded."""
    parser = Parser(
        prog="lissom",
        description=_("Pose a drawing with a few handles and get in-betweens that never fold."),
    )
    parser.add_argument(
        "--version",
        action="version",
        help=_("print the version and exit"),
        version=f"lissom {version('lissom')}",
    )
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
