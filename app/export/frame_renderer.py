"""The pictures of an export, drawn by the same renderer as the window."""

import math
from collections.abc import Generator, Mapping
from contextlib import ExitStack, suppress
from functools import partial
from typing import Final, NamedTuple

import numpy as np

from app.document import Document, camera_at, is_visible
from app.errors import EXPECTED_ERRORS, LissomError
from app.export.decimation import MeshDecimator
from app.export.framing import find_shown_box, split_into_tiles
from app.export.plan import ExportPlan
from app.export.run import export_frames
from app.motion import Evaluator, SceneFrame, VertexArray, bounding_box
from app.render import (
    TRANSPARENT,
    Backdrop,
    Colour,
    DrawnMesh,
    MemberMesh,
    Renderer,
    Scene,
    View,
)
from app.render.gpu.context import Context, GlError, is_software, largest_size
from app.render.gpu.mesh import GpuMesh
from app.render.gpu.picture import GpuPicture
from app.render.gpu.target import RenderTarget
from app.storage import Cancellation, FootagePictures
from app.texts import _, message_of
from engine.arrays import Bytes
from engine.domain import find_closed_cuts
from engine.domain.meshing.mesh import Mesh
from engine.geometry import IDENTITY_MOTION, Similarity

_SMALL: Final = 0.75  # frame pixels per picture pixel
_TILE: Final = 4096  # pixels each way drawn at once, at most
_MANY: Final = 24  # frames from which on decimation pays
_LOOKS: Final = 9  # frames examined for decimation
_TINY: Final = 16.0  # square pixels; a smaller triangle costs more than its pixels
_NO_ERROR: Final = "GL_NO_ERROR"
_OUTSIDE: Final = 1.0  # pixels; nobody sees less than this


class PosedFrame(NamedTuple):
    """A frame of the timeline, and the posed vertices of its visible layers."""

    scene: SceneFrame
    vertices: Mapping[int, VertexArray]  # by layer id, in the plane
    camera: Similarity  # moves the camera's view onto the canvas
    footage: Mapping[int, Bytes]  # pictures of footage, by layer id


class FrameRenderer:
    """Owner of the renderer and targets for an export's frames.

    Parameters
    ----------
    context : Context
        Current on the drawing thread.
    pictures : mapping of int to uint8, shape (h, w, 4)
        Decoded pictures by layer id.
    evaluator : Evaluator
        Of the document's frames.

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
        evaluator: Evaluator,
        plan: ExportPlan,
    ) -> None:
        self._context, self._document, self._plan = context, document, plan
        layers = document.exported_layers
        self._evaluator, self._layers = evaluator, [layer.id for layer in layers]
        self._background = Backdrop(colour=_colour(plan))
        shots = [camera_at(document, frame) for frame in plan.times]
        zooms = [1.0 if shot is None else shot.zoom for shot in shots]
        smallest, largest = min(zooms) * plan.view.scale, max(zooms) * plan.view.scale
        bent = {layer.id: document.deform_layer(layer) for layer in layers}
        meshes = [bent[layer.id].domain.mesh for layer in layers]
        self._thinnings = {
            layer.id: MeshDecimator(layer.domain, largest)
            for layer, mesh in zip(bent.values(), meshes, strict=True)
            if _pays(plan, mesh, context, largest)
        }
        looks = np.linspace(0, len(plan.times) - 1, _LOOKS).round().astype(int)
        self._looks = tuple(plan.times[index] for index in looks)
        self._reach = bounding_box(np.concatenate([mesh.vertices for mesh in meshes]))
        # The mesh has a margin around the drawing, which may lie off the canvas from the start.
        self._room = find_shown_box(plan.view).joined(self._reach)
        self._footage = FootagePictures(document)
        with ExitStack() as owned:
            owned.callback(self._footage.close)
            self._renderer = Renderer(context)
            owned.callback(self._renderer.release)
            programs = self._renderer.programs
            # At its own size the drawing is exact with one sample a pixel. Much smaller, it is
            # finer with four.
            finer = 2 if smallest < _SMALL else 1
            self._tiles = split_into_tiles(plan.view, min(_TILE, largest_size(context) // finer))
            self._target = RenderTarget(programs, self._tiles[0].view.size, finer)
            owned.callback(self._target.release)
            # Earlier errors belong to a window, or to moderngl, which binds the previous
            # framebuffer even if it is deleted. A target without memory has raised by itself.
            while context.error != _NO_ERROR:
                pass
            self._drawn: dict[int, DrawnMesh | MemberMesh] = {}
            leaders: dict[int, DrawnMesh] = {}  # by the layer that bends them
            textures: dict[object, GpuPicture] = {}  # layers without footage may share one
            for layer, mesh in zip(layers, meshes, strict=True):
                rest = mesh.vertices - layer.corner
                shown = layer.footage and layer, id(pictures[layer.id])
                texture = textures.get(shown)
                if texture is None:
                    texture = textures[shown] = GpuPicture(context, pictures[layer.id])
                    owned.callback(texture.release)
                by = bent[layer.id]
                seam = find_closed_cuts(by.domain, by.cut_out.covered_lines(by.corner))
                gpu_mesh = GpuMesh(
                    programs, texture, rest=rest, triangles=mesh.triangles, seam=seam
                )
                owned.callback(gpu_mesh.release)
                if by.id in leaders:
                    self._drawn[layer.id] = MemberMesh(gpu_mesh, leaders[by.id])
                else:
                    leaders[by.id] = DrawnMesh(gpu_mesh, by_shader=False)
                    self._drawn[layer.id] = leaders[by.id]
                owned.callback(self._drawn[layer.id].release)
            self._owned = owned.pop_all()

    def pose(self, frame: float) -> PosedFrame:
        """Compute the vertices at a frame; on any thread, one frame at a time.

        Raises `LissomError` if the motion fails at this frame.
        """
        if self._looks:
            self._prepare_thinnings()
        try:
            scene = self._evaluate(frame)
            # Members of a deform group share their vertices.
            shown = {
                self._document.deform_layer(each.clip.layer).id: each
                for each in scene.layers.values()
            }
            places = {layer: each.scene_positions for layer, each in shown.items()}
            footage = self._footage.read_frame(scene.layers.keys(), frame)
        except EXPECTED_ERRORS as error:
            raise _failure(frame, message_of(error)) from error
        posed = {}
        for layer, positions in places.items():
            box = bounding_box(positions)
            if not np.isfinite(box).all():
                raise _failure(frame, _("some of its points are not finite"))
            self._reach = self._reach.joined(box)
            triangles, thinning = shown[layer].vertices.triangles, self._thinnings.get(layer)
            if thinning is not None:
                triangles = thinning.triangles(positions, triangles)
            posed[layer] = VertexArray(positions=positions, triangles=triangles)
        vertices = {
            layer: posed[self._document.deform_layer(each.clip.layer).id]
            for layer, each in scene.layers.items()
        }
        camera, canvas = scene.camera, self._document.canvas
        motion = IDENTITY_MOTION if camera is None else camera.canvas_motion(canvas)
        return PosedFrame(scene, vertices, motion, footage)

    def _evaluate(self, frame: float) -> SceneFrame:
        """Return a frame with the exported layers that are visible."""
        document = self._document
        seen = [i for i in self._layers if is_visible(document, document.layer(i), frame)]
        return self._evaluator.evaluate(document, frame, only=seen)

    def _prepare_thinnings(self) -> None:
        """Find decimated triangles that suit sampled frames of the whole motion."""
        looks, self._looks = self._looks, ()
        for layer, thinning in self._thinnings.items():
            # A failing frame raises its error when it is drawn.
            with suppress(*EXPECTED_ERRORS):
                evaluate = partial(
                    self._evaluator.evaluate, self._document, only=[layer], keep=True
                )
                scenes = [evaluate(frame) for frame in looks]
                thinning.prepare([each.layers[layer].scene_positions for each in scenes])

    def draw(self, posed: PosedFrame) -> Bytes:
        """Return the picture of a posed frame, uint8 (h, w, 4) with straight alpha.

        Raises `LissomError` if the frame cannot be drawn.
        """
        try:
            for layer, picture in posed.footage.items():
                self._drawn[layer].picture.write(picture)
            seen = {
                layer: self._drawn[layer].pose(vertices, placement=posed.camera)
                for layer, vertices in posed.vertices.items()
            }
            meshes = posed.scene.composite(seen)
            scene = Scene(background=self._background, meshes=meshes)
            pixels = _filled(self._plan.view.size, self._background.colour)
            for tile in self._tiles:
                self._renderer.draw(self._target, tile.view, scene)
                self._read(posed, tile.view, pixels[tile.top :, tile.left :])
        except (*EXPECTED_ERRORS, GlError) as error:
            raise _failure(posed.scene.frame, message_of(error)) from error
        # OpenGL continues after an error, with black or outdated pictures.
        if self._context.error != _NO_ERROR:
            raise _failure(posed.scene.frame, _("OpenGL failed; try again"))
        return pixels

    def _read(self, posed: PosedFrame, view: View, pixels: Bytes) -> None:
        """Read back the drawn part of a view; the rest has the background's colour.

        Only the box around the layers is read. `pixels` begin at the view's corner and may be
        smaller than the view.
        """
        height, width, _ = pixels.shape
        width, height = min(width, view.size[0]), min(height, view.size[1])
        if not posed.vertices:
            return
        vertices = np.concatenate(
            [each.positions for each in dict.fromkeys(posed.vertices.values())]
        )
        box = bounding_box(view.to_pixels(posed.camera.apply(vertices)))
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


def _failure(frame: float, reason: str) -> LissomError:
    return LissomError(
        _("frame {frame:g} cannot be drawn: {error}").format(frame=frame, error=reason)
    )


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


def _colour(plan: ExportPlan) -> Colour:
    if plan.background is None:
        return TRANSPARENT
    red, green, blue = (level / 255 for level in plan.background)
    return red, green, blue, 1.0
