"""The viewport's picture: the drawing, its ghosts, and all overlays of the renderer."""

from dataclasses import replace
from functools import partial

import numpy as np

from app.editor import HeatMap, LayerRuntime, Project, Session
from app.motion import DeformMesh, LayerFrame, SceneFrame
from app.render import Heat, Painted, Renderer, Scene, Wireframe
from app.render.gpu.target import RenderTarget
from app.ui.style.theme import PALETTES
from app.ui.viewport.backdrop import make_backdrop
from app.ui.viewport.cutout_overlay import mark_holes
from app.ui.viewport.marks import clear_mark_caches, mark_all, pixel_scale, to_rgba
from app.ui.viewport.picture.gpu_resources import GpuResources
from app.ui.viewport.picture.onion_skin import count_meshes_behind, make_ghosts
from app.ui.viewport.picture.pose_thumbnails import PosePictures
from engine.arrays import Floats

# One picture poses a mesh several times. The copies are numbered: 0 is the drawing, ghosts count
# from 1, the compared method and the library's thumbnails have their own numbers.
COMPARISON, SMALL_PICTURE = -2, -1


class Canvas:
    """Owner of all GPU objects of the viewport's picture."""

    def __init__(self, renderer: Renderer) -> None:
        self._renderer = renderer
        self._targets: list[RenderTarget] = []
        self._retired: list[RenderTarget] = []
        self.resources: GpuResources | None = None
        self._drawn: tuple[object, ...] = ()
        self.pose_pictures = PosePictures(renderer)

    @property
    def texture(self) -> int | None:
        """OpenGL's name of the picture; None before the first picture."""
        return self._targets[0].texture.glo if self._targets else None

    @property
    def comparison_texture(self) -> int | None:
        """OpenGL's name of the compared method's picture; None if the viewport is not split."""
        return self._targets[1].texture.glo if len(self._targets) > 1 else None

    def release_others(self, project: Project | None) -> bool:
        """Release every other project. Return whether there was one."""
        if self.resources is None or self.resources.project is project:
            return False
        self._forget_drawing()
        return True

    def draw(self, session: Session, *, paints: bool = True) -> None:
        """Draw the session's project as it is shown now; without `paints`, at a later call."""
        project = session.project
        if project is None or project.layer_runtime.shown is None:
            self.pose_pictures.release()
            return
        comparisons = [runtime.comparison for runtime in project.runtimes.layers.values()]
        is_split = all(each is not None and each.shown is not None for each in comparisons)
        is_split &= not session.tools.is_cutting
        self._fit_targets(session.display.screen, 1 + is_split)
        if self.resources is None:
            self.resources = GpuResources(self._renderer, project)
        posable = partial(self.resources.drawn_mesh, number=SMALL_PICTURE)
        self.pose_pictures.draw(session, project, posable)
        inputs = _inputs(session, project)
        if paints and inputs != self._drawn:
            view = project.view_on(session.display.screen)
            scene = _scene(session, project, project.layer_runtime.shown, self.resources)
            self._renderer.draw(self._targets[0], view, scene)
            if is_split:
                comparison = _comparison_scene(session, project, scene, self.resources)
                self._renderer.draw(self._targets[1], view, comparison)
            self._drawn = inputs

    def release(self) -> None:
        self.pose_pictures.release()
        self._forget_drawing()
        for target in (*self._targets, *self._retired):
            target.release()
        self._targets, self._retired = [], []

    def _fit_targets(self, size: tuple[int, int], count: int) -> None:
        if len(self._targets) == count and self._targets[0].size == size:
            return
        # ImGui may still show the last textures in this frame.
        for target in self._retired:
            target.release()
        self._retired = self._targets
        self._targets = [RenderTarget(self._renderer.programs, size) for _ in range(count)]
        self._drawn = ()

    def _forget_drawing(self) -> None:
        if self.resources is not None:
            self.resources.release()
            self.resources = None
            self._drawn = ()
            clear_mark_caches()


def _inputs(session: Session, project: Project) -> tuple[object, ...]:
    """Return all inputs of the picture. While they are equal, the picture is unchanged."""
    return (
        *[runtime.shown for runtime in project.runtimes.layers.values()],
        *[runtime.cut.value for runtime in project.runtimes.layers.values()],
        *[
            runtime.comparison.shown
            for runtime in project.runtimes.layers.values()
            if runtime.comparison
        ],
        *[
            runtime.store.whole
            for runtime in project.runtimes.layers.values()
            if session.display.overlays.onion
        ],
        project.layer_runtime.store.sampler,
        project.measured.paths.value if session.display.overlays.paths else None,
        project.measured.parent_transforms.value,
        project.visible_drag.targets if project.visible_drag else None,
        project.selected_track,
        project.layer_runtime.corrected.count_grounds if project.layer_runtime.corrected else 0,
        project.timeline.recording,
        len(project.timeline.recording.samples) if project.timeline.recording else 0,
        project.selection.active,
        project.selection.handles,
        project.view_on(session.display.screen),
        project.timeline.playhead.since is None,
        session.tools.hovered,
        session.tools.mode,
        project.layer.cut_out if session.tools.is_cutting else None,
        session.display.tint,
        project.document.layers,
        project.document.groups,
        project.document.switch_groups,
        project.layer_list.solo,
        project.footage.arrivals,
        session.display.overlays,
        session.export.frame_box,
        session.settings.preferences,
        pixel_scale(session),
    )


def heat_limits(project: Project, heat_map: HeatMap) -> tuple[float, float]:
    """Return the values at the two ends of the heat map: no distortion, and the limit."""
    bounds = project.layer.bounds
    match heat_map:
        case "sigma_a":
            return 1.0, bounds.sigma_a
        case "sigma_b":
            return 1.0, bounds.sigma_b
        case _:
            return 0.0, bounds.k


def _scene(session: Session, project: Project, shown: LayerFrame, drawing: GpuResources) -> Scene:
    palette = PALETTES[session.settings.preferences.theme]
    overlays = session.display.overlays
    runtimes = project.runtimes.layers.values()
    drawing.release_but({mesh for runtime in runtimes for mesh in _meshes(runtime)})
    drawing.refresh()
    if session.tools.is_cutting:
        scale = pixel_scale(session)
        return Scene(
            background=make_backdrop(
                session.settings.preferences.backdrop, palette, drawing.edge, scale
            ),
            meshes=drawing.cut_view().meshes(),
            discs=mark_holes(project, palette, scale) if session.tools.mode == "holes" else (),
        )
    heat = None
    if session.display.tint is not None:
        heat = Heat(low=-1.0, high=1.0, contours=0, strength=0.6, two_sided=True)
    elif overlays.heat_map != "none":
        low, high = heat_limits(project, overlays.heat_map)
        heat = Heat(low=low, high=high)
    wireframe = Wireframe(colour=to_rgba(palette.text, 0.35)) if overlays.wireframe else None
    lines, discs = mark_all(session, project, shown, palette)
    meshes = _posed(session, project, project.runtimes.displayed, drawing)
    return Scene(
        background=make_backdrop(
            session.settings.preferences.backdrop, palette, drawing.edge, pixel_scale(session)
        ),
        meshes=meshes,
        heat=heat,
        wireframe=wireframe,
        ghosts=make_ghosts(session, project, drawing) if overlays.onion else (),
        ghosts_over=count_meshes_behind(session, project, len(meshes)) if overlays.onion else 0,
        lines=lines,
        discs=discs,
    )


def _comparison_scene(
    session: Session, project: Project, scene: Scene, drawing: GpuResources
) -> Scene:
    """Return the scene by the compared method, without ghosts."""
    meshes = _posed(session, project, project.runtimes.compared, drawing, number=COMPARISON)
    comparison = replace(scene, meshes=meshes, ghosts=())
    # Handles are at the positions of the drawing's own method. Beside it they would be wrong.
    is_beside = (
        session.display.compare_view is not None and session.display.compare_view.is_side_by_side
    )
    return replace(comparison, lines=(), discs=()) if is_beside else comparison


def _posed(
    session: Session,
    project: Project,
    frame: SceneFrame | None,
    drawing: GpuResources,
    *,
    number: int = 0,
) -> tuple[Painted, ...]:
    """Return the visible layers of a frame, from back to front."""
    if frame is None:
        return ()
    heat_map, solo, poses = session.display.overlays.heat_map, project.layer_list.solo, {}
    scene = frame.alone(solo) if solo else frame
    for layer, shown in scene.visible_layers.items():
        poses[layer] = drawing.drawn_mesh(layer, shown.mesh, number).pose(
            shown.vertices, placement=shown.placement
        )
        if session.display.tint is not None:
            drawing.tint(poses[layer], _tinted(session, project, drawing, shown))
        elif heat_map != "none":
            drawing.heat(poses[layer], shown, heat_map)
    return scene.composite(poses)


def _tinted(session: Session, project: Project, drawing: GpuResources, shown: LayerFrame) -> Floats:
    """Return the colour values of a layer's vertices, (v,), −1 to 1."""
    layer = shown.clip.layer
    if layer.id != project.selection.active:
        return np.zeros(len(shown.positions))
    if session.display.tint == "stiffness":
        return drawing.stiffness(layer, shown.mesh)
    return shown.mesh.order.depths(shown.clip, shown.frame)


def _meshes(runtime: LayerRuntime) -> set[DeformMesh]:
    """Return the meshes of a layer that are shown now or may be shown soon."""
    meshes = {store.mesh for store in (runtime.store, runtime.fine) if store is not None}
    comparison = runtime.comparison
    shows = (runtime.shown, None if comparison is None else comparison.shown)
    return meshes | {shown.mesh for shown in shows if shown is not None}
