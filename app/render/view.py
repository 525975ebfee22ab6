"""The part of the plane that a frame shows, and its scale."""

from dataclasses import dataclass, replace

from app.errors import LissomError
from app.texts import _
from engine.arrays import Complexes


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """A camera perpendicular to the plane."""

    centre: complex  # centre of the frame, x + iy with y up
    scale: float  # pixels of the frame per unit of the plane
    size: tuple[int, int]  # width and height of the frame in pixels
    turn: complex = 1.0 + 0j  # rotation of the plane, of modulus 1

    def __post_init__(self) -> None:
        if min(self.size) < 1:
            raise LissomError(
                _("a frame needs at least 1 × 1 pixels, not {width} × {height}").format(
                    width=self.size[0], height=self.size[1]
                )
            )
        if not self.scale > 0:
            text = _("the scale of a view must be positive, not {scale}")
            raise LissomError(text.format(scale=self.scale))

    @property
    def transform(self) -> tuple[float, float, float, float]:
        """Factors and offsets (x, y, x, y) from the turned plane to OpenGL's -1 … 1."""
        x, y = 2 * self.scale / self.size[0], 2 * self.scale / self.size[1]
        centre = self.turn * self.centre
        return x, y, -x * centre.real, -y * centre.imag

    @property
    def uniforms(self) -> dict[str, object]:
        """Shader uniforms: the rotation of the plane, then the map to OpenGL's -1 … 1."""
        return {"view": self.transform, "view_turn": (self.turn.real, self.turn.imag)}

    def to_pixels(self, points: Complexes) -> Complexes:
        """Return the pixels of points, x + iy from the frame's upper left corner with y down."""
        offset = (self.turn * (points - self.centre)).conj() * self.scale
        pixels: Complexes = offset + complex(*self.size) / 2
        return pixels

    def to_plane(self, pixel: complex) -> complex:
        """Return the point under a pixel; the inverse of `to_pixels`."""
        offset = (pixel - complex(*self.size) / 2).conjugate() / self.scale
        return self.centre + self.turn.conjugate() * offset

    def panned(self, pixels: complex) -> "View":
        """Return the view after dragging its contents by x + iy pixels, y down."""
        moved = self.turn.conjugate() * pixels.conjugate() / self.scale
        return replace(self, centre=self.centre - moved)

    def zoomed(self, factor: float, pixel: complex) -> "View":
        """Return the view magnified by `factor`; the point under `pixel` stays fixed."""
        fixed = self.to_plane(pixel)
        centre = fixed + (self.centre - fixed) / factor
        return replace(self, centre=centre, scale=self.scale * factor)


def canvas_view(picture: tuple[int, int], size: tuple[int, int] | None = None) -> View:
    """Return the view of the source picture's own rectangle, centred and as large as possible.

    The plane's units are the picture's pixels. The frame's size is by default the picture's.
    """
    return fit_view(0j, complex(*picture), size or picture)


def fit_view(lower: complex, upper: complex, size: tuple[int, int], *, margin: float = 0.0) -> View:
    """Return the view that shows a whole box as large as possible.

    Parameters
    ----------
    lower, upper : complex
        Lower left and upper right corner of the box.
    size : tuple of int
        Width and height of the frame in pixels.
    margin : float
        Pixels left free at each side of the frame.
    """
    extent = upper - lower
    free = [max(side - 2 * margin, 1.0) for side in size]
    # A box without width or height is limited by its other side alone; a point has no limit.
    scales = [
        side / length
        for side, length in zip(free, (extent.real, extent.imag), strict=True)
        if length > 0
    ]
    return View(centre=(lower + upper) / 2, scale=min(scales, default=1.0), size=size)
