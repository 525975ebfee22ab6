"""The pictures of an export, drawn by the renderer that the window draws with."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Final

from app.document import Document
from app.errors import EXPECTED_ERRORS, LissomError
from app.export.plan import ExportPlan, Poses
from app.export.run import Draw
from app.render import TRANSPARENT, Background, Colour, Renderer, Scene
from app.render.gpu import (
    Context,
    GlError,
    GpuMesh,
    GpuPicture,
    Pose,
    StreamedVertices,
    Target,
    singles,
)
from engine.arrays import Bytes

_SMALL: Final = 0.75  # pixels of the frame per pixel of the picture
_NO_ERROR: Final = "GL_NO_ERROR"


@contextmanager
def painter(
    context: Context, document: Document, picture: Bytes, poses: Poses, plan: ExportPlan
) -> Iterator[Draw]:
    """Lend a function that draws frames, for as long as a `with` block lasts.

    Parameters
    ----------
    context : Context
        Current on the thread that draws.
    document : Document
    picture : uint8, shape (h, w, 4)
        The document's picture, decoded.
    poses : Poses
        The document's.
    plan : ExportPlan

    Raises
    ------
    LissomError
        If the picture or the frames are too large for the context. The function raises it where a
        frame cannot be drawn.
    """
    mesh = document.domain.mesh
    with ExitStack() as owned:
        renderer = Renderer(context)
        owned.callback(renderer.release)
        # At its own size the drawing comes out exact from one sample a pixel; made much smaller it
        # is finer from four.
        target = Target(renderer.programs, plan.view.size, 2 if plan.view.scale < _SMALL else 1)
        owned.callback(target.release)
        # Errors up to here are a window's, or of moderngl, which binds the framebuffer of before
        # again though it may be gone. A target without memory has raised by itself.
        while context.error != _NO_ERROR:
            pass
        texture = GpuPicture(context, picture)
        owned.callback(texture.release)
        gpu_mesh = GpuMesh(renderer.programs, texture, rest=mesh.vertices, triangles=mesh.triangles)
        owned.callback(gpu_mesh.release)
        vertices = StreamedVertices(context, len(mesh.vertices))
        pose = Pose(gpu_mesh, vertices)
        owned.callback(pose.release)
        scene = Scene(background=Background(colour=_colour(plan)), pose=pose)

        def draw(frame: float) -> Bytes:
            try:
                vertices.write(singles(poses.positions(frame)))
                renderer.draw(target, plan.view, scene)
                pixels = target.read_straight_rgba()
            except (*EXPECTED_ERRORS, GlError) as error:
                raise LissomError(f"frame {frame:g} cannot be drawn: {error}") from error
            # OpenGL goes on after an error, with pictures that are black or of another frame.
            if context.error != _NO_ERROR:
                raise LissomError(f"frame {frame:g} cannot be drawn: OpenGL failed; try again")
            return pixels

        yield draw


def _colour(plan: ExportPlan) -> Colour:
    if plan.background is None:
        return TRANSPARENT
    red, green, blue = (level / 255 for level in plan.background)
    return red, green, blue, 1.0
