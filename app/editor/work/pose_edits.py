"""What edits of poses remember: a flip, a blend, the picked pose, sliders, new handles."""

from dataclasses import dataclass, replace

from app.document import Document, Keyframe, Pose
from app.editor.work.revised import Revised


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LastFlip:
    """The last flip.

    `keys` are the copied keys; `poses` are the flipped poses at the layer's `frames`.
    """

    layer: int
    keys: tuple[Keyframe, ...]
    frames: frozenset[int]
    poses: tuple[Pose, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BlendPreview:
    """A library pose that is blended into the pose at a frame.

    `share` is from 0 to 1. Blends of one gesture are one undo step.
    """

    name: str
    owner: int
    gesture: object
    share: float = 0.0


@dataclass(slots=True, kw_only=True, eq=False)
class PoseEdits(Revised):
    """The memory of flips and of the pose library."""

    last_flip: LastFlip | None = None
    blend_preview: BlendPreview | None = None
    picked_pose: tuple[int, str] | None = None  # layer id, and name in its library
    # Poses of the library for a new slider; None is the undeformed drawing.
    slider_poses: frozenset[str | None] = frozenset({None})
    # Sliders that go beyond their poses, by layer id and name.
    wide_sliders: frozenset[tuple[int, str]] = frozenset()
    # The document right after handles were added; None before.
    with_new_handles: Document | None = None

    def note_new_handles(self, document: Document) -> None:
        """Note a document whose last change added handles."""
        self.with_new_handles = document

    def note_flip(self, flip: LastFlip) -> None:
        self.last_flip = flip

    def pick(self, layer: int, name: str) -> None:
        """Pick a pose of a layer's library."""
        self.picked_pose = layer, name

    def toggle_slider_pose(self, name: str | None) -> None:
        """Choose a pose for a new slider, or choose it no more."""
        self.slider_poses ^= {name}

    def toggle_wide_slider(self, layer: int, name: str) -> None:
        """Let a slider go beyond its poses, or no more."""
        self.wide_sliders ^= {(layer, name)}

    def blend(self, name: str, owner: int, share: float) -> BlendPreview:
        """Begin to blend a library pose, or go on with it, and return the blend."""
        begun = self.blend_preview
        if begun is None or (begun.name, begun.owner) != (name, owner):
            begun = BlendPreview(name=name, owner=owner, gesture=object())
        self.blend_preview = replace(begun, share=share)
        return self.blend_preview

    def end_blend(self) -> BlendPreview | None:
        """End the blend, and return it."""
        blend, self.blend_preview = self.blend_preview, None
        return blend
