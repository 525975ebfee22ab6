"""Arguments of `lissom manual`."""

import argparse

from app.cli.options import add_out, output

EPILOG = """\
Pages, pictures and all, are written into DIR, which is made if it is missing: open DIR/index.html
in a browser. They need no network and no server. In the window, F1 opens the page about what is in
front.

examples:
  lissom manual --out manual
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_out(parser, "DIR", place=output)
