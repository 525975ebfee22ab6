"""What is told to the person: errors that are messages and no tracebacks, and names of files."""

import re

from engine.errors import EngineError

# What Python makes of the bytes of a file's name that are no UTF-8, on Linux.
_UNREADABLE = re.compile("[\ud800-\udfff]")


class LissomError(Exception):
    """A request that cannot be met; the message tells the person what was wrong and what to do."""


# What a command line, a job or a panel reports as a plain message.
EXPECTED_ERRORS = (LissomError, EngineError)


def shown_name(name: object) -> str:
    """Return a file's name, or a text with names in it, with a � for each byte that is no UTF-8.

    Neither a window nor a file of text takes such a name as it is.
    """
    return _UNREADABLE.sub("\N{REPLACEMENT CHARACTER}", str(name))
