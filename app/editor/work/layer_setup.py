"""Unfinished changes of a layer's cut-out, mesh and limits."""

from dataclasses import dataclass

from app.document import Layer, Meshing
from app.editor.work.revised import Revised
from engine.maps import Bounds


@dataclass(slots=True, kw_only=True, eq=False)
class LayerSetup(Revised):
    """What the next rebuild of a mesh uses, and the layer that waits for it."""

    meshing: Meshing | None = None  # of the next rebuild; None if it is the present meshing
    previewed_limits: Bounds | None = None  # limits during a drag of their knob
    # The layer with a domain older than its cut-out, and the clock's seconds when this was seen.
    stale: tuple[Layer, float] | None = None
    unbuildable: Layer | None = None  # a layer whose cut-out gives no domain
    brush: float | None = None  # radius in pixels of the picture; None before it is set

    def preview_meshing(self, meshing: Meshing | None) -> None:
        """Note the meshing that the next rebuild of the mesh uses."""
        self.meshing = meshing

    def preview_limits(self, limits: Bounds | None) -> None:
        self.previewed_limits = limits

    def forget_previews(self) -> None:
        """Forget the meshing and limits of a layer that is not active any more."""
        self.meshing = self.previewed_limits = None

    def note_stale(self, layer: Layer | None, now: float) -> float:
        """Note the layer that will be rebuilt, if any, and return for how long it has waited."""
        if layer is None:
            self.stale = None
        elif self.stale is None or self.stale[0] is not layer:
            self.stale = layer, now
        return 0.0 if self.stale is None else now - self.stale[1]

    def refuse(self, layer: Layer) -> None:
        """Note that the cut-out of a layer gives no domain; it is not tried again."""
        self.unbuildable = layer

    def set_brush(self, radius: float) -> None:
        self.brush = radius
