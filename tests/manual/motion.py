"""The manual's clips of drawings in motion: exported from the sample projects."""

import io
from collections.abc import Callable, Sequence
from pathlib import Path

from PIL import Image, ImageSequence

from app.cli.main import main
from app.storage import app_icon, sample_images
from tests.manual.film import save_film

HEIGHT = 260  # pixels
RATE = 12  # frames a second
PAPER = "#fbf9f4"
SAMPLES = ("giraffe", "dragon", "character", "octopus", "ring", "friend")


def draw(names: Sequence[str], folder: Path) -> None:
    """Export clips of the samples into a folder."""
    for name in names:
        DRAWN[name](folder / name)
        print(name, flush=True)


def _sample(path: Path) -> None:
    """Export a sample project as an animation, in fewer bytes than is exact."""
    exported = path.with_suffix(".exact.webp")
    framing = "canvas" if path.name == "friend" else "fit"
    _lissom(
        "export",
        sample_images() / f"{path.name}.lissom",
        f"--out={exported}",
        f"--fps={RATE}",
        f"--framing={framing}",
        f"--size=360x{HEIGHT}",
        f"--background={PAPER}",
    )
    with Image.open(exported) as film:
        frames = [frame.convert("RGB") for frame in ImageSequence.Iterator(film)]
    exported.unlink()
    save_film(path.with_suffix(".webp"), frames, RATE)


def _sprite_sheet(path: Path) -> None:
    """Export some frames of the giraffe as a sprite sheet, trimmed as engines take it."""
    exported = path.with_suffix(".exact.png")
    _lissom(
        "export",
        sample_images() / "giraffe.lissom",
        f"--out={exported}",
        "--format=spritesheet",
        "--frames=0:30",
        "--fps=4",
        "--size=150x210",
    )
    exported.with_suffix(".json").unlink()
    with Image.open(exported) as sheet:
        sheet.convert("RGBA").quantize(256).save(path.with_suffix(".png"), optimize=True)
    exported.unlink()


def _icon(path: Path) -> None:
    """Draw the icon, as small as it stands above each page."""
    with Image.open(io.BytesIO(app_icon())) as icon:
        small = icon.resize((64, 64), Image.Resampling.LANCZOS)
    small.save(path.with_suffix(".png"), optimize=True)


def _lissom(*words: object) -> None:
    if main([str(word) for word in words]):
        raise RuntimeError(f"lissom {words} failed")


DRAWN: dict[str, Callable[[Path], None]] = dict.fromkeys(SAMPLES, _sample)
DRAWN |= {"sprite-sheet": _sprite_sheet, "lissom": _icon}
