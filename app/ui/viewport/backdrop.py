"""What lies behind the drawing: a colour that was chosen, or squares on which it stands out."""

import numpy as np
from imgui_bundle import ImVec4

from app.render import Backdrop
from app.storage import CHECKER
from app.ui.style import PALETTES, Palette, rgb
from app.ui.viewport.marks import plain
from engine.arrays import Bytes, Floats

SQUARE = 12.0  # pixels at a scale of 1
LEVELS = 256
# Of brightness, 0 to 1: what is nearer to the backdrop is hard to see; of the drawing's area, the
# share of that from which on another backdrop is taken.
NEAR, MUCH = 0.2, 0.6
LUMA = np.array([0.2126, 0.7152, 0.0722])  # of red, green and blue, as Rec. 709 weighs them
STEP = 4  # pixels: every so manieth is looked at


def measure_brightness(picture: Bytes) -> Floats:
    """Return which share of a picture's (h, w, 4) opaque area has which brightness.

    Returns
    -------
    (256,) float64
        From black to white.
    """
    pixels = picture[::STEP, ::STEP].reshape(-1, 4)
    levels = np.rint(pixels[:, :3] @ LUMA).astype(np.intp)
    shares = np.bincount(levels, pixels[:, 3], LEVELS)
    return np.asarray(shares / max(shares.sum(), 1.0))


def background(backdrop: str, palette: Palette, brightness: Floats, scale: float) -> Backdrop:
    """Return the backdrop; the squares of the other theme, where the drawing is lost on its own's.

    Parameters
    ----------
    backdrop : str
        "checker" or "#rrggbb".
    palette : Palette
        Of the theme.
    brightness : (256,) float64
        Of the drawing.
    scale : float
        Pixels of the screen that a pixel of the design takes.
    """
    if backdrop != CHECKER:
        return Backdrop(colour=plain(rgb(backdrop)))
    if _lost(brightness, palette.paper) > MUCH:
        papers = PALETTES.values()
        palette = min(papers, key=lambda other: _lost(brightness, other.paper))
    paper, check = plain(palette.paper), plain(palette.check)
    return Backdrop(colour=paper, checks=check, square=SQUARE * scale)


def _lost(brightness: Floats, paper: ImVec4) -> float:
    """Return the share of the drawing that is nearly as bright as the paper."""
    level = float(np.array([paper.x, paper.y, paper.z]) @ LUMA)
    is_near = np.abs(np.arange(LEVELS) / (LEVELS - 1) - level) < NEAR
    return float(brightness[is_near].sum())
