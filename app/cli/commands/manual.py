"""`lissom manual`: a copy of the manual's pages in a folder."""

import argparse
from operator import methodcaller
from pathlib import Path

from app.cli.console import print_line
from app.cli.options import add_out, output
from app.texts import _

EPILOG = _(
    """\
Pages and pictures are written into DIR, which is created if it is missing. Open DIR/index.html in a
browser. The pages need no network and no server. In the window, F1 opens the page about the panel
or tool in use.

examples:
  lissom manual --out manual
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_out(parser, "DIR", place=output)


def run(arguments: argparse.Namespace) -> int:
    from app.storage import check_writable, make_folder, manual_page, write_atomically

    out: Path = arguments.out.path
    first = manual_page()
    sources = sorted(path for path in first.parent.rglob("*") if path.is_file())
    copies = [out / source.relative_to(first.parent) for source in sources]
    for copy in copies:
        make_folder(copy.parent)
    check_writable(*copies, sources=sources)
    for source, copy in zip(sources, copies, strict=True):
        write_atomically(copy, methodcaller("write", source.read_bytes()))
    print_line(_("{path}: the first page of the manual").format(path=out / first.name))
    return 0
