"""Make a Debian package of the folder that PyInstaller made: `python debian.py FOLDER OUT`.

It runs in the environment that the folder was made in, whose Lissom has the texts for desktops.
"""

import gzip
import os
import re
import shutil
import subprocess
import sys
import tempfile
from importlib.metadata import metadata, version
from pathlib import Path
from typing import Final

import contents

from app.cli.commands import desktop

HOME: Final = "usr/lib/lissom"
# What draws, without a graphics card, too; what a window on X11 asks for when it opens, and what
# the bundle leaves to the system lest an older one keep the system's drivers from loading.
DEPENDS: Final = (
    *("libgl1", "libegl1", "libgl1-mesa-dri", "libgcc-s1", "libstdc++6", "zlib1g", "libexpat1"),
    *("libx11-6", "libxext6", "libxrandr2", "libxinerama1", "libxcursor1", "libxi6", "libxrender1"),
)
# The system's file dialogs, its file manager, pictures on the clipboard, and Wayland.
RECOMMENDS: Final = (
    *("zenity | kdialog", "xdg-utils", "xclip | wl-clipboard", "shared-mime-info"),
    *("desktop-file-utils", "hicolor-icon-theme", "libxkbcommon0", "libdecor-0-0"),
    *("libwayland-client0", "libwayland-cursor0", "libwayland-egl1"),
)
CONTROL: Final = """\
Package: lissom
Version: {version}
Architecture: {architecture}
Maintainer: The Lissom project <lissom@localhost>
Installed-Size: {size}
Depends: libc6 (>= {libc}), {depends}
Recommends: {recommends}
Section: graphics
Priority: optional
Description: pose a drawing with a few handles, and animate it
 Load a drawing, drag handles to pose it, set keyframes on a timeline, and get
 in-betweens that never fold, tear or shrink. Export them as frames, as a video,
 or as a small model that plays in game engines and browsers.
"""
COPYRIGHT: Final = """\
Lissom comes with a Python and with libraries. Their licences lie below
/{home}/_internal, each in the folder NAME-VERSION.dist-info.
PyAV brings FFmpeg, x264 and x265, which are under the GNU General Public
License, version 2 or later (/usr/share/common-licenses/GPL-2): who hands this
package on keeps to it.

{libraries}

Lissom itself:

{licence}"""


def main(folder: Path, out: Path) -> None:
    """Write OUT/lissom_VERSION_ARCHITECTURE.deb."""
    architecture = told("dpkg", "--print-architecture")
    with tempfile.TemporaryDirectory(dir=out) as scratch:
        root = Path(scratch)
        root.chmod(0o755)
        for place, content in files(folder).items():
            write(root / place, content)
        shutil.copytree(folder, root / HOME, symlinks=True)
        (root / "usr/bin").mkdir()
        (root / "usr/bin/lissom").symlink_to(f"../{HOME.removeprefix('usr/')}/lissom")
        sizes = [path.lstat().st_size for path in root.rglob("*") if path.is_file()]
        control = CONTROL.format(
            version=version("lissom"),
            architecture=architecture,
            size=sum(-(-size // 1024) for size in sizes),
            libc=newest_libc(folder),
            depends=", ".join(DEPENDS),
            recommends=", ".join(RECOMMENDS),
        )
        write(root / "DEBIAN/control", control.encode())
        package = out / f"lissom_{version('lissom')}_{architecture}.deb"
        told("dpkg-deb", "--root-owner-group", "-Zxz", "-z3", "--build", str(root), str(package))


def files(folder: Path) -> dict[str, bytes]:
    """Return what the package has beside the folder, by its place."""
    entries = desktop.build_desktop_files("/usr/bin/lissom")
    (licence,) = folder.glob("_internal/lissom-*.dist-info/licenses/LICENSE")
    libraries = "\n".join(
        f"{name} {version(name)}: {licence_of(name)}"
        for name in contents.DISTRIBUTIONS
        if name != "lissom"
    )
    copyright_ = COPYRIGHT.format(home=HOME, libraries=libraries, licence=licence.read_text())
    changelog = Path(__file__).parents[2] / "CHANGELOG.md"
    return {
        **{f"usr/share/{place}": content for place, content in entries.items()},
        "usr/share/doc/lissom/copyright": copyright_.encode(),
        "usr/share/doc/lissom/changelog.gz": gzip.compress(changelog.read_bytes(), mtime=0),
    }


def licence_of(name: str) -> str:
    """Return what a library says in one line about its licence."""
    said = metadata(name)
    classes = (line.rpartition(" :: ")[2] for line in said.get_all("Classifier", ()))
    licences = ", ".join(line for line in classes if "License" in line)
    return said.get("License-Expression") or licences or said.get("License", "see its folder")


def newest_libc(folder: Path) -> str:
    """Return the lowest version of the C library with which all of the folder loads."""
    versions = {(2, 17)}
    for path in folder.rglob("*"):
        if path.is_file() and not path.is_symlink() and path.open("rb").read(4) == b"\x7fELF":
            found = re.findall(r"\bGLIBC_(\d+)\.(\d+)", told("objdump", "-p", str(path)))
            versions |= {(int(major), int(minor)) for major, minor in found}
    return ".".join(map(str, max(versions)))


def told(*words: str) -> str:
    """Return what a program prints."""
    environment = {**os.environ, "LC_ALL": "C"}
    done = subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True, env=environment)  # noqa: S603
    return done.stdout.strip()


def write(path: Path, content: bytes) -> None:
    """Write a file that everybody may read, with its folders."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    path.chmod(0o644)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
