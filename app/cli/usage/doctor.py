"""Arguments of `lissom doctor`."""

import argparse

EPILOG = """\
The exit status is 0 if Lissom can render here, 1 if not. "--" marks what is missing, with what to
install; everything but rendering can be done without.

examples:
  lissom doctor
"""


def add_arguments(_: argparse.ArgumentParser) -> None:
    """Declare nothing: `lissom doctor` has no options."""
