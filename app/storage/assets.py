"""The files that ship with Lissom, found from a checkout and from an installed wheel alike."""

from pathlib import Path

from app.errors import REINSTALL, LissomError

_APP = Path(__file__).resolve().parents[1]


def sample_images() -> Path:
    """Return the folder of the sample pictures and projects."""
    return _folder("sample_images")


def shader_source(name: str) -> str:
    """Return the text of a GLSL file."""
    return _read(_folder("shaders") / name).decode()


def app_icon() -> bytes:
    """Return the icon of Lissom, a PNG picture of 512 × 512 pixels."""
    return _read(_APP / "icon" / "lissom.png")


def manual_page(name: str = "index") -> Path:
    """Return a page of the manual; its pictures, and all other pages, lie beside it."""
    page = _APP / "manual" / "site" / f"{name}.html"
    if not page.is_file():
        raise LissomError(f"the page {page} of the manual is missing; {REINSTALL}")
    return page


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise LissomError(f"cannot read {path}; {REINSTALL}") from error


def _folder(name: str) -> Path:
    # The wheel carries the folders inside the package; in a checkout they lie beside it.
    for path in (_APP / "shipped" / name, _APP.parent / name):
        if path.is_dir():
            return path
    raise LissomError(f"the folder {name!r} of Lissom is missing; {REINSTALL}")
