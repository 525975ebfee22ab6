"""Small pictures of the poses in a figure's library."""

from collections.abc import Callable

from app.document import Pose
from app.editor import Project, Session
from app.motion import Placed, PosableMesh, box_around
from app.render import Backdrop, DrawnMesh, Renderer, Scene, fit_view
from app.render.gpu import RenderTarget
from app.ui.style import PALETTES
from app.ui.viewport.marks import plain

MARGIN = 0.06  # of the side, left free around the shape


class PosePictures:
    """Owner of one small texture for each pose that was asked for."""

    def __init__(self, renderer: Renderer) -> None:
        self._renderer = renderer
        self._targets: dict[Pose, RenderTarget] = {}
        self._wanted: set[Pose] = set()
        # Of all that is drawn: the figure's mesh, how large, and in which theme.
        self._kind: tuple[object, ...] = ()
        self._side = 1

    def get(self, pose: Pose, side: int) -> int | None:
        """Return the texture of a pose, so many pixels wide and high; None before it is drawn."""
        self._wanted.add(pose)
        self._side = side
        target = self._targets.get(pose)
        return None if target is None else target.texture.glo

    def draw(
        self, session: Session, project: Project, posable: Callable[[PosableMesh], DrawnMesh]
    ) -> None:
        """Draw what was asked for in this frame, and let all else go.

        From `posable` comes a mesh on the graphics card that can be posed.
        """
        mesh = project.puppet.store.mesh
        kind = (mesh, self._side, session.preferences.theme)
        if kind != self._kind:
            self.release()
            self._kind = kind
        for pose in self._targets.keys() - self._wanted:
            self._targets.pop(pose).release()
        known = set(project.figure.poses) & self._wanted
        for pose in known - self._targets.keys():
            positions = mesh.posed(pose)
            vertices = Placed(positions=positions, triangles=mesh.domain.mesh.triangles)
            size = (self._side, self._side)
            view = fit_view(*box_around(positions), size, margin=MARGIN * self._side)
            desk = plain(PALETTES[session.preferences.theme].desk)
            meshes = (posable(mesh).pose(vertices),)
            target = RenderTarget(self._renderer.programs, size)
            self._renderer.draw(
                target, view, Scene(background=Backdrop(colour=desk), meshes=meshes)
            )
            self._targets[pose] = target
        self._wanted.clear()

    def release(self) -> None:
        """Let the textures go; poses that are asked for again are drawn again."""
        for target in self._targets.values():
            target.release()
        self._targets.clear()
        self._kind = ()
