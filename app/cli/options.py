"""Options that several subcommands share."""

import argparse
from typing import get_args

from app.document import Meshing
from engine.domain.outline import Detail


def add_meshing_options(parser: argparse.ArgumentParser) -> None:
    """Declare how the domain of a picture is built; `meshing_of` reads it back."""
    defaults = Meshing()
    parser.add_argument(
        "--triangles",
        metavar="N",
        type=int,
        default=defaults.triangles,
        help="how many triangles to aim at, 1000 to 2000000 (default: %(default)s)",
    )
    parser.add_argument(
        "--detail",
        choices=get_args(Detail),
        default=defaults.detail,
        help="how closely the outline follows the subject (default: %(default)s)",
    )


def meshing_of(arguments: argparse.Namespace) -> Meshing:
    """Return the options of `add_meshing_options` as they were given."""
    return Meshing(triangles=arguments.triangles, detail=arguments.detail)
