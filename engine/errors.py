"""The one error that callers of the engine need to know."""


class EngineError(ValueError):
    """An input that the engine cannot use.

    The message is one or two sentences for the person at the screen: what is wrong, with the
    offending value, and what to do about it. Expected numerical outcomes (a bound reached, an
    iteration limit) are never errors; they are returned as a status.
    """
