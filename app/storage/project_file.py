"""Saving and opening projects.

A project is a zip file: `mimetype` (first, not packed), `project.json`, `thumbnail.png`, and for
each figure, under `figures/` and its id, the picture byte for byte as `source.*`, the arrays of the
domain, what was cut out by hand, and phi and psi of each key under `keys/` and of the library's
poses under `poses/`. Where the domain has holes, their outlines and cages are under `holes/`, their
centres beside it, and the coefficients of a map's logarithms beside its phi and psi. The maps are
stored, not solved again, so that another solver never changes an animation. Fields and members that
this version does not know are handed on.

A file is input like any other, whoever wrote it. What it would unpack to is known, and limited,
before anything is; pictures and domains are checked; and what holds of a map is not written but
proven anew. However damaged it is, reading takes no more memory than half a gigabyte and some ten
times its size.
"""

import json
import zipfile
from dataclasses import replace
from math import isfinite
from pathlib import Path
from types import MappingProxyType
from typing import IO

import numpy as np

from app.document import Document, Figure, PictureFile
from app.errors import EXPECTED_ERRORS, LissomError
from app.storage.archive import MEBIBYTE, Archive, array_member, write_archive
from app.storage.files import DAMAGED_ZIP, require_file, sync_folder, tail_digest, write_atomically
from app.storage.json_values import JsonObject, as_object, as_text, as_whole, without_repeats
from app.storage.pictures import stored_size
from app.storage.project_json import SCHEMA, read_document, read_size, write_document
from engine.arrays import Complexes, as_points
from engine.domain import MOST_MESH_TRIANGLES, MOST_STROKE_POINTS, Domain, Mask, require_domain
from engine.domain.meshing import Mesh
from engine.domain.outline import LARGEST_OUTLINE
from engine.geometry import Hole
from engine.maps import HarmonicMap

LARGEST_JSON = 32 * MEBIBYTE
# In project.json; a thousand keys of a hundred handles have as many.
MOST_VALUES = 1_000_000
LARGEST_THUMBNAIL = 2 * MEBIBYTE
THUMBNAIL = "thumbnail.png"
KEYS, POSES = "keys", "poses"  # folders of the maps of a figure
CENTRES = "hole_centres.npy"
# Of lists and objects in each other; fields that are not known are kept, and must be writable.
DEEPEST = 40


def save_project(path: Path, document: Document, *, thumbnail: bytes | None = None) -> str:
    """Write a project file; at any moment the old or the new one is whole.

    Parameters
    ----------
    path : Path
        Used exactly as given.
    document : Document
    thumbnail : bytes, optional
        A small PNG picture of the animation.

    Returns
    -------
    str
        What `project_digest` returns as long as nobody else writes there.

    Raises
    ------
    LissomError
        If the file cannot be written.
    """
    content = write_document(document)
    members = {
        "project.json": json.dumps(content, indent=1, sort_keys=True, allow_nan=False).encode(),
    }
    for figure in document.figures:
        members |= _figure_members(figure)
    if thumbnail is not None:
        members[THUMBNAIL] = thumbnail
    # Later versions may know better, but never what this one writes.
    members = {**document.attachments, **members}

    def write(file: IO[bytes]) -> str:
        write_archive(file, members)
        return tail_digest(file)

    digest = write_atomically(path, write)
    sync_folder(path.parent)
    return digest


def project_digest(path: Path) -> str | None:
    """Return what tells the contents of a project file from others; None where there is none.

    Raises
    ------
    LissomError
        If it cannot be read.
    """
    try:
        require_file(path)
        with path.open("rb") as file:
            return tail_digest(file)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise LissomError(f"cannot read {path}: {error.strerror or error}") from error


def load_project(path: Path) -> Document:
    """Read a project file.

    Raises
    ------
    LissomError
        If the file is missing, is no project, was written by a newer version, or is damaged; the
        message says which.
    """
    try:
        size = require_file(path)
        with zipfile.ZipFile(path) as file:
            return _read(Archive(file, size))
    except OSError as error:
        raise LissomError(f"cannot read {path}: {error.strerror or error}") from error
    except EXPECTED_ERRORS as error:
        raise LissomError(f"cannot open {path}: {error}") from error
    except DAMAGED_ZIP as error:
        raise LissomError(f"{path} is not a Lissom project, or it is damaged") from error


def load_thumbnail(path: Path) -> bytes | None:
    """Read only the small PNG picture of a project; None where it has none, or is no project."""
    return load_member(path, THUMBNAIL, LARGEST_THUMBNAIL)


def load_member(path: Path, name: str, largest: int) -> bytes | None:
    """Read only one member of a project; None where it has none such, or is no project."""
    try:
        size = require_file(path)
        with zipfile.ZipFile(path) as file:
            return Archive(file, size).read(name, largest=largest)
    except (OSError, *EXPECTED_ERRORS, *DAMAGED_ZIP):
        return None


def _read(archive: Archive) -> Document:
    content = _read_json(archive)
    schema = as_whole(content["schema"], "schema")
    if schema > SCHEMA:
        app_version = as_text(content.get("app_version", "?"), "app_version")
        raise LissomError(
            f"it was saved by a newer Lissom ({app_version}, schema {schema}); this version reads "
            f"schema {SCHEMA}. Update Lissom to open it"
        )
    if schema < 1:
        raise LissomError(f"its schema {schema} does not exist")
    document = read_document(content, _Parts(archive))
    attachments = {name: archive.read(name) for name in archive.unread if name != THUMBNAIL}
    return replace(document, attachments=MappingProxyType(attachments))


def _figure_members(figure: Figure) -> dict[str, bytes]:
    folder = _folder(figure.id)
    mesh = figure.domain.mesh
    members = {
        f"{folder}/source{figure.picture.suffix}": figure.picture.data,
        f"{folder}/outline.npy": array_member(figure.domain.outline),
        f"{folder}/cage.npy": array_member(figure.domain.cage),
        f"{folder}/vertices.npy": array_member(mesh.vertices),
        f"{folder}/triangles.npy": array_member(mesh.triangles),
    }
    cut_out = figure.cut_out
    if cut_out.mask is not None:
        members[f"{folder}/mask.npy"] = array_member(cut_out.mask.bits)
    if cut_out.strokes:
        points = np.concatenate([stroke.points for stroke in cut_out.strokes])
        members[f"{folder}/strokes.npy"] = array_member(points)
    holes = figure.domain.holes
    if holes:
        centres = np.array([hole.centre for hole in holes], dtype=np.complex128)
        members[f"{folder}/{CENTRES}"] = array_member(centres)
    for index, hole in enumerate(holes):
        outline, cage = _hole_members(figure.id, index)
        members |= {outline: array_member(hole.outline), cage: array_member(hole.cage)}
    keys = [key.pose for key in figure.keys]
    for name, poses in ((KEYS, keys), (POSES, [kept.pose for kept in figure.library])):
        for index, pose in enumerate(poses):
            phi, psi, logs = _coefficient_members(figure.id, name, index)
            members |= {phi: array_member(pose.phi), psi: array_member(pose.psi)}
            if holes:
                members[logs] = array_member(pose.logs)
    return members


def _folder(figure: int) -> str:
    return f"figures/{figure}"


def _coefficient_members(figure: int, name: str, index: int) -> tuple[str, str, str]:
    first = f"{_folder(figure)}/{name}/{index:05}"
    return f"{first}.phi.npy", f"{first}.psi.npy", f"{first}.logs.npy"


def _hole_members(figure: int, index: int) -> tuple[str, str]:
    first = f"{_folder(figure)}/holes/{index:05}"
    return f"{first}.outline.npy", f"{first}.cage.npy"


class _Parts:
    """The pictures and arrays of a project's figures."""

    def __init__(self, archive: Archive) -> None:
        self._archive = archive

    def picture(self, figure: int, content: JsonObject) -> PictureFile:
        suffix = as_text(content["suffix"], f"{content.where}.suffix")
        picture = PictureFile(
            data=self._archive.read(f"{_folder(figure)}/source{suffix}"),
            suffix=suffix,
            size=read_size(content["size"], f"{content.where}.size"),
        )
        if picture.sha256 != as_text(content["sha256"], f"{content.where}.sha256"):
            raise LissomError("its picture is not the one that was saved: the checksums differ")
        # A camera's note on its orientation may have turned it by a quarter.
        size = stored_size(picture.data, "its picture")
        if picture.size not in {size, size[::-1]}:
            raise LissomError(
                f"its picture has {size[0]} × {size[1]} pixels, not {picture.size[0]} × "
                f"{picture.size[1]} as it says"
            )
        return picture

    def domain(self, figure: int) -> Domain:
        folder, read = _folder(figure), self._archive
        outline, cage, vertices = (
            as_points(read.points(f"{folder}/{name}.npy", most=most), name, at_least=3)
            for name, most in (
                ("outline", LARGEST_OUTLINE),
                ("cage", LARGEST_OUTLINE),
                ("vertices", MOST_MESH_TRIANGLES),
            )
        )
        triangles = read.triangles(f"{folder}/triangles.npy", most=MOST_MESH_TRIANGLES)
        domain = Domain(
            outline=outline,
            cage=cage,
            mesh=Mesh(vertices=vertices, triangles=triangles),
            holes=self._holes(figure),
        )
        require_domain(domain)
        return domain

    def mask(self, figure: int, size: tuple[int, int]) -> Mask:
        most = -(-size[0] * size[1] // 8)
        return Mask(bits=self._archive.bytes(f"{_folder(figure)}/mask.npy", most=most), size=size)

    def strokes(self, figure: int) -> Complexes:
        return self._archive.points(f"{_folder(figure)}/strokes.npy", most=MOST_STROKE_POINTS)

    def _holes(self, figure: int) -> tuple[Hole, ...]:
        name, most = f"{_folder(figure)}/{CENTRES}", LARGEST_OUTLINE
        if not self._archive.has(name):
            return ()
        # A hole has three corners at least.
        centres = as_points(self._archive.points(name, most=most // 3), "hole_centres")
        holes = []
        for index, centre in enumerate(centres):
            outline, cage = (
                self._archive.points(member, most=most) for member in _hole_members(figure, index)
            )
            holes.append(Hole(outline=outline, cage=cage, centre=complex(centre)))
        return tuple(holes)

    def key_map(self, figure: int, domain: Domain, key: int) -> HarmonicMap:
        return self._map(domain, *_coefficient_members(figure, KEYS, key))

    def kept_map(self, figure: int, domain: Domain, index: int) -> HarmonicMap:
        return self._map(domain, *_coefficient_members(figure, POSES, index))

    def _map(self, domain: Domain, phi: str, psi: str, logs: str) -> HarmonicMap:
        most, none = LARGEST_OUTLINE, np.empty(0, dtype=np.complex128)
        return HarmonicMap(
            cage=domain.cage,
            phi=self._archive.points(phi, most=most),
            psi=self._archive.points(psi, most=most),
            holes=domain.holes,
            logs=self._archive.points(logs, most=most) if domain.holes else none,
        )


def _read_json(archive: Archive) -> JsonObject:
    text = archive.read("project.json", largest=LARGEST_JSON)
    # Each value but the first stands behind one of these; decoded, it takes some hundred bytes.
    if sum(text.count(mark) for mark in (b",", b"[", b"{")) > MOST_VALUES:
        raise LissomError("its project.json holds more values than any project")
    try:
        content = json.loads(
            text,
            object_pairs_hook=without_repeats,
            parse_float=_finite,
            parse_constant=_finite,
        )
    except RecursionError:
        content = None
    except ValueError as error:
        raise LissomError(f"its project.json is not JSON: {error}") from error
    if content is None or _is_deeper(content, DEEPEST):
        raise LissomError("its project.json is nested too deeply")
    return as_object(content, "project.json")


def _finite(text: str) -> float:
    number = float(text)
    if not isfinite(number):
        raise LissomError(f"its project.json holds {text}, which is not a finite number")
    return number


def _is_deeper(content: object, levels: int) -> bool:
    if isinstance(content, dict):
        content = list(content.values())
    if not isinstance(content, list):
        return False
    return levels == 0 or any(_is_deeper(value, levels - 1) for value in content)
