"""Thumbnails of the poses in layers' libraries."""

from collections.abc import Callable

from app.document import Pose
from app.editor import Project, Session
from app.motion import DeformMesh, VertexArray, bounding_box
from app.render import Backdrop, DrawnMesh, MemberMesh, Renderer, Scene, fit_view
from app.render.gpu.target import RenderTarget
from app.ui.style.theme import PALETTES
from app.ui.viewport.marks import to_rgba

MARGIN = 0.06  # share of the side, left free around the shape


class PosePictures:
    """Owner of a small texture for each requested pose, by layer and pose id."""

    def __init__(self, renderer: Renderer) -> None:
        self._renderer = renderer
        self._targets: dict[tuple[int, Pose], RenderTarget] = {}
        self._wanted: set[tuple[int, Pose]] = set()
        # Inputs of all thumbnails: the layers' meshes, the size, and the theme.
        self._kind: tuple[object, ...] = ()
        self._side = 1

    def get(self, layer: int, pose: Pose, side: int) -> int | None:
        """Return the texture of a pose; None before it is drawn.

        It is at least `side` pixels wide and high.
        """
        self._wanted.add((layer, pose))
        self._side = max(self._side, side)
        target = self._targets.get((layer, pose))
        return None if target is None else target.texture.glo

    def draw(
        self,
        session: Session,
        project: Project,
        posable: Callable[[int, DeformMesh], DrawnMesh | MemberMesh],
    ) -> None:
        """Draw the poses requested in this frame, and release the others.

        `posable` returns a layer's mesh on the graphics card that can be posed.
        """
        meshes = {
            layer: project.runtimes.layers[layer].store.mesh
            for layer, _ in self._wanted
            if layer in project.runtimes.layers
        }
        kind = (meshes, self._side, session.settings.preferences.theme)
        if kind != self._kind:
            self.release()
            self._kind = kind
        for each in self._targets.keys() - self._wanted:
            self._targets.pop(each).release()
        desk = Backdrop(colour=to_rgba(PALETTES[session.settings.preferences.theme].desk))
        for layer, pose in self._wanted - self._targets.keys():
            if layer not in meshes or pose not in project.document.layer(layer).poses:
                continue
            mesh = meshes[layer]
            # The mesh of a new outline may come in the next frame.
            if mesh.source is not project.document.layer(layer).domain:
                continue
            positions = mesh.pose_vertices(pose)
            vertices = VertexArray(positions=positions, triangles=mesh.domain.mesh.triangles)
            size = (self._side, self._side)
            view = fit_view(*bounding_box(positions), size, margin=MARGIN * self._side)
            target = RenderTarget(self._renderer.programs, size)
            scene = Scene(background=desk, meshes=(posable(layer, mesh).pose(vertices),))
            self._renderer.draw(target, view, scene)
            self._targets[layer, pose] = target
        self._wanted.clear()
        self._side = 1

    def release(self) -> None:
        """Release the textures. Requested poses are drawn again."""
        for target in self._targets.values():
            target.release()
        self._targets.clear()
        self._kind = ()
