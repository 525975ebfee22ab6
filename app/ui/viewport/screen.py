"""The mapping between the drawing and the screen, and hit tests under the pointer."""

import numpy as np
from imgui_bundle import ImVec2, imgui

from app.editor import Project, Session
from app.editor.layering.layer_list import layer_at
from app.editor.tools.tool import PointerHit, scene_outlines
from app.motion import LayerFrame
from app.ui.style.theme import Look, pixel_density
from app.ui.viewport.marks import find_anchor
from engine.arrays import Complexes
from engine.geometry import contains

GRIP = 0.75  # em: radius within which a handle is grabbed


class ScreenMapping:
    """The active layer's picture in the viewport, from a corner of the screen.

    Places are in the layer's own coordinates, except where scene coordinates are mentioned.
    """

    def __init__(
        self, session: Session, project: Project, shown: LayerFrame, corner: ImVec2
    ) -> None:
        self.project = project
        self.shown = shown
        self.view = project.view_on(session.display.screen)
        self.density = pixel_density()
        self._corner = complex(corner.x, corner.y)

    @property
    def scale(self) -> float:
        """Pixels of the screen per pixel of the active layer."""
        return self.view.scale / self.density * abs(self.shown.placement.factor)

    @property
    def pointer(self) -> complex:
        """The pointer in the layer's coordinates."""
        return self.shown.placement.apply_inverse(self._in_scene)

    @property
    def pixel(self) -> complex:
        """The pixel of the view under the pointer."""
        pixel = (complex(*imgui.get_mouse_pos()) - self._corner) * self.density
        # In a picture beside it, the corresponding pixel.
        return complex(pixel.real % self.view.size[0], pixel.imag)

    @property
    def _in_scene(self) -> complex:
        pixel = (complex(*imgui.get_mouse_pos()) - self._corner) * self.density
        return self.view.to_plane(pixel)

    def point(self, place: complex) -> ImVec2:
        """Return the point of the screen at a place of the layer."""
        (point,) = self.points(self.shown.placement.apply(np.array([place])))
        return point

    def points(self, in_scene: Complexes) -> list[ImVec2]:
        """Return the points of the screen at places in scene coordinates."""
        pixels = self.view.to_pixels(in_scene) / self.density + self._corner
        return [ImVec2(pixel.real, pixel.imag) for pixel in pixels.tolist()]

    def hit_test(self, look: Look, handle: int | None, *, on_axis: bool) -> PointerHit:
        """Return the pointer's place and what is under it. The given items take precedence."""
        io, place = imgui.get_io(), self.pointer
        outline, *holes = scene_outlines(self.shown)
        return PointerHit(
            place=place,
            handle=handle,
            on_axis=on_axis,
            on_anchor=self._is_anchor(handle, place, GRIP * look.em / self.scale),
            on_shape=bool(contains(outline, np.array([self._in_scene]), holes=holes)[0]),
            layer=self._layer(through=io.key_alt),
            is_double=imgui.is_mouse_double_clicked(imgui.MouseButton_.left),
            ctrl=io.key_ctrl,
            shift=io.key_shift,
            alt=io.key_alt,
            em=look.em / self.scale,
        )

    def _layer(self, *, through: bool) -> int | None:
        """Return the layer under the pointer, or, `through` the active layer, the one behind."""
        if len(self.project.document.layers) == 1:
            return None
        below = self.project.selection.active if through else None
        return layer_at(self.project, self._in_scene, below=below)

    def _is_anchor(self, handle: int | None, place: complex, reach: float) -> bool:
        """Return whether the pointer is on the anchor. A single layer has no anchor to drag."""
        project, shown = self.project, self.shown
        if len(project.document.layers) == 1 or project.timeline.playhead.since is not None:
            return False
        if handle is not None:
            layer = shown.clip.layer
            return layer.anchor == layer.handle(handle).position
        anchor = find_anchor(project, shown)
        return anchor is not None and abs(anchor - place) <= reach
