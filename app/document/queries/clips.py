"""A layer on the timeline of its document."""

from dataclasses import dataclass, fields
from operator import attrgetter

from app.baseline import Baseline
from app.document.channels.cycles import Cycle
from app.document.channels.key import Key
from app.document.channels.kinds import LAYER_KINDS, SLIDER
from app.document.channels.sliders import Slider
from app.document.keyframe import Handle, Keyframe
from app.document.layer import Layer
from app.document.model import Document
from app.document.queries.layers.layer_bones import limb_ends
from app.document.queries.memo import memoized_on
from app.document.settings import FrameRange

# Fields of a layer, and of its handles, that do not affect its motion. All other fields do. Of
# motion presets only the ground does.
UNMOVING = {
    *("name", "next_handle", "library", "mirror", "motions", "unread_motions", "reference"),
    *("locked", "hidden", "opacity", "blend", "clipped", "group", "unread_channels", "unknown"),
}
UNMOVING_OF_HANDLES = {"name", "group", "unknown"}
_of_layer = attrgetter(
    *(
        each.name
        for each in fields(Layer)
        if each.name not in UNMOVING | {"handles", "stiffness", "channels"}
    )
)
_of_handle = attrgetter(
    *(each.name for each in fields(Handle) if each.name not in UNMOVING_OF_HANDLES)
)


@memoized_on
def motion_source(layer: Layer) -> tuple[object, ...]:
    """Return the fields that determine a layer's motion; equal values mean equal motion."""
    stiffness = None if layer.stiffness is None else layer.stiffness.tobytes()
    moving = tuple(each for each in layer.channels.items() if LAYER_KINDS[each[0][0]].moves_layer)
    used = {each.pose for slider in layer.sliders for each in slider.poses}
    poses = tuple(kept.pose for kept in layer.library if kept.name in used)
    grounds = tuple((motion.id, motion.ground_velocity) for motion in layer.motions)
    handles = tuple(map(_of_handle, layer.handles))
    return (*_of_layer(layer), handles, stiffness, moving, poses, grounds)


@dataclass(frozen=True, slots=True)
class SliderChannel:
    """A slider of a layer, with the keys that give its value.

    They are those of the driver, if there is one, with its cycles and with its value without keys.
    """

    slider: Slider
    keys: tuple[Key[complex], ...]
    cycles: tuple[Cycle, ...]
    value: complex


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Clip:
    """A layer on its document's timeline; two clips are equal if their motion is."""

    layer: Layer
    frames: FrameRange  # of the document
    loop: bool
    fps: float  # because springs swing in seconds
    # A rival method to compare with the layer's own variant.
    baseline: Baseline | None = None
    # Clips of all ancestors, without ancestors of their own, and of the limbs whose IK targets move
    # them. Set only if springs or scene-space tracks depend on their motion.
    parents: "tuple[Clip, ...]" = ()
    sliders: tuple[SliderChannel, ...] = ()  # the enabled ones

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Clip):
            return NotImplemented
        return self._time == other._time and (
            self.layer is other.layer or motion_source(self.layer) == motion_source(other.layer)
        )

    def __hash__(self) -> int:
        return hash(self._time)

    @property
    def _time(self) -> tuple[object, ...]:
        own = (self.layer.id, self.frames, self.loop, self.fps)
        return (*own, self.baseline, self.parents, self.sliders)

    @property
    def keys(self) -> tuple[Keyframe, ...]:
        return self.layer.keys

    @property
    def period(self) -> int:
        """Length of the loop in frames."""
        return self.frames.last - self.frames.first


def clip_of(document: Document, layer: int) -> Clip:
    own = document.layer(layer)
    feels = [each.enabled for each in own.springs]
    feels += [each.enabled and each.is_scene_space for each in own.tracks]

    def clip(each: Layer, parents: tuple[Clip, ...] = ()) -> Clip:
        return Clip(
            layer=each,
            frames=document.frames,
            loop=document.loop,
            fps=document.fps,
            parents=parents,
            sliders=_slider_channels(document, each),
        )

    if not any(feels):
        return clip(own)
    parents = [*document.all_ancestors(layer)]
    for end in limb_ends(document, layer):
        parents += [end, *document.all_ancestors(end.id)]
    others = [each for each in dict.fromkeys(parents) if each is not own]
    return clip(own, tuple(map(clip, others)))


def _slider_channels(document: Document, layer: Layer) -> tuple[SliderChannel, ...]:
    found = []
    for slider in layer.sliders:
        driver = None if slider.driver is None else document.find_layer(slider.driver)
        source = next(each for each in (driver, layer) if each and slider.name in _names(each))
        keys = source.keys_of(SLIDER, slider.name)
        value = source.slider(slider.name).value
        if slider.enabled:
            found.append(SliderChannel(slider, keys, source.cycles, value))
    return tuple(found)


def _names(layer: Layer) -> set[str]:
    return {each.name for each in layer.sliders}
