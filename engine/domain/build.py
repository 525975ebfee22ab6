"""From pixels to a domain: outline, cage and triangulation (Section 7; Chen and Weber 2015)."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Booleans, Bytes, Complexes, Floats
from engine.domain.meshing import Mesh, triangulate, with_limbs_on_top
from engine.domain.outline import Detail, enclose
from engine.domain.picture import CutOut, Subject, matted, subject_mask
from engine.errors import EngineError
from engine.geometry import Hole, contains, deepest_point

FEWEST_TRIANGLES = 1_000
MOST_TRIANGLES = 2_000_000
# A picture that is never deformed is as good as any inside a cage so much larger.
FRAME = 1.1


@dataclass(frozen=True, slots=True, weakref_slot=True, kw_only=True, eq=False)
class Domain:
    """Where the maps of one picture live.

    Parameters
    ----------
    outline : complex128, shape (p,)
        The domain's boundary: simple, counter-clockwise, in pixels of the picture, y up.
    cage : complex128, shape (n,)
        The polygon of the Cauchy coordinates: simple, counter-clockwise, around the outline.
    mesh : Mesh
        A triangulation of the inside of the outline, less the holes.
    holes : tuple of Hole
        Whose outlines are the rest of the domain's boundary, and whose cages carry coordinates of
        their own.
    closed : complex128, shape (m,), optional
        Where the vertices of the `loops`, one loop after the other, are painted: those on both
        sides of a slit meet in its middle. None where there is no slit.
    """

    outline: Complexes
    cage: Complexes
    mesh: Mesh
    holes: tuple[Hole, ...] = ()
    closed: Complexes | None = None

    def moved(self, by: complex) -> "Domain":
        """Return the domain elsewhere in the plane."""
        mesh = Mesh(vertices=self.mesh.vertices + by, triangles=self.mesh.triangles)
        holes = tuple(hole.moved(by) for hole in self.holes)
        return Domain(
            outline=self.outline + by,
            cage=self.cage + by,
            mesh=mesh,
            holes=holes,
            closed=None if self.closed is None else self.closed + by,
        )

    def contains(self, points: Complexes) -> Booleans:
        """Tell for each point (p,) whether it lies in the domain."""
        return contains(self.outline, points, holes=self.loops[1:])

    def nearest(self, points: Complexes) -> Complexes:
        """Return points (p,) of the domain: those outside are exchanged for the nearest middles.

        Those are the middles of triangles, and each is given once.
        """
        places = points.copy()
        middles = self.mesh.vertices[self.mesh.triangles].mean(axis=1)
        free = np.ones(len(middles), dtype=np.bool_)
        for index in np.flatnonzero(~self.contains(points)):
            distances = np.where(free, np.abs(middles - points[index]), np.inf)
            taken = int(distances.argmin())
            free[taken] = False
            places[index] = middles[taken]
        return places

    @property
    def loops(self) -> tuple[Complexes, ...]:
        """The polygons of the boundary: the outline, then those of the holes."""
        return (self.outline, *(hole.outline for hole in self.holes))

    @property
    def cages(self) -> tuple[Complexes, ...]:
        """The polygons of the Cauchy coordinates: the outline's cage, then those in the holes."""
        return (self.cage, *(hole.cage for hole in self.holes))


def build_domain(
    rgba: Bytes,
    *,
    triangles: int,
    detail: Detail,
    cut_out: CutOut | None = None,
) -> tuple[Domain, tuple[str, ...]]:
    """Find the subject of a picture and build its domain.

    Parameters
    ----------
    rgba : uint8, shape (h, w, 4)
        Straight alpha, first row on top.
    triangles : int
        How many triangles to aim at, 1,000 to 2,000,000.
    detail : Detail
        How closely the outline follows the subject.
    cut_out : CutOut, optional
        What tells the subject from the rest of the picture; None is `CutOut()`.

    Returns
    -------
    domain : Domain
    notices : tuple of str
        Every remedy that was applied, in words.

    Raises
    ------
    EngineError
        If `triangles` is out of range, or the picture has no subject that can be outlined.
    """
    if not FEWEST_TRIANGLES <= triangles <= MOST_TRIANGLES:
        raise EngineError(
            f"The number of triangles must be between {FEWEST_TRIANGLES:,} and "
            f"{MOST_TRIANGLES:,}, not {triangles:,}."
        )
    cut_out = cut_out or CutOut()
    subject = subject_mask(rgba, cut_out)
    enclosure = enclose(
        subject.mask,
        detail=detail,
        holes=cut_out.holes,
        swapped=subject.swapped,
        slits=[slit.points for slit in cut_out.slits],
    )
    loops = [hole.outline for hole in enclosure.holes]
    domain = Domain(
        outline=enclosure.outline,
        cage=enclosure.cage,
        mesh=mesh_inside(enclosure.outline, *loops, triangles=triangles),
        holes=enclosure.holes,
        closed=enclosure.closed,
    )
    return domain, subject.notices + enclosure.notices


def rectangle_domain(width: float, height: float) -> Domain:
    """Return the domain that is all of a picture of this size, in two triangles."""
    corners = np.array([0, width, width + 1j * height, 1j * height])
    middle = corners.mean()
    return Domain(
        outline=corners,
        cage=middle + FRAME * (corners - middle),
        mesh=Mesh(vertices=corners, triangles=np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)),
    )


def mesh_inside(outline: Complexes, *holes: Complexes, triangles: int) -> Mesh:
    """Triangulate the inside of an outline, in an order that paints limbs over the body."""
    mesh = triangulate(outline, triangles, holes=holes)
    return with_limbs_on_top(mesh, deepest_point(outline, holes))


def texture(rgba: Bytes, subject: Subject) -> Bytes:
    """Return the picture (h, w, 4) of a subject as it is painted on its domain's mesh.

    That is the picture itself, with its own transparency; but what was taken out of it is
    transparent, and edges are free of its colour.
    """
    return matted(rgba, subject.mask) if subject.cut else rgba


def texture_coordinates(points: Complexes, image_size: tuple[int, int]) -> Floats:
    """Return u (right) and v (up) of each point, (v, 2); [0, 1] spans the picture.

    Points outside the picture go on linearly past 0 and 1, where the renderer shows transparency.
    """
    width, height = image_size
    return np.column_stack([points.real / width, points.imag / height])
