"""Pictures of posed shapes, by the window's renderer."""

from collections.abc import Sequence
from contextlib import ExitStack
from typing import Self

from app.motion import BoundingBox, VertexArray, bounding_box
from app.paper_figures.shapes import Shape
from app.render import DrawnMesh, Renderer, Scene, fit_view
from app.render.gpu.context import create_context
from app.render.gpu.mesh import GpuMesh
from app.render.gpu.picture import GpuPicture
from app.render.gpu.target import RenderTarget
from engine.arrays import Bytes, Complexes

FINER = 2  # samples of a pixel each way
MARGIN = 0.03  # of the larger side, around a box


class ShapeRenderer:
    """Owner of the renderer of shapes; a context manager.

    Raises `LissomError` if this machine cannot draw.
    """

    def __init__(self) -> None:
        self._owned = ExitStack()
        self._context = create_context()
        self._owned.callback(self._context.release)
        self._renderer = Renderer(self._context)
        self._owned.callback(self._renderer.release)
        self._drawn: dict[Shape, DrawnMesh] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._owned.close()

    def draw(self, shape: Shape, positions: Complexes, box: BoundingBox, *, pixels: int) -> Bytes:
        """Return a picture, uint8 (h, w, 4) with straight alpha, of a box of the plane.

        `positions` (v,) are those of the mesh's vertices; `pixels` is the longer side.
        """
        extent = box.upper - box.lower
        scale = pixels / max(extent.real, extent.imag)
        size = max(1, round(extent.real * scale)), max(1, round(extent.imag * scale))
        target = RenderTarget(self._renderer.programs, size, FINER)
        triangles = shape.domain.mesh.triangles
        mesh = self._mesh(shape).pose(VertexArray(positions=positions, triangles=triangles))
        view = fit_view(box.lower, box.upper, size)
        self._renderer.draw(target, view, Scene(meshes=(mesh,)))
        picture = target.read_straight_rgba()
        target.release()
        return picture

    def _mesh(self, shape: Shape) -> DrawnMesh:
        if shape not in self._drawn:
            mesh = shape.domain.mesh
            picture = GpuPicture(self._context, shape.picture)
            gpu = GpuMesh(
                self._renderer.programs, picture, rest=mesh.vertices, triangles=mesh.triangles
            )
            self._drawn[shape] = DrawnMesh(gpu, by_shader=False)
            for owned in (picture, gpu, self._drawn[shape]):
                self._owned.callback(owned.release)
        return self._drawn[shape]


def same_scale(boxes: Sequence[BoundingBox]) -> list[BoundingBox]:
    """Return boxes about the same middles, all as large as the largest in each direction."""
    extents = [box.upper - box.lower for box in boxes]
    half = complex(max(e.real for e in extents), max(e.imag for e in extents)) / 2
    middles = [(box.upper + box.lower) / 2 for box in boxes]
    return [BoundingBox(middle - half, middle + half) for middle in middles]


def bounds_of(*positions: Complexes) -> BoundingBox:
    """Return a box around all given points, with a small margin."""
    box = bounding_box(positions[0])
    for more in positions[1:]:
        box = box.joined(bounding_box(more))
    extent = box.upper - box.lower
    room = MARGIN * max(extent.real, extent.imag) * (1 + 1j)
    return BoundingBox(box.lower - room, box.upper + room)
