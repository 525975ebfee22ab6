"""The README's pictures of drawings in motion, and of a figure: made by the command line."""

from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image, ImageChops

from app.cli.main import main
from app.storage import sample_images

PAPER = "#fbf9f4"
MARGIN = 10  # pixels around what is seen
GAP = 8  # pixels between pictures that fill their frames


def draw(names: Sequence[str], folder: Path) -> None:
    """Draw pictures of drawings in motion into a folder.

    Parameters
    ----------
    names : sequence of str
        Of `PICTURES`.
    folder : Path
    """
    for name in names:
        with TemporaryDirectory() as scratch:
            PICTURES[name](folder, Path(scratch))


def _giraffe(folder: Path, scratch: Path) -> None:
    """Two keys and four in-betweens, in two rows."""
    frames = _frames("giraffe", range(0, 31, 6), scratch, "--framing=fit", "--size=340x330")
    rows = [_row(frames[:3]), _row(frames[3:])]
    sheet = Image.new("RGB", (rows[0].width, sum(row.height for row in rows)))
    sheet.paste(rows[0])
    sheet.paste(rows[1], (0, rows[0].height))
    sheet.save(folder / "giraffe.png", optimize=True)


def _ring(folder: Path, scratch: Path) -> None:
    """The keys of a ring that is squeezed and bent."""
    frames = _frames("ring", range(0, 43, 14), scratch, "--framing=fit", "--size=250x250")
    _row(frames).save(folder / "ring.png", optimize=True)


def _friend(folder: Path, scratch: Path) -> None:
    """Four frames of a scene."""
    frames = _frames("friend", (8, 22, 36, 64), scratch, "--framing=canvas", "--size=294x306")
    width, height = frames[0].size
    sheet = Image.new("RGBA", (len(frames) * (width + GAP) - GAP, height))
    for number, frame in enumerate(frames):
        sheet.paste(frame, (number * (width + GAP), 0))
    sheet.save(folder / "friend.png", optimize=True)


def _passing(folder: Path, _: Path) -> None:
    """A tail that is swept through its keys."""
    project, made = sample_images() / "dragon.lissom", folder / "passing.gif"
    _lissom("export", project, f"--out={made}", "--size=276x230", "--fps=12", *ON_PAPER)


def _figure_5(folder: Path, scratch: Path) -> None:
    """The paper's Figure 5, in as many tones as it needs."""
    _lissom("figures", "--only=5", f"--out={scratch}")
    with Image.open(scratch / "figure_5.png") as figure:
        sheet = Image.new("RGB", figure.size, "white")
        sheet.paste(figure, mask=figure.getchannel("A"))
    smaller = sheet.resize((1386, 1040), Image.Resampling.LANCZOS)
    smaller.quantize().save(folder / "figure-5.png", optimize=True)


def _frames(sample: str, numbers: Sequence[int], scratch: Path, *options: str) -> list[Image.Image]:
    """Return frames of a sample project, on paper."""
    project, span = sample_images() / f"{sample}.lissom", f"--frames={numbers[0]}:{numbers[-1]}"
    _lissom("export", project, f"--out={scratch}", span, *ON_PAPER, *options)
    return [Image.open(scratch / f"frame_{number:04}.png").convert("RGB") for number in numbers]


def _row(frames: Sequence[Image.Image]) -> Image.Image:
    """Put frames beside each other, in a row that is as high as what is seen in them."""
    width, height = frames[0].size
    row = Image.new("RGB", (len(frames) * width, height))
    for number, frame in enumerate(frames):
        row.paste(frame, (number * width, 0))
    _, top, _, bottom = ImageChops.difference(row, Image.new("RGB", row.size, PAPER)).getbbox()
    return row.crop((0, max(top - MARGIN, 0), row.width, min(bottom + MARGIN, height)))


def _lissom(*words: object) -> None:
    if main([str(word) for word in words]):
        raise RuntimeError(f"lissom {words} failed")


ON_PAPER = (f"--background={PAPER}",)
PICTURES: dict[str, Callable[[Path, Path], None]] = {
    "giraffe": _giraffe,
    "passing": _passing,
    "ring": _ring,
    "friend": _friend,
    "figure-5": _figure_5,
}
