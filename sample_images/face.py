"""Faces: the eyes that all creatures share."""

from __future__ import annotations

from curves import ellipse
from paint import INK, Canvas, Gradient


def eye(
    canvas: Canvas, centre: complex, radius: float, iris: str, look: complex = 0j, tilt: float = 0.0
) -> None:
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
    tilt : float
        Clockwise turn of the whole eye, in degrees.
    """
    canvas.flat(ellipse(centre, radius + 4, 1.25 * radius + 4, tilt), INK)
    canvas.flat(
        ellipse(centre, radius, 1.25 * radius, tilt),
        Gradient(centre - 1.2j * radius, centre + 0.2j * radius, "#cfc6e2", "#ffffff"),
    )
    pupil = centre + look
    canvas.flat(ellipse(pupil, 0.74 * radius, 0.92 * radius, tilt), INK)
    canvas.flat(ellipse(pupil + 0.1j * radius, 0.6 * radius, 0.74 * radius, tilt), iris)
    canvas.flat(ellipse(pupil, 0.4 * radius, 0.52 * radius, tilt), INK)
    canvas.flat(ellipse(pupil + radius * (-0.26 - 0.38j), 0.27 * radius), "#ffffff")
    canvas.flat(ellipse(pupil + radius * (0.26 + 0.42j), 0.14 * radius), "#ffffff", opacity=0.85)
