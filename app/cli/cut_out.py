"""The options that separate the subject from a picture's background."""

import argparse

from app.cut_out import CutOut
from app.storage import decode_mask, read_file


def parse_cut_out(arguments: argparse.Namespace) -> CutOut:
    path = arguments.mask
    return CutOut(
        tolerance=arguments.tolerance,
        background=arguments.background,
        enclosed=arguments.enclosed,
        mask=None if path is None else decode_mask(read_file(path), str(path)),
        holes=arguments.holes,
    )
