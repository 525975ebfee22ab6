"""The files that ship with Lissom, found in a checkout and in an installed wheel."""

from pathlib import Path

from app.errors import REINSTALL, LissomError
from app.texts import _

_APP = Path(__file__).resolve().parents[1]


def sample_images() -> Path:
    return _folder("sample_images")


def shader_source(name: str) -> str:
    """Return the text of a GLSL file."""
    return _read(_folder("shaders") / name).decode()


def app_icon() -> bytes:
    """Return the icon of Lissom, a PNG picture of 512 × 512 pixels."""
    return _read(_APP / "icon" / "lissom.png")


def manual_page(name: str = "index") -> Path:
    """Return a page of the manual. Its pictures and all other pages are in the same folder."""
    page = _APP / "manual" / "site" / f"{name}.html"
    if not page.is_file():
        raise LissomError(
            _("the page {page} of the manual is missing; {reinstall}").format(
                page=page, reinstall=_(REINSTALL)
            )
        )
    return page


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise LissomError(
            _("cannot read {path}; {reinstall}").format(path=path, reinstall=_(REINSTALL))
        ) from error


def _folder(name: str) -> Path:
    # The wheel has the folders inside the package; a checkout has them beside the package.
    for path in (_APP / "shipped" / name, _APP.parent / name):
        if path.is_dir():
            return path
    raise LissomError(
        _("the folder {name!r} of Lissom is missing; {reinstall}").format(
            name=name, reinstall=_(REINSTALL)
        )
    )
