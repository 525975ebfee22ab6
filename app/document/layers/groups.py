"""Groups of layers, and blend modes."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from app.document.checks import NOTHING, Unknown, require
from app.texts import N_

# How the colours of a layer are blended with the colours behind it, its backdrop: labels by name,
# in the order and sections of Photoshop. The formulas are those of "Compositing and Blending Level
# 1" of the W3C, Section 10. Linear dodge is b + s, linear burn b + s − 1, and subtract b − s.
BLEND_SECTIONS: Final[tuple[Mapping[str, str], ...]] = (
    {"normal": N_("normal")},
    {
        "darken": N_("darken"),
        "multiply": N_("multiply"),
        "color-burn": N_("colour burn"),
        "linear-burn": N_("linear burn"),
    },
    {
        "lighten": N_("lighten"),
        "screen": N_("screen"),
        "color-dodge": N_("colour dodge"),
        "linear-dodge": N_("linear dodge (add)"),
    },
    {
        "overlay": N_("overlay"),
        "soft-light": N_("soft light"),
        "hard-light": N_("hard light"),
    },
    {
        "difference": N_("difference"),
        "exclusion": N_("exclusion"),
        "subtract": N_("subtract"),
    },
    {
        "hue": N_("hue"),
        "saturation": N_("saturation"),
        "color": N_("colour"),
        "luminosity": N_("luminosity"),
    },
)
BlendMode = str  # a name of the table
BLENDS: Final = tuple(name for section in BLEND_SECTIONS for name in section)
# The layers of a pass-through group blend directly with the backdrop; the group's opacity is
# applied to the result. The layers of any other group blend with each other first, and the result
# blends with the backdrop.
GROUP_BLEND_SECTIONS: Final = ({"pass-through": N_("pass-through")}, *BLEND_SECTIONS)
GROUP_BLENDS: Final = ("pass-through", *BLENDS)
MAX_GROUP_DEPTH = 50  # nested groups


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Layers that are composited, faded and hidden together.

    Each run of members in the draw order is composited separately.
    """

    name: str  # path with the groups around it, such as "limbs/left"; unique in the document
    opacity: float = 1.0  # in [0, 1]
    hidden: bool = False  # whether its layers are hidden at all frames
    blend: BlendMode = "pass-through"
    clipped: bool = False  # as for a layer
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_path(self.name)
        require(
            0 <= self.opacity <= 1,
            N_("Opacity must be from 0 to 1, not {opacity:g}."),
            opacity=self.opacity,
        )
        require(
            self.blend in GROUP_BLENDS,
            N_("The blend of a group must be one of {blends}, not {blend!r}."),
            blends=", ".join(GROUP_BLENDS),
            blend=self.blend,
        )


def require_path(path: str) -> None:
    """Raise a `LissomError` unless the path is names separated by slashes, as in "limbs/left"."""
    names = path.split("/")
    require(
        all(name and name == name.strip() for name in names),
        N_(
            "{path!r} is not a path of a group. Give each group a name, and separate nested "
            "groups with slashes."
        ),
        path=path,
    )
    require(
        len(names) <= MAX_GROUP_DEPTH,
        N_("Groups can be nested at most {most} deep."),
        most=MAX_GROUP_DEPTH,
    )


def ancestor_paths(path: str) -> tuple[str, ...]:
    """Return the paths of the groups around a group, the outermost first, and its own path."""
    names = path.split("/") if path else []
    return tuple("/".join(names[: depth + 1]) for depth in range(len(names)))


def common_path(one: str, other: str) -> str:
    """Return the path of the innermost group around both; "" without one."""
    both = [a for a, b in zip(ancestor_paths(one), ancestor_paths(other), strict=False) if a == b]
    return both[-1] if both else ""
