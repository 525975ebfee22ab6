"""`lissom desktop`: Lissom in the application menu, and .lissom files that open with it.

Everything is installed for one person, by freedesktop.org's specifications of base directories,
desktop entries, icon themes and shared MIME information. Thumbnailer entries follow the common
practice of the desktops.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from contextlib import suppress
from operator import methodcaller
from pathlib import Path

from app.cli.console import print_line
from app.errors import REINSTALL, LissomError
from app.folders import home_folder
from app.texts import LOCALE, N_, _, read_translations

PROGRAM = "lissom"
# Below the person's data folder.
ENTRY_AT = "applications/lissom.desktop"
THUMBNAILER_AT = "thumbnailers/lissom.thumbnailer"
MIME_TYPE_AT = "mime/packages/lissom.xml"
ICONS_AT = {
    side: f"icons/hicolor/{side}x{side}/apps/lissom.png"
    for side in (16, 24, 32, 48, 64, 128, 256, 512)
}
INSTALLED_PATHS = (ENTRY_AT, THUMBNAILER_AT, MIME_TYPE_AT, *ICONS_AT.values())
# Programs that refresh the desktop, and the folders that they read.
REFRESHERS = {"update-desktop-database": "applications", "update-mime-database": "mime"}
# Output of `update-mime-database`. Without packages it writes empty files.
MIME_DATABASE = (
    *("XMLnamespaces", "aliases", "generic-icons", "globs", "globs2", "icons", "magic"),
    *("mime.cache", "subclasses", "treemagic", "types", "version"),
)
PATIENCE = 60.0  # seconds
OTHER_SYSTEM = N_(
    "'lissom desktop' is for Linux and similar systems; here, choose Lissom for .lissom files in "
    "the settings of the system"
)
ENTRY = """\
[Desktop Entry]
Type=Application
Name=Lissom
{names}TryExec={program}
Exec={quoted} %f
Icon=lissom
Terminal=false
StartupWMClass=Lissom
Categories=Graphics;2DGraphics;
Keywords=animation;rig;in-between;
MimeType=application/x-lissom;
"""
THUMBNAILER = """\
[Thumbnailer Entry]
TryExec={program}
Exec={quoted} thumbnail %i --out %o --size %s
MimeType=application/x-lissom;
"""
# Texts of the entry, by their keys.
NAMES = {
    "GenericName": N_("2D animation"),
    "Comment": N_("Pose a drawing with a few handles, and get in-betweens that never fold."),
}
PROJECT = N_("Lissom project")
# A project is a zip file whose first member, not packed, identifies it.
MIME_TYPE = """\
<?xml version="1.0" encoding="UTF-8"?>
<mime-info xmlns="http://www.freedesktop.org/standards/shared-mime-info">
  <mime-type type="application/x-lissom">
    <comment>Lissom project</comment>{comments}
    <sub-class-of type="application/zip"/>
    <icon name="lissom"/>
    <magic priority="60">
      <match type="string" offset="0" value="PK\\003\\004">
        <match type="string" offset="30" value="mimetypeapplication/x-lissom"/>
      </match>
    </magic>
    <glob pattern="*.lissom"/>
  </mime-type>
</mime-info>
"""

EPILOG = _(
    """\
On Linux and similar systems this adds Lissom for the current person only, under $XDG_DATA_HOME (or
~/.local/share). Lissom appears in the menu of applications, with its icon, and opens .lissom files.
File managers show thumbnails of them. --remove removes all of this. Install again after Lissom has
moved to another folder.

examples:
  lissom desktop --install
  lissom desktop --remove
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    either = parser.add_mutually_exclusive_group(required=True)
    either.add_argument("--install", action="store_true", help=_("add Lissom to the desktop"))
    either.add_argument("--remove", action="store_true", help=_("remove Lissom from the desktop"))


def run(arguments: argparse.Namespace) -> int:
    """Install Lissom in the desktop, or remove it."""
    if sys.platform in {"win32", "darwin"}:
        raise LissomError(_(OTHER_SYSTEM))
    home = _data_home()
    try:
        if arguments.install:
            _install(home)
            text = _("Lissom is in the applications menu, and opens .lissom files ({folder}).")
        else:
            _remove(home)
            text = _("Lissom is removed from the applications menu ({folder}).")
    except OSError as error:
        raise LissomError(
            _("cannot change {path}: {reason}").format(path=error.filename, reason=error.strerror)
        ) from error
    print_line(text.format(folder=home))
    return 0


def _data_home() -> Path:
    """Return the person's data folder; a relative path in the variable is ignored."""
    chosen = Path(os.environ.get("XDG_DATA_HOME", ""))
    return chosen if chosen.is_absolute() else home_folder() / ".local" / "share"


def _install(home: Path) -> None:
    for place, content in build_desktop_files(_program()).items():
        _write(home / place, content)
    _refresh(home)


def _remove(home: Path) -> None:
    for place in INSTALLED_PATHS:
        (home / place).unlink(missing_ok=True)
    _refresh(home)
    if not list(home.glob("mime/packages/*")):
        for name in MIME_DATABASE:
            (home / "mime" / name).unlink(missing_ok=True)
    if not list(home.glob("applications/*.desktop")):
        (home / "applications" / "mimeinfo.cache").unlink(missing_ok=True)
    folders = {parent for place in INSTALLED_PATHS for parent in Path(place).parents} - {Path()}
    for folder in sorted({*folders, Path("mime/application")}, reverse=True):
        with suppress(OSError):  # it holds other files, or it is gone
            (home / folder).rmdir()


def build_desktop_files(program: str) -> dict[str, bytes]:
    """Return the desktop files for the program at this path, by their places in a data folder."""
    from app.storage import app_icon, decode_picture, draw_thumbnail

    icon = decode_picture(app_icon(), _("the icon of Lissom")).rgba
    languages = {path.stem: read_translations(path) for path in sorted(LOCALE.glob("*.po"))}
    names = [f"{key}={text}\n" for key, text in NAMES.items()] + [
        f"{key}[{code}]={known[text][0]}\n"
        for key, text in NAMES.items()
        for code, known in languages.items()
        if text in known
    ]
    comments = [
        f'\n    <comment xml:lang="{code}">{known[PROJECT][0]}</comment>'
        for code, known in languages.items()
        if PROJECT in known
    ]
    values = {"program": _escaped(program), "quoted": _quoted(program), "names": "".join(names)}
    return {
        ENTRY_AT: os.fsencode(ENTRY.format_map(values)),
        THUMBNAILER_AT: os.fsencode(THUMBNAILER.format_map(values)),
        MIME_TYPE_AT: MIME_TYPE.replace("{comments}", "".join(comments)).encode(),
        **{place: draw_thumbnail(icon, side) for side, place in ICONS_AT.items()},
    }


def _program() -> str:
    """Return the path of the running program; PATH may name another installation first."""
    if getattr(sys, "frozen", False):
        return sys.executable  # a bundle, which has no Python beside it
    own = Path(sysconfig.get_path("scripts")) / PROGRAM
    program = str(own) if own.is_file() else shutil.which(PROGRAM)
    if program is None:
        raise LissomError(
            _("there is no program {name} in {folder}; {remedy}").format(
                name=PROGRAM, folder=own.parent, remedy=_(REINSTALL)
            )
        )
    return program


def _quoted(program: str) -> str:
    """Return a program for an Exec line: quoted as an argument, then escaped as a text."""
    argument = re.sub(r'(["`$\\])', r"\\\1", program).replace("%", "%%")
    return f'"{_escaped(argument)}"'


def _escaped(text: str) -> str:
    """Return a text for the value of an entry, on one line."""
    for plain, escaped in (("\\", r"\\"), ("\n", r"\n"), ("\r", r"\r"), ("\t", r"\t")):
        text = text.replace(plain, escaped)
    return text


def _refresh(home: Path) -> None:
    """Refresh the desktop; after a failure the desktop refreshes itself later."""
    for name, folder in REFRESHERS.items():
        refresher = shutil.which(name)
        if refresher is not None and (home / folder).is_dir():
            with suppress(OSError, subprocess.SubprocessError):
                subprocess.run(  # noqa: S603 - no shell, and no typed input
                    [refresher, home / folder],
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                    timeout=PATIENCE,
                    check=False,
                )
    # The specification of icon themes: a new folder time makes desktops reload icons.
    with suppress(FileNotFoundError):
        os.utime(home / "icons" / "hicolor")


def _write(path: Path, content: bytes) -> None:
    from app.storage import write_atomically

    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, methodcaller("write", content))
