"""What a frame shows, as values: the renderer draws them, panels and exports make them."""

from dataclasses import dataclass
from typing import Final

from app.document import CompositeGroup
from app.render.gpu import PosedMesh
from engine.arrays import Complexes

Colour = tuple[float, float, float, float]
"""Red, green, blue and alpha between 0 and 1, straight, as they stand in a picture file."""

Painted = PosedMesh | CompositeGroup[PosedMesh]
"""A mesh, or several that are composited as one."""

TRANSPARENT: Final[Colour] = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Backdrop:
    """What lies behind everything."""

    colour: Colour = TRANSPARENT
    checks: Colour | None = None  # the second colour of a checkerboard
    # Side of its squares in pixels. They move with the plane but keep their size.
    square: float = 12.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Heat:
    """A heat map of the values that the meshes were given."""

    # The values at the two ends of the colours; those beyond get the colour of the end.
    low: float
    high: float
    contours: int = 9  # number of lines of equal value in between
    strength: float = 0.85  # 1 shows the heat map alone, 0 the drawing alone
    two_sided: bool = (
        False  # whether a value in the middle is none, and leaves the drawing as it is
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Wireframe:
    """The edges of the triangles; `width` is in pixels."""

    colour: Colour
    width: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ghost:
    """A drawing that shines through: another frame of it under the current one, an onion skin."""

    meshes: tuple[Painted, ...]  # the drawing in that frame, the furthest first
    # Red, green and blue; None leaves the colours as they are.
    tint: tuple[float, float, float] | None
    opacity: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Line:
    """A smooth polyline of constant width on the screen."""

    points: Complexes  # complex128 (n,): At least two, in the plane
    colour: Colour
    width: float = 1.5  # in pixels
    dash: float = 0.0  # length of a dash and of a gap in pixels; 0 for a solid line
    closed: bool = False  # join the last point to the first


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc:
    """A smooth disc of constant size on the screen."""

    centre: complex  # in the plane
    radius: float  # in pixels, to the outer edge of the rim
    fill: Colour
    rim: Colour = TRANSPARENT
    rim_width: float = 0.0  # in pixels
    softness: float = 1.0  # width of the outer edge in pixels: 1 is sharp, more makes a shadow


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scene:
    """A frame, from back to front: background, ghosts, drawing, wireframe, lines, discs.

    Ghosts may come later, before some of the drawing's meshes or after all of them.
    """

    background: Backdrop = Backdrop()
    # The drawing in this frame, the furthest first.
    meshes: tuple[Painted, ...] = ()
    # Paints the drawing in the colours of the values last written to its meshes.
    heat: Heat | None = None
    wireframe: Wireframe | None = None
    ghosts: tuple[Ghost, ...] = ()  # the furthest first
    ghosts_over: int = 0  # how many of the meshes are behind them
    lines: tuple[Line, ...] = ()
    discs: tuple[Disc, ...] = ()
