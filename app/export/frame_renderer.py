"""The pictures of an export, drawn by the same renderer as the window."""

import math
from collections.abc import Generator, Mapping
from contextlib import ExitStack, suppress
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from app.document import Document, camera_at, clip_of, composite_layers, is_visible
from app.errors import EXPECTED_ERRORS, LissomError
from app.export.decimation import MeshDecimator
from app.export.frame_vertices import CachedVertices
from app.export.framing import find_shown_box
from app.export.plan import ExportPlan
from app.export.run import export_frames
from app.motion import TriangleOrder, VertexArray, bounding_box
from app.render import TRANSPARENT, Backdrop, Colour, DrawnMesh, Renderer, Scene, View
from app.render.gpu.context import Context, GlError, is_software, largest_size
from app.render.gpu.mesh import GpuMesh
from app.render.gpu.picture import GpuPicture
from app.render.gpu.target import RenderTarget
from app.storage import Cancellation
from app.texts import _, message_of
from engine.arrays import Bytes
from engine.domain import find_closed_cuts
from engine.domain.meshing.mesh import Mesh
from engine.geometry import IDENTITY_MOTION, Similarity

_SMALL: Final = 0.75  # frame pixels per picture pixel
_TILE: Final = 4096  # pixels each way drawn at once, at most
_MOST_PIXELS: Final = 2**28  # pixels of a frame: a gigabyte
_MANY: Final = 24  # frames from which on decimation pays
_LOOKS: Final = 9  # frames examined for decimation
_TINY: Final = 16.0  # square pixels; a smaller triangle costs more than its pixels
_NO_ERROR: Final = "GL_NO_ERROR"
_OUTSIDE: Final = 1.0  # pixels; nobody sees less than this


class PosedFrame(NamedTuple):
    """A frame of the timeline, and the posed vertices of each layer."""

    frame: float
    vertices: tuple[VertexArray, ...]  # in the plane
    camera: Similarity | None  # moves the camera's view onto the canvas


class _Tile(NamedTuple):
    """A part of a frame that is drawn at once, and its upper left corner."""

    view: View
    left: int
    top: int


class FrameRenderer:
    """Owner of the renderer and targets for an export's frames.

    Parameters
    ----------
    context : Context
        Current on the drawing thread.
    pictures : mapping of int to uint8, shape (h, w, 4)
        Decoded pictures by layer id.
    poses : mapping of int to CachedVertices
        By layer id.

    Raises
    ------
    LissomError
        If the picture or the frames are too large for the context.
    """

    def __init__(
        self,
        context: Context,
        document: Document,
        pictures: Mapping[int, Bytes],
        poses: Mapping[int, CachedVertices],
        plan: ExportPlan,
    ) -> None:
        self._context, self._document, self._plan = context, document, plan
        layers = document.exported_layers
        self._clips = [clip_of(document, layer.id) for layer in layers]
        self._poses = [poses[layer.id] for layer in layers]
        self._background = Backdrop(colour=_colour(plan))
        shots = [camera_at(document, frame) for frame in plan.times]
        zooms = [1.0 if shot is None else shot.zoom for shot in shots]
        smallest, largest = min(zooms) * plan.view.scale, max(zooms) * plan.view.scale
        meshes = [layer.domain.mesh for layer in layers]
        self._orders = [TriangleOrder(mesh) for mesh in meshes]
        self._thinnings = [
            MeshDecimator(layer.domain, largest) if _pays(plan, mesh, context, largest) else None
            for layer, mesh in zip(layers, meshes, strict=True)
        ]
        looks = np.linspace(0, len(plan.times) - 1, _LOOKS).round().astype(int)
        self._looks = tuple(plan.times[index] for index in looks)
        self._reach = bounding_box(np.concatenate([mesh.vertices for mesh in meshes]))
        # The mesh has a margin around the drawing, which may lie off the canvas from the start.
        self._room = find_shown_box(plan.view).joined(self._reach)
        with ExitStack() as owned:
            self._renderer = Renderer(context)
            owned.callback(self._renderer.release)
            programs = self._renderer.programs
            # At its own size the drawing is exact with one sample a pixel. Much smaller, it is
            # finer with four.
            finer = 2 if smallest < _SMALL else 1
            self._tiles = _tiles(plan.view, min(_TILE, largest_size(context) // finer))
            self._target = RenderTarget(programs, self._tiles[0].view.size, finer)
            owned.callback(self._target.release)
            # Earlier errors belong to a window, or to moderngl, which binds the previous
            # framebuffer even if it is deleted. A target without memory has raised by itself.
            while context.error != _NO_ERROR:
                pass
            self._drawn = []
            textures: dict[int, GpuPicture] = {}  # by picture; layers may share one
            for layer, mesh in zip(layers, meshes, strict=True):
                rest = mesh.vertices - layer.corner
                texture = textures.get(id(pictures[layer.id]))
                if texture is None:
                    texture = GpuPicture(context, pictures[layer.id])
                    textures[id(pictures[layer.id])] = texture
                    owned.callback(texture.release)
                seam = find_closed_cuts(layer.domain)
                gpu_mesh = GpuMesh(
                    programs, texture, rest=rest, triangles=mesh.triangles, seam=seam
                )
                owned.callback(gpu_mesh.release)
                self._drawn.append(DrawnMesh(gpu_mesh, by_shader=False))
                owned.callback(self._drawn[-1].release)
            self._owned = owned.pop_all()

    def pose(self, frame: float) -> PosedFrame:
        """Compute the vertices at a frame; on any thread, one frame at a time.

        Raises `LissomError` if the motion fails at this frame.
        """
        if self._looks:
            self._prepare_thinnings()
        try:
            positions = [poses.positions(frame) for poses in self._poses]
        except EXPECTED_ERRORS as error:
            raise LissomError(
                _("frame {frame:g} cannot be drawn: {error}").format(
                    frame=frame, error=message_of(error)
                )
            ) from error
        box = bounding_box(np.concatenate(positions))
        if not np.isfinite(box).all():
            raise LissomError(
                _("frame {frame:g} cannot be drawn: some of its points are not finite").format(
                    frame=frame
                )
            )
        self._reach = self._reach.joined(box)
        vertices = []
        layers = zip(positions, self._clips, self._orders, self._thinnings, strict=True)
        for places, clip, order, thinning in layers:
            triangles = order.triangles(clip, frame)
            if thinning is not None:
                triangles = thinning.triangles(places, triangles)
            vertices.append(VertexArray(positions=places, triangles=triangles))
        shot = camera_at(self._document, frame)
        camera = None if shot is None else shot.canvas_motion(self._document.canvas)
        return PosedFrame(frame, tuple(vertices), camera)

    def _prepare_thinnings(self) -> None:
        """Find decimated triangles that suit sampled frames of the whole motion."""
        looks, self._looks = self._looks, ()
        for poses, thinning in zip(self._poses, self._thinnings, strict=True):
            # A failing frame raises its error when it is drawn.
            with suppress(*EXPECTED_ERRORS):
                if thinning is not None:
                    thinning.prepare([poses.cache_positions(frame) for frame in looks])

    def draw(self, posed: PosedFrame) -> Bytes:
        """Return the picture of a posed frame, uint8 (h, w, 4) with straight alpha.

        Raises `LissomError` if the frame cannot be drawn.
        """
        try:
            drawn = zip(self._drawn, posed.vertices, self._clips, strict=True)
            seen = {
                clip.layer.id: mesh.pose(vertices, placement=posed.camera or IDENTITY_MOTION)
                for mesh, vertices, clip in drawn
                if is_visible(self._document, clip.layer, posed.frame)
            }
            meshes = composite_layers(self._document, seen, posed.frame)
            scene = Scene(background=self._background, meshes=meshes)
            pixels = _filled(self._plan.view.size, self._background.colour)
            for tile in self._tiles:
                self._renderer.draw(self._target, tile.view, scene)
                self._read(posed, tile.view, pixels[tile.top :, tile.left :])
        except (*EXPECTED_ERRORS, GlError) as error:
            raise LissomError(
                _("frame {frame:g} cannot be drawn: {error}").format(
                    frame=posed.frame, error=message_of(error)
                )
            ) from error
        # OpenGL continues after an error, with black or outdated pictures.
        if self._context.error != _NO_ERROR:
            raise LissomError(
                _("frame {frame:g} cannot be drawn: OpenGL failed; try again").format(
                    frame=posed.frame
                )
            )
        return pixels

    def _read(self, posed: PosedFrame, view: View, pixels: Bytes) -> None:
        """Read back the drawn part of a view; the rest has the background's colour.

        Only the box around the layers is read. `pixels` begin at the view's corner and may be
        smaller than the view.
        """
        height, width, _ = pixels.shape
        width, height = min(width, view.size[0]), min(height, view.size[1])
        vertices = np.concatenate([placed.positions for placed in posed.vertices])
        box = bounding_box(view.to_pixels((posed.camera or IDENTITY_MOTION).apply(vertices)))
        # Two more pixels: no touched pixel is left out.
        left, top = (max(0, math.floor(side) - 2) for side in _sides(box.lower))
        right, bottom = (math.ceil(side) + 2 for side in _sides(box.upper))
        right, bottom = min(width, right), min(height, bottom)
        if left < right and top < bottom:
            part = (left, top, right - left, bottom - top)
            pixels[top:bottom, left:right] = self._target.read_straight_rgba(part)

    def run(
        self, *, waits: bool = True, cancellation: Cancellation | None = None
    ) -> Generator[int]:
        """Run the plan one frame a step, as `export_frames` does."""
        return export_frames(
            self._plan, self.pose, self.draw, waits=waits, cancellation=cancellation
        )

    @property
    def notices(self) -> tuple[str, ...]:
        # A camera crops on purpose.
        if self._document.camera or self._room.contains(self._reach, slack=_OUTSIDE):
            return ()
        return (_("the motion leaves the frame; the framing 'fit' shows all of the motion"),)

    def release(self) -> None:
        self._owned.close()


def _pays(plan: ExportPlan, mesh: Mesh, context: Context, scale: float) -> bool:
    """Return whether decimation saves more time than it takes.

    `scale` is the largest number of frame pixels per unit of the plane.
    """
    area = mesh.areas().mean() * scale**2
    return len(plan.times) >= _MANY and bool(area < _TINY) and is_software(context)


def _filled(size: tuple[int, int], colour: Colour) -> Bytes:
    """Return pixels (h, w, 4) of one colour."""
    width, height = size
    pixel = np.rint(255 * np.array(colour)).astype(np.uint8)
    # Four bytes at a time: many times faster than single bytes.
    pixels = np.full((height, width), pixel.view(np.uint32)[0])
    return pixels.view(np.uint8).reshape(height, width, 4)


def _sides(corner: complex) -> tuple[float, float]:
    return corner.real, corner.imag


def _tiles(view: View, side: int) -> list[_Tile]:
    """Divide a frame into equal tiles; the last ones may extend beyond it."""
    width, height = view.size
    if width * height > _MOST_PIXELS:
        raise LissomError(
            _(
                "a frame of {width} × {height} pixels is too large; a frame can have at most "
                "{most:,} pixels. Choose a smaller size"
            ).format(width=width, height=height, most=_MOST_PIXELS)
        )
    size = min(width, side), min(height, side)
    half = complex(*size) / 2
    return [
        _Tile(replace(view, centre=view.to_plane(complex(left, top) + half), size=size), left, top)
        for top in range(0, height, size[1])
        for left in range(0, width, size[0])
    ]


def _colour(plan: ExportPlan) -> Colour:
    if plan.background is None:
        return TRANSPARENT
    red, green, blue = (level / 255 for level in plan.background)
    return red, green, blue, 1.0
