"""Files of drawing programs that Lissom does not read."""

from pathlib import PurePath
from typing import Final

from app.texts import N_, _

PROGRAM_FILE: Final = N_(
    "{name} is a file of {program}, which Lissom does not read; save the drawing there as "
    "OpenRaster (.ora), Photoshop (.psd) or PNG"
)
PROGRAMS: Final = {
    ".xcf": "GIMP",
    ".clip": "Clip Studio Paint",
    ".lip": "Clip Studio Paint",
    ".aseprite": "Aseprite",
    ".ase": "Aseprite",
    ".tvpp": "TVPaint",
    ".tvp": "TVPaint",
    ".procreate": "Procreate",
    ".sai": "PaintTool SAI",
    ".sai2": "PaintTool SAI",
    ".mdp": "MediBang Paint",
    ".pdn": "Paint.NET",
    ".afphoto": "Affinity Photo",
    ".afdesign": "Affinity Designer",
    ".ai": "Illustrator",
    ".fla": "Animate",
    ".tnz": "OpenToonz",
    ".tlv": "OpenToonz",
    ".rif": "Painter",
    ".svg": "Inkscape",
}


def refuse_program_file(name: str) -> str:
    """Return what to do with the file of another program; empty for other files."""
    program = PROGRAMS.get(PurePath(name).suffix.lower())
    return _(PROGRAM_FILE).format(name=name, program=program) if program else ""
