"""What a frame shows, as values: the renderer draws them, panels and exports make them."""

from dataclasses import dataclass
from typing import Final

from app.render.gpu import PosedMesh
from engine.arrays import Complexes

Colour = tuple[float, float, float, float]
"""Red, green, blue and alpha between 0 and 1, straight, as they stand in a picture file."""

TRANSPARENT: Final[Colour] = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Backdrop:
    """What lies behind everything.

    Parameters
    ----------
    checks : Colour, optional
        The second colour of a checkerboard.
    square : float
        Side of its squares in pixels. They move with the plane but keep their size.
    """

    colour: Colour = TRANSPARENT
    checks: Colour | None = None
    square: float = 12.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Heat:
    """A heat map of the values that the meshes were given.

    Parameters
    ----------
    low, high : float
        The values at the two ends of the colours; those beyond get the colour of the end.
    contours : int
        Number of lines of equal value in between.
    strength : float
        1 shows the heat map alone, 0 the drawing alone.
    """

    low: float
    high: float
    contours: int = 9
    strength: float = 0.85


@dataclass(frozen=True, slots=True, kw_only=True)
class Wireframe:
    """The edges of the triangles; `width` is in pixels."""

    colour: Colour
    width: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ghost:
    """A drawing that shines through: another frame of it under the current one, an onion skin.

    Parameters
    ----------
    meshes : tuple of PosedMesh
        The drawing in that frame, the furthest first.
    tint : tuple of float or None
        Red, green and blue; None leaves the colours as they are.
    opacity : float
    """

    meshes: tuple[PosedMesh, ...]
    tint: tuple[float, float, float] | None
    opacity: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Line:
    """A smooth polyline of constant width on the screen.

    Parameters
    ----------
    points : complex128, shape (n,)
        At least two, in the plane.
    width : float
        In pixels.
    dash : float
        Length of a dash and of a gap in pixels; 0 for a solid line.
    closed : bool
        Join the last point to the first.
    """

    points: Complexes
    colour: Colour
    width: float = 1.5
    dash: float = 0.0
    closed: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc:
    """A smooth disc of constant size on the screen.

    Parameters
    ----------
    centre : complex
        In the plane.
    radius : float
        In pixels, to the outer edge of the rim.
    fill, rim : Colour
    rim_width : float
        In pixels.
    softness : float
        Width of the outer edge in pixels: 1 is sharp, more makes a shadow.
    """

    centre: complex
    radius: float
    fill: Colour
    rim: Colour = TRANSPARENT
    rim_width: float = 0.0
    softness: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scene:
    """A frame, from back to front: background, ghosts, drawing, wireframe, lines, discs.

    Parameters
    ----------
    background : Backdrop
    meshes : tuple of PosedMesh
        The drawing in this frame, the furthest first.
    heat : Heat, optional
        Paints the drawing in the colours of the values last written to its meshes.
    wireframe : Wireframe, optional
    ghosts : tuple of Ghost
        The furthest first.
    lines : tuple of Line
    discs : tuple of Disc
    """

    background: Backdrop = Backdrop()
    meshes: tuple[PosedMesh, ...] = ()
    heat: Heat | None = None
    wireframe: Wireframe | None = None
    ghosts: tuple[Ghost, ...] = ()
    lines: tuple[Line, ...] = ()
    discs: tuple[Disc, ...] = ()
