"""`lissom thumbnail`: the thumbnail of a project, for file managers."""

import argparse

from app.errors import LissomError
from app.storage import check_writable, draw_thumbnail, read_thumbnail, write_atomically

NO_SMALL_PICTURE = "{project} holds no small picture; open it in the window and save it"


def run(arguments: argparse.Namespace) -> int:
    check_writable(arguments.out, sources=[arguments.project])
    rgba = read_thumbnail(arguments.project)
    if rgba is None:
        raise LissomError(NO_SMALL_PICTURE.format(project=arguments.project))
    content = draw_thumbnail(rgba, arguments.size)
    write_atomically(arguments.out, lambda file: file.write(content))
    return 0
