"""Commands on the pose sliders of a layer."""

from dataclasses import replace

from app.document.channels.kinds import SLIDER
from app.document.channels.sliders import Slider, SliderPose
from app.document.commands.command import layer_command, with_number
from app.document.keyframe import LibraryPose, Pose
from app.document.layer import Layer
from app.texts import _


@layer_command(_("Add slider"))
def add_slider(layer: Layer, slider: Slider) -> Layer:
    return replace(layer, sliders=(*layer.sliders, slider))


@layer_command(_("Change slider"))
def change_slider(layer: Layer, name: str, slider: Slider) -> Layer:
    """Put a slider in the place of another; its keys stay, also under another name."""
    old, keys = layer.slider(name), layer.keys_of(SLIDER, name)
    sliders = tuple(slider if each is old else each for each in layer.sliders)
    channels = {id_: own for id_, own in layer.channels.items() if id_ != (SLIDER.name, name)}
    channels[SLIDER.name, slider.name] = keys
    return replace(layer, sliders=sliders, channels=channels)


@layer_command(_("Set slider"))
def set_slider_value(layer: Layer, name: str, value: complex) -> Layer:
    """Set the value of a slider without keys."""
    old = layer.slider(name)
    changed = replace(old, value=value)
    if changed == old:
        return layer
    return replace(layer, sliders=tuple(changed if each is old else each for each in layer.sliders))


@layer_command(_("Delete slider"))
def delete_slider(layer: Layer, name: str) -> Layer:
    """Delete a slider with its keys; its poses stay in the library."""
    old = layer.slider(name)
    channels = {id_: own for id_, own in layer.channels.items() if id_ != (SLIDER.name, name)}
    sliders = tuple(each for each in layer.sliders if each is not old)
    return replace(layer, sliders=sliders, channels=channels)


@layer_command(_("Set slider pose"))
def set_slider_pose(layer: Layer, name: str, at: complex, pose: Pose) -> Layer:
    """Set the pose of a slider at a value: change its pose of the library, or add one to both."""
    slider = layer.slider(name)
    known = next((each.pose for each in slider.poses if each.at == at), None)
    if known is not None:
        library = (
            replace(kept, pose=pose) if kept.name == known else kept for kept in layer.library
        )
        return replace(layer, library=tuple(library))
    added = LibraryPose(name=with_number(name, {kept.name for kept in layer.library}, 1), pose=pose)
    poses = [each for each in slider.poses if each.at != at]
    poses.append(SliderPose(at=at, pose=added.name))
    poses.sort(key=lambda each: (each.at.imag, each.at.real))
    sliders = tuple(
        replace(each, poses=tuple(poses)) if each is slider else each for each in layer.sliders
    )
    return replace(layer, library=(*layer.library, added), sliders=sliders)
