"""Settings of a document: limits, frames, variants, meshing, export."""

import re
from dataclasses import dataclass, replace
from typing import Final, Literal, NamedTuple, Self, get_args

from app.document.channels.key import BaseKey
from app.document.checks import (
    LAST_FRAME,
    require,
    require_size,
)
from app.export_formats import EXPORT_FORMATS, FormatSettings, expand_colour
from app.texts import N_, _
from engine.domain import MOST_TRIANGLES
from engine.domain.outline.enclosure import Detail
from engine.maps import Bounds
from engine.variant import Variant

# Usual triangles of a picture: fewest, most, and the pixels of one in between.
LEAST_TRIANGLES, USUAL_TRIANGLES, PIXELS_OF_TRIANGLE = 8_000, 20_000, 100

Framing = Literal["canvas", "fit"]
VARIANTS = tuple(Variant)
FRAMINGS: tuple[Framing, ...] = get_args(Framing)


class DistortionLimitPreset(NamedTuple):
    """A named preset of the three limits on distortion."""

    name: str
    bounds: Bounds
    hint: str


# Measured on the samples and on drawn heads, limbs and layers. Natural: limbs up to a third as
# thick as long bend by a right angle. A head with three handles keeps its shape when a fourth
# handle is dragged by a third of its width; at σ_a ≤ 2.5 already the whole head follows. Stiff:
# limbs up to a seventh as thick as long bend by a right angle.
STIFF: Final = DistortionLimitPreset(
    name=N_("Stiff"),
    bounds=Bounds(k=0.35, sigma_a=1.5, sigma_b=0.67),
    hint=N_("The layer bends a little and keeps its size"),
)
NATURAL: Final = DistortionLimitPreset(
    name=N_("Natural"),
    bounds=Bounds(k=0.5, sigma_a=2.0, sigma_b=0.5),
    hint=N_("Limbs bend and stretch, and a head keeps its shape"),
)
RUBBERY: Final = DistortionLimitPreset(
    name=N_("Rubbery"),
    bounds=Bounds(k=0.8, sigma_a=5.0, sigma_b=0.2),
    hint=N_("The layer follows far drags, which may distort it strongly"),
)
LIMIT_PRESETS: Final = (STIFF, NATURAL, RUBBERY)


def find_limit_preset(bounds: Bounds) -> DistortionLimitPreset | None:
    """Return the preset with exactly these limits, if any."""
    return next((stretch for stretch in LIMIT_PRESETS if stretch.bounds == bounds), None)


def relax_limits(bounds: Bounds) -> Bounds | None:
    """Return the next wider limits; None if no preset is wider."""
    for stretch in LIMIT_PRESETS:
        wider = bounds.joined(stretch.bounds)
        if wider != bounds:
            return wider
    return None


SLOWEST, FASTEST = 1 / 60, 1000.0  # frames per second
FRAME_NAMES = "frame_####"
MOST_EXPORT_REPEATS, LARGEST_EXPORT_SPEED = 100, 10.0  # the inverse is the smallest speed
# Excludes characters that some system does not allow in a file name.
_LITERAL = r'[^#/\\:*?"<>|\x00-\x1f\ud800-\udfff]{0,100}'


def require_fps(fps: float, what: str) -> None:
    """Raise a `LissomError` unless the rate is from SLOWEST to FASTEST."""
    require(
        SLOWEST <= fps <= FASTEST,
        N_("{what} must be from 1/60 to {fastest:,.0f} frames per second, not {fps:g}."),
        what=what,
        fastest=FASTEST,
        fps=fps,
    )


@dataclass(frozen=True, slots=True)
class FrameRange:
    first: int
    last: int

    def __post_init__(self) -> None:
        require(
            0 <= self.first <= self.last <= LAST_FRAME,
            N_(
                "Frames {first} to {last} are not a valid range. A range must start at frame 0 "
                "or later, and end no earlier and at most at frame {largest:,}."
            ),
            first=self.first,
            last=self.last,
            largest=LAST_FRAME,
        )

    def __contains__(self, frame: float) -> bool:
        return self.first <= frame <= self.last

    def clamp(self, frame: int) -> int:
        """Return the nearest frame in the range."""
        return min(max(frame, self.first), self.last)

    def wrap(self, frame: float) -> float:
        """Return the frame of the range that a loop shows in place of a frame beyond it."""
        period = self.last - self.first
        if not period or frame in self:
            return frame
        return self.first + (frame - self.first) % period


@dataclass(frozen=True, slots=True, kw_only=True)
class Marker(BaseKey):
    """A name for a frame, such as a beat; the frame may lie after the end of the animation."""

    name: str

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        require(bool(self.name.strip()), N_("A marker needs a name."))


@dataclass(frozen=True, slots=True, kw_only=True)
class PictureSettings:
    """Picture size and background that were last used with a format."""

    format: str
    size: tuple[int, int] | None
    background: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "background", expand_colour(self.background))
        _require_pictures(self.format, self.size, self.background)


def _require_pictures(name: str, size: tuple[int, int] | None, background: str) -> None:
    require(
        name in EXPORT_FORMATS,
        N_("The export format must be one of {formats}, not {name!r}."),
        formats=", ".join(EXPORT_FORMATS),
        name=name,
    )
    if size is not None:
        require_size(size, _("The export"))
    require(
        re.fullmatch(r"transparent|#[0-9a-fA-F]{6}", background) is not None,
        N_(
            "The background must be 'transparent' or a colour '#rrggbb' or '#rgb', not "
            "{background!r}."
        ),
        background=background,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportSettings(FormatSettings):
    """Settings of the last export.

    `size` is in pixels; None takes the framing at the drawing's own size. `background` is
    "transparent" or "#rrggbb". The framing "fit" shows all of the motion, "canvas" the canvas.
    Without `frames`, all frames are exported. They play `repeat` times, at `speed` times their own
    speed; a picture shows the same frame for as long, so that slower motion has more pictures.

    `names` are file names of frames without their ending. Each "#" is a digit of the frame number,
    and "{name}" is the project's name. `earlier` are the last settings of other formats.
    """

    format: str = "png"
    size: tuple[int, int] | None = None
    background: str = "transparent"
    framing: Framing = "fit"
    frames: FrameRange | None = None
    names: str = FRAME_NAMES
    sound: bool = True  # whether formats that can carry sounds carry them
    repeat: int = 1
    speed: float = 1.0
    earlier: tuple[PictureSettings, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "background", expand_colour(self.background))
        _require_pictures(self.format, self.size, self.background)
        require(
            1 <= self.repeat <= MOST_EXPORT_REPEATS,
            N_("An export can repeat from 1 to {most} times, not {count} times."),
            most=MOST_EXPORT_REPEATS,
            count=self.repeat,
        )
        require(
            1 / LARGEST_EXPORT_SPEED <= self.speed <= LARGEST_EXPORT_SPEED,
            N_("An export has from {least:.0f} % to {most:,.0f} % of the speed, not {speed:g} %."),
            least=100 / LARGEST_EXPORT_SPEED,
            most=100 * LARGEST_EXPORT_SPEED,
            speed=100 * self.speed,
        )
        require(
            self.framing in FRAMINGS,
            N_("The framing must be one of {framings}, not {framing!r}."),
            framings=", ".join(FRAMINGS),
            framing=self.framing,
        )
        require(
            re.fullmatch(rf"{_LITERAL}#+{_LITERAL}", self.names) is not None
            and not self.names.startswith("."),
            N_(
                "{names!r} cannot name frames. Write '#' for each digit of the number, as in "
                "{example}, and only characters that file names can hold."
            ),
            example=FRAME_NAMES,
            names=self.names,
        )

    def in_format(self, name: str) -> Self:
        """Return the settings with another format and its last size and background.

        A format without earlier settings takes the current ones. An opaque background that only the
        current format needs is not taken.
        """
        if name == self.format:
            return self
        others = {each.format: each for each in self.earlier}
        others[self.format] = PictureSettings(
            format=self.format, size=self.size, background=self.background
        )
        is_needed = not EXPORT_FORMATS[self.format].is_transparent
        is_let_go = is_needed and EXPORT_FORMATS[name].is_transparent
        background = "transparent" if is_let_go else self.background
        usual = PictureSettings(format=name, size=self.size, background=background)
        chosen = others.pop(name, usual)
        return replace(
            self,
            format=name,
            size=chosen.size,
            background=chosen.background,
            earlier=tuple(others.values()),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Meshing:
    """Parameters of `app.cut_out.build_picture_domain`."""

    detail: Detail = "normal"
    triangles: int = 100_000

    @classmethod
    def of_size(cls, size: tuple[int, int]) -> Self:
        """Return the usual meshing of a picture of this size in pixels.

        More triangles bend no better as seen, but take longer.
        """
        area = size[0] * size[1] // PIXELS_OF_TRIANGLE
        return cls(triangles=round(min(max(area, LEAST_TRIANGLES), USUAL_TRIANGLES), -3))

    def __post_init__(self) -> None:
        details = get_args(Detail)
        require(
            self.detail in details,
            N_("The detail must be one of {details}, not {detail!r}."),
            details=details,
            detail=self.detail,
        )
        require(
            0 < self.triangles <= MOST_TRIANGLES,
            N_("The number of triangles must be from 1 to {most:,}, not {triangles}."),
            most=MOST_TRIANGLES,
            triangles=self.triangles,
        )
