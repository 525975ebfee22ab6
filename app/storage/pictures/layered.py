"""A drawing on several layers, and what its readers share."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from app.document import layer_commands
from app.errors import LissomError
from app.storage.pictures.cores import require_memory
from app.storage.pictures.picture import Picture

MOST_LAYERS = 200
# Groups in each other.
DEEPEST = 50


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Layer:
    """A layer of a drawing.

    Parameters
    ----------
    name : str
        Unique in its drawing.
    data : bytes
        The layer's picture as a file.
    picture : Picture
        The same, decoded.
    corner : complex
        Where its lower left corner is on the canvas, in pixels, y up.
    visible : bool
    opacity : float
        In [0, 1].
    """

    name: str
    data: bytes
    picture: Picture
    corner: complex = 0j
    visible: bool = True
    opacity: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LayeredPicture:
    """A drawing on layers.

    Parameters
    ----------
    size : tuple of int
        Width and height of the canvas in pixels.
    layers : tuple of Layer
        From the one behind all others to the one in front; there is always one.
    notices : tuple of str
        What could not be kept, in words.
    """

    size: tuple[int, int]
    layers: tuple[Layer, ...]
    notices: tuple[str, ...]


def layered_picture(
    size: tuple[int, int], found: Sequence[tuple[str, Layer]], notices: Sequence[str]
) -> LayeredPicture:
    """Return the drawing of the layers that were found, each with a name of its own.

    Parameters
    ----------
    size : tuple of int
    found : sequence of (str, Layer)
        From back to front, each with the names of the groups that it is in, as "limbs/left"; layers
        of which nothing is to be seen are left out.
    notices : sequence of str
    """
    notices, kept = list(notices), []
    for group, layer in found:
        if layer.picture.rgba[..., 3].any():
            kept.append((group, layer))
        else:
            notices.append(f"left out the empty layer {layer.name!r}")
    if not kept:
        raise LissomError("it has no layer on which anything is drawn")
    own = Counter(layer.name for _, layer in kept)
    taken: set[str] = set()
    layers = []
    for group, layer in kept:
        name = f"{group}/{layer.name}" if group and own[layer.name] > 1 else layer.name
        free = layer_commands.numbered_name(name, taken)
        taken.add(free)
        layers.append(replace(layer, name=free))
    return LayeredPicture(size=size, layers=tuple(layers), notices=tuple(notices))


def require_few(count: int) -> None:
    """Refuse more layers than there is room for, before anything of them is read."""
    if count > MOST_LAYERS:
        raise LissomError(
            f"it has {count:,} layers; Lissom takes up to {MOST_LAYERS}: merge some of them"
        )


def require_room(sizes: Sequence[tuple[int, int]]) -> None:
    """Refuse more layers, or larger ones, than there is room for, before they are decoded."""
    require_few(len(sizes))
    require_memory(sizes)


def corner_from_top(left: float, top: float, size: tuple[int, int], height: int) -> complex:
    """Return a layer's lower left corner, y up on a canvas so high, from its upper left one."""
    return complex(left, height - top - size[1])
