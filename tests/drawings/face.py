"""Faces: the eyes that all creatures share."""

from __future__ import annotations

from curves import ellipse
from paint import INK, Canvas, Gradient


def eye(canvas: Canvas, centre: complex, radius: float, iris: str, look: complex) -> None:
    """Draw a round, shining eye.

    Parameters
    ----------
    canvas : Canvas
    centre : complex
    radius : float
        Half the width of the white; it is a quarter taller than wide.
    iris : str
        Colour of the iris.
    look : complex
        Offset of the iris, in pixels.
    """

    def oval(middle: complex, size: float, colour: str | Gradient, rim: float = 0.0) -> None:
        canvas.flat(ellipse(middle, size * radius + rim, 1.25 * size * radius + rim), colour)

    # A little higher than the white, the ink is heavier above it, like a lid with lashes.
    oval(centre - 3j, 1.0, INK, rim=5)
    oval(
        centre, 1.0, Gradient(centre - 1.2j * radius, centre + 0.2j * radius, "#cfc6e2", "#ffffff")
    )
    pupil = centre + look
    oval(pupil, 0.8, INK)
    oval(pupil + 0.1j * radius, 0.65, Gradient(pupil, pupil + 1.7j * radius, iris, "#ffffff"))
    oval(pupil, 0.43, INK)
    for place, size in ((-0.26 - 0.38j, 0.27), (0.26 + 0.42j, 0.14)):
        canvas.flat(ellipse(pupil + radius * place, size * radius), "#ffffff")
