"""Pose sliders in a pose script."""

from collections.abc import Collection
from dataclasses import dataclass

from app.document import SLIDER, Key, Slider, SliderPose
from app.errors import LissomError
from app.solving.script.channels import read_tangent_keys
from app.solving.script.fields import read_fields
from app.solving.script.keys import POSE_FIELDS, PoseKey, read_pose
from app.solving.script.tracks import read_oscillator
from app.storage import VALUE, as_list, as_text, as_whole, located
from app.texts import N_, _

FIELDS = ("name", "poses", "keys", "value", "driver", "delay", "spring")
TWICE = N_("{where}: there is another slider {name!r}; rename one of them")
ONE_NUMBER = N_("{where}: the slider {name!r} is no pad, so its value is one number")


@dataclass(frozen=True, slots=True, kw_only=True)
class ScriptSlider:
    """A slider, the poses at its values, and the keys of its value.

    The poses of the slider have no names yet, and its driver is named apart.
    """

    slider: Slider
    poses: tuple[PoseKey, ...]
    keys: tuple[Key[complex], ...]
    driver: str | None


def parse_sliders(
    content: object, where: str, handles: Collection[str]
) -> tuple[ScriptSlider, ...]:
    """Return the sliders of a layer with these handles."""
    sliders: list[ScriptSlider] = []
    for index, each in enumerate(as_list(content, where)):
        given = _slider(each, f"{where}[{index}]", handles)
        if given.slider.name in {other.slider.name for other in sliders}:
            place = f"{where}[{index}]"
            raise LissomError(_(TWICE).format(where=place, name=given.slider.name))
        sliders.append(given)
    return tuple(sliders)


def _slider(content: object, where: str, handles: Collection[str]) -> ScriptSlider:
    fields = read_fields(content, where, FIELDS)
    poses, keyed = [], []
    for index, each in enumerate(as_list(fields["poses"], f"{where}.poses")):
        at = f"{where}.poses[{index}]"
        pose = read_fields(each, at, ("at", "turns", *POSE_FIELDS))
        place = VALUE.read(pose["at"], f"{at}.at")
        turns = as_whole(pose.get("turns", 0), f"{at}.turns")
        poses.append(SliderPose(at=place, pose=None, turns=turns))
        keyed.append(PoseKey(**read_pose(pose, at, handles)))
    slider = located(
        where,
        Slider,
        name=as_text(fields["name"], f"{where}.name"),
        poses=tuple(poses),
        value=VALUE.read(fields.get("value", 0), f"{where}.value"),
        delay=as_whole(fields.get("delay", 0), f"{where}.delay"),
        spring=_spring(fields["spring"], f"{where}.spring") if "spring" in fields else None,
    )
    keys: tuple[Key[complex], ...] = ()
    if "keys" in fields:
        keys = read_tangent_keys(SLIDER, fields["keys"], f"{where}.keys")
    for each in (slider.value, *(key.value for key in keys)):
        if each.imag and not slider.is_pad:
            raise LissomError(_(ONE_NUMBER).format(where=where, name=slider.name))
    driver = as_text(fields["driver"], f"{where}.driver") if "driver" in fields else None
    return ScriptSlider(slider=slider, poses=tuple(keyed), keys=keys, driver=driver)


def _spring(content: object, where: str) -> tuple[float, float]:
    """Return a frequency and a damping, given or by the name of a preset."""
    fields = read_fields(content, where, ("preset", "frequency", "damping"))
    given = read_oscillator(fields, where)
    return given["frequency"], given["damping"]
