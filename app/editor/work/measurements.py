"""What is measured of the present document, on the worker."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.document import Clip
from app.editor.work.derived import Derived
from app.editor.work.revised import Revised
from app.motion import BoundingBox, MotionPaths, ParentTransforms
from app.reports import Curves
from app.sound import InspectedSound

EXTENTS = 32  # extents of the motion that are remembered for undo and redo


@dataclass(slots=True, kw_only=True, eq=False)
class Measurements(Revised):
    """Derived values of a project; an old value stays while a new one is computed."""

    # Distortion over time, of the active layer and of the compared method.
    curves: Derived[Clip, Curves | None] = field(default_factory=lambda: Derived(None))
    comparison_curves: Derived[Clip, Curves | None] = field(default_factory=lambda: Derived(None))
    # Motion paths of the active layer's handles, computed while they are shown.
    paths: Derived[Clip, MotionPaths | None] = field(default_factory=lambda: Derived(None))
    # Of attached layers; `Evaluator.current_transforms` has those of the present document.
    parent_transforms: Derived[tuple[object, ...], ParentTransforms | None] = field(
        default_factory=lambda: Derived(None)
    )
    # Extent of the motion; measured first if export settings are shown, else last.
    extent: Derived[tuple[object, ...], BoundingBox | None] = field(
        default_factory=lambda: Derived(None, remembers=EXTENTS)
    )
    # Peaks and loudness of sound files by checksum; None of those that cannot be read.
    waveforms: Mapping[str, InspectedSound | None] = field(default_factory=dict)

    def note_waveform(self, inspected: InspectedSound | None, sha256: str = "") -> None:
        """Note what was measured of a sound file, or that it cannot be read."""
        name = sha256 if inspected is None else inspected.file.sha256
        self.waveforms = {**self.waveforms, name: inspected}
