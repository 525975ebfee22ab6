"""Arguments of `lissom desktop`."""

import argparse

EPILOG = """\
On Linux and its kin, Lissom is entered for this person only, under $XDG_DATA_HOME (or
~/.local/share): in the menu of applications, with its icon; as what opens .lissom files; and as
what makes the small pictures of them that file managers show. --remove takes all of that away
again. Install again after Lissom has moved.

examples:
  lissom desktop --install
  lissom desktop --remove
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    either = parser.add_mutually_exclusive_group(required=True)
    either.add_argument("--install", action="store_true", help="enter Lissom into the desktop")
    either.add_argument("--remove", action="store_true", help="take all of that away again")
