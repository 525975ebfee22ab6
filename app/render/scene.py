"""The contents of a frame as values: panels and exports make them, the renderer draws them."""

from dataclasses import dataclass
from typing import Final

from app.document import CompositeGroup
from app.render.gpu.mesh import PosedMesh
from engine.arrays import Complexes

Colour = tuple[float, float, float, float]
"""Red, green, blue and alpha between 0 and 1, straight, as they stand in a picture file."""

Painted = PosedMesh | CompositeGroup[PosedMesh]
"""A mesh, or several that are composited as one."""

TRANSPARENT: Final[Colour] = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Backdrop:
    """The background behind everything."""

    colour: Colour = TRANSPARENT
    checks: Colour | None = None  # second colour of a checkerboard
    # Side of its squares in pixels. They move with the plane but keep their size.
    square: float = 12.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Heat:
    """A heat map of the values written to the meshes."""

    # The values at the two ends of the colours; values beyond get the colour of the end.
    low: float
    high: float
    contours: int = 9  # number of contour lines
    strength: float = 0.85  # 1 shows the heat map alone, 0 the drawing alone
    two_sided: bool = False  # whether values in the middle leave the drawing unchanged


@dataclass(frozen=True, slots=True, kw_only=True)
class Wireframe:
    """The edges of the triangles; `width` is in pixels."""

    colour: Colour
    width: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ghost:
    """A translucent drawing of another frame, under the current frame: an onion skin."""

    meshes: tuple[Painted, ...]  # the drawing in that frame, back to front
    # Red, green and blue; None keeps the colours.
    tint: tuple[float, float, float] | None
    opacity: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Line:
    """A smooth polyline of constant width on the screen."""

    points: Complexes  # complex128 (n,) in the plane, n ≥ 2
    colour: Colour
    width: float = 1.5  # in pixels
    dash: float = 0.0  # pixels of a dash and of a gap; 0 for a solid line
    closed: bool = False  # joins the last point to the first


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc:
    """A smooth disc of constant size on the screen."""

    centre: complex  # in the plane
    radius: float  # in pixels, to the outer edge of the rim
    fill: Colour
    rim: Colour = TRANSPARENT
    rim_width: float = 0.0  # in pixels
    softness: float = 1.0  # pixels of the outer edge: 1 is sharp, more makes a shadow


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scene:
    """A frame, from back to front: background, ghosts, drawing, wireframe, lines, discs.

    Ghosts may also be in front of some or all of the drawing's meshes.
    """

    background: Backdrop = Backdrop()
    # The drawing in this frame, back to front.
    meshes: tuple[Painted, ...] = ()
    # Paints the drawing in the colours of the values last written to its meshes.
    heat: Heat | None = None
    wireframe: Wireframe | None = None
    ghosts: tuple[Ghost, ...] = ()  # back to front
    ghosts_over: int = 0  # number of meshes behind the ghosts
    lines: tuple[Line, ...] = ()
    discs: tuple[Disc, ...] = ()
