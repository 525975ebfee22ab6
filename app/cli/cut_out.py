"""What of a picture is its subject, as it was said."""

import argparse

from app.storage import decode_mask, read_file
from engine.domain import CutOut


def parse_cut_out(arguments: argparse.Namespace) -> CutOut:
    """Return what tells the subject from its picture, as the options have it."""
    path = arguments.mask
    return CutOut(
        tolerance=arguments.tolerance,
        background=arguments.background,
        enclosed=arguments.enclosed,
        mask=None if path is None else decode_mask(read_file(path), str(path)),
        holes=arguments.holes,
    )
