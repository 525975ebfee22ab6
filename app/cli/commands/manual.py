"""`lissom manual`: a copy of the manual's pages in a folder."""

import argparse
from pathlib import Path

from app.cli.console import print_line
from app.storage import check_writable, make_folder, manual_page, write_atomically


def run(arguments: argparse.Namespace) -> int:
    out: Path = arguments.out.path
    first = manual_page()
    sources = sorted(path for path in first.parent.rglob("*") if path.is_file())
    copies = [out / source.relative_to(first.parent) for source in sources]
    for copy in copies:
        make_folder(copy.parent)
    check_writable(*copies, sources=sources)
    for source, copy in zip(sources, copies, strict=True):
        _write(copy, source.read_bytes())
    print_line(f"{out / first.name}: the first page of the manual")
    return 0


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda file: file.write(content))
