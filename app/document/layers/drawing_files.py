"""Files of drawings from which layers were imported, as they were at that time."""

from dataclasses import dataclass, field

from app.document.checks import NOTHING, Unknown, require, require_id, require_point, require_size
from app.document.layers.groups import BlendMode, Group
from app.texts import N_, _


@dataclass(frozen=True, slots=True, kw_only=True)
class FileLayer:
    """A layer as it is in its file."""

    name: str  # may occur several times
    group: str = ""  # path of its group in the file; "" outside groups
    number: int = 0  # its id in the file; 0 without one
    opacity: float = 1.0
    blend: BlendMode = "normal"
    clipped: bool = False
    hidden: bool = False
    is_missing: bool = False  # whether the newest version of the file lacks the layer

    @property
    def path(self) -> tuple[str, str]:
        return self.group, self.name


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawingFile:
    """A file of a drawing, as it was when its layers were imported or reloaded."""

    id: int  # unique in the document
    name: str  # of the file, without folder
    sha256: str
    size: tuple[int, int]  # of its canvas, in pixels
    corner: complex = 0j  # lower left corner of its canvas on the document's canvas
    # Back to front, then missing layers.
    layers: tuple[FileLayer, ...]
    groups: tuple[Group, ...] = ()  # with their paths in the file
    is_merged: bool = False  # whether its layers were merged into one picture
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_id(self.id, _("A drawing"))
        require(bool(self.layers), N_("The drawing {name!r} has no layers."), name=self.name)
        require_size(self.size, _("The drawing"))
        require_point(self.corner, _("The corner of {layer!r}").format(layer=self.name))


@dataclass(frozen=True, slots=True, kw_only=True)
class LayerOrigin:
    """The layer of a drawing's file that a layer shows."""

    drawing: int  # id
    index: int  # in its layers
