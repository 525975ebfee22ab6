"""`lissom thumbnail`: the thumbnail of a project, for file managers."""

import argparse
from operator import methodcaller

from app.cli.options import add_out, add_project, whole_number
from app.errors import LissomError
from app.texts import N_, _

NO_SMALL_PICTURE = N_("{project} has no thumbnail; open the project in the window and save it")

EPILOG = _(
    """\
The thumbnail was saved with the project; nothing is rendered. It is never enlarged. File managers
call this command after 'lissom desktop --install'.

examples:
  lissom thumbnail nod.lissom --out nod.png
  lissom thumbnail nod.lissom --out nod.png --size 128
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_project(parser)
    add_out(parser, "OUT.png")
    parser.add_argument(
        "--size",
        metavar="N",
        type=whole_number(1),
        default=256,
        help=_("pixels of the longer side, at most (default: %(default)s)"),
    )


def run(arguments: argparse.Namespace) -> int:
    from app.storage import check_writable, draw_thumbnail, read_thumbnail, write_atomically

    check_writable(arguments.out, sources=[arguments.project])
    rgba = read_thumbnail(arguments.project)
    if rgba is None:
        raise LissomError(_(NO_SMALL_PICTURE).format(project=arguments.project))
    content = draw_thumbnail(rgba, arguments.size)
    write_atomically(arguments.out, methodcaller("write", content))
    return 0
