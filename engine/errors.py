"""The error of the engine's callers."""


class EngineError(ValueError):
    """An input that the engine cannot use.

    The message is one or two sentences for the person at the screen: the fault, the offending
    value, and the remedy. An expected numerical outcome, such as a reached bound, is a status
    instead. A solver that ends unfinished raises this error unless `throw` is False.
    """
