"""The picture at rest while it is cut out. A veil covers the removed parts.

A veil of another colour covers kept parts that look like the background. On paper of the same
colour they would be invisible.
"""

import math

import numpy as np

from app.editor import Project
from app.render import Disc, Renderer
from app.render.gpu.mesh import GpuMesh, PosedMesh, PositionBuffer, to_float32_points
from app.render.gpu.picture import GpuPicture
from app.storage import CutOutResult
from app.ui.style.theme import Palette
from app.ui.viewport.marks import to_rgba
from engine.arrays import Bytes, Complexes, Integers

VEIL, LEFTOVER = (214, 48, 72, 150), (40, 110, 240, 150)
FINEST = 1024  # pixels of the veil's longer side
HOLE = 7.0  # pixels: radius of the mark in a hole
SQUARE: Integers = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)


class _Sheet:
    """Owner of a picture on two triangles."""

    def __init__(self, renderer: Renderer, pixels: Bytes, corners: Complexes) -> None:
        programs = renderer.programs
        self._picture = GpuPicture(programs.context, pixels)
        rest = _corners(*self._picture.size)
        self._mesh = GpuMesh(programs, self._picture, rest=rest, triangles=SQUARE)
        places = PositionBuffer(programs.context, len(rest))
        places.write(to_float32_points(corners))
        self.pose = PosedMesh(self._mesh, places)

    def write(self, pixels: Bytes) -> None:
        self._picture.write(pixels)

    def release(self) -> None:
        for owner in (self.pose, self._mesh, self._picture):
            owner.release()


class CutView:
    """Owner of the GPU objects of a layer while it is cut out.

    Attributes
    ----------
    runtime : LayerRuntime
        The layer's runtime when the view was made.
    """

    def __init__(self, renderer: Renderer, project: Project, layer: int) -> None:
        self.runtime = project.runtimes.layers[layer]
        self._cut = self.runtime.cut.value
        picture = self.runtime.picture
        corners = project.document.layer(layer).corner + _corners(*picture.size)
        self._sheet = _Sheet(renderer, picture.rgba, corners)
        self._veil = _Sheet(renderer, _veil(self._cut), corners)

    def meshes(self) -> tuple[PosedMesh, ...]:
        """Return the picture, and the veil over its removed parts."""
        cut = self.runtime.cut.value
        if cut is not self._cut:
            self._cut = cut
            self._veil.write(_veil(cut))
        return (self._sheet.pose, self._veil.pose)

    def release(self) -> None:
        self._sheet.release()
        self._veil.release()


def mark_holes(project: Project, palette: Palette, scale: float) -> tuple[Disc, ...]:
    """Return a mark for each hole: a ring if it stays open, a disc if it is filled."""
    layer, holes = project.layer, project.layer_runtime.cut.value.holes
    if holes is None:
        return ()
    swapped = {holes.number_at(point) for point in layer.cut_out.toggled_holes}
    return tuple(
        Disc(
            centre=middle + layer.corner,
            radius=HOLE * scale,
            fill=to_rgba(
                palette.accent
                if (layer.cut_out.holes == "fill" or number in holes.shut) != (number in swapped)
                else palette.panel
            ),
            rim=to_rgba(palette.text),
            rim_width=2.0 * scale,
        )
        for number, middle in holes.middles.items()
    )


def _corners(width: float, height: float) -> Complexes:
    return np.array([0, width, width + 1j * height, 1j * height])


def _veil(cut: CutOutResult) -> Bytes:
    step = math.ceil(max(cut.mask.size) / FINEST)
    kept = cut.kept[::step, ::step]
    veil = np.zeros((*kept.shape, 4), dtype=np.uint8)
    veil[~kept] = VEIL
    if cut.background_like is not None:
        veil[cut.background_like[::step, ::step]] = LEFTOVER
    return veil
