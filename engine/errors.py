"""The one error that callers of the engine need to know."""


class EngineError(ValueError):
    """An input that the engine cannot use.

    The message is one or two sentences for the person at the screen: what is wrong, with the
    offending value, and what to do about it. An expected numerical outcome, such as a bound
    reached, is a status instead; a solver that ends unfinished raises unless `throw` is False.
    """
