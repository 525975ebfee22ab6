"""What every figure comes to, and what it is made with."""

from dataclasses import dataclass

from app.cli.figures.easel import Easel
from app.cli.figures.sheet import told
from app.cli.figures.track import Measured


@dataclass(frozen=True, slots=True, kw_only=True)
class Studio:
    """What figures are made with.

    Parameters
    ----------
    easel : Easel
    triangles : int
        Of a shape's mesh.
    largest : int
        Vertices of the largest mesh that is timed.
    """

    easel: Easel
    triangles: int
    largest: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Plate:
    """A figure as it is shown.

    Parameters
    ----------
    title, caption : str
    picture : bytes
        A PNG file.
    heads : tuple of str
        Of the columns of numbers beside it; the first is of the rows' names.
    rows : tuple of tuple of str
    """

    title: str
    caption: str
    picture: bytes
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


BOUNDED = ("", "k, of its key", "τ − 1, of its key", "largest k", "largest τ − 1", "least area")


def bounded_rows(measured: tuple[Measured, ...]) -> tuple[tuple[str, ...], ...]:
    """Return the rows below `BOUNDED`."""
    return tuple(
        (
            one.name,
            told(one.k),
            told(one.tau),
            told(one.k_of_all),
            told(one.tau_of_all),
            f"{one.area:.3f}",
        )
        for one in measured
    )
