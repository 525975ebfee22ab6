"""The errors that end a command or an action with a message instead of a traceback."""

from engine.errors import EngineError


class LissomError(Exception):
    """A request that cannot be met; the message tells the person what was wrong and what to do."""


# What a command line, a job or a panel reports as a plain message.
EXPECTED_ERRORS = (LissomError, EngineError)
