"""`lissom doctor`: the working features of this machine."""

import argparse

from app.cli.console import print_line
from app.texts import _

EPILOG = _(
    """\
The exit status is 0 if Lissom can render here, and 1 if not. "--" marks what is missing, and says
what to install. Only rendering is required.

examples:
  lissom doctor
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare nothing."""


def run(arguments: argparse.Namespace) -> int:  # noqa: ARG001
    from app.cli.machine_checks import check_rendering, check_surroundings
    from app.reports import describe_machine

    print_line(describe_machine())
    rendering = check_rendering()
    for check in (*rendering, *check_surroundings()):
        print_line(f"{'ok' if check.works else '--'}  {check.name}: {check.text}")
    if any(check.works for check in rendering):
        print_line(_("Lissom can render here."))
        return 0
    print_line(_("Lissom cannot render here. Install one of the drivers named above."))
    return 1
