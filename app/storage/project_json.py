"""The document as `project.json`, except for the picture's bytes and the arrays."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib.metadata import version
from math import inf, isfinite
from types import MappingProxyType
from typing import Any, TypeVar, cast

from app.document import (
    Document,
    Easing,
    ExportSettings,
    FrameRange,
    Framing,
    Handle,
    Keyframe,
    Meshing,
    PictureFile,
    Pose,
    Target,
    Unknown,
    Variant,
)
from app.errors import LissomError
from app.storage.json_values import (
    JsonObject,
    as_flag,
    as_list,
    as_number,
    as_object,
    as_point,
    as_text,
    as_whole,
    shown,
)
from engine.arrays import Complexes
from engine.domain import Domain
from engine.domain.outline import Detail
from engine.maps import Bounds, Certificate

SCHEMA = 1
Json = dict[str, Any]
Value = TypeVar("Value")


def write_document(document: Document) -> Json:
    """Return the fields of a document, those that this version does not know among them."""
    return _with_unknown(
        {
            "schema": SCHEMA,
            "app_version": version("lissom"),
            "picture": {
                "suffix": document.picture.suffix,
                "sha256": document.picture.sha256,
                "size": list(document.picture.size),
            },
            "domain": {
                "detail": document.meshing.detail,
                "triangles": document.meshing.triangles,
                "tolerance": document.meshing.tolerance,
            },
            "handles": [_write_handle(handle) for handle in document.handles],
            "next_handle": document.next_handle,
            "keys": [_write_key(key) for key in document.keys],
            "frames": _write_range(document.frames),
            "work": _write_range(document.work),
            "fps": document.fps,
            "loop": document.loop,
            "anchor": None if document.anchor is None else _write_point(document.anchor),
            "variant": document.variant,
            "bounds": {
                "k": document.bounds.k,
                "sigma_a": document.bounds.sigma_a,
                "sigma_b": document.bounds.sigma_b,
            },
            "export": {
                "format": document.export.format,
                "size": None if document.export.size is None else list(document.export.size),
                "background": document.export.background,
                "framing": document.export.framing,
                "frames": _write_range(document.export.frames),
            },
        },
        document.unknown,
    )


def read_document(
    content: JsonObject,
    *,
    picture: PictureFile,
    domain: Domain,
    coefficients: Callable[[int], tuple[Complexes, Complexes]],
) -> Document:
    """Return the document with these fields.

    Parameters
    ----------
    content : JsonObject
    picture : PictureFile
    domain : Domain
    coefficients : callable
        Returns phi and psi of the key with this index.

    Raises
    ------
    LissomError, EngineError
        If a field is missing or of another kind, or the document would not be valid.
    """
    handles = as_list(content["handles"], "handles")
    keys = as_list(content["keys"], "keys")
    bounds = as_object(content["bounds"], "bounds")
    document = Document(
        picture=picture,
        domain=domain,
        meshing=_read_meshing(as_object(content["domain"], "domain")),
        handles=tuple(_read_handle(handle, f"handles[{i}]") for i, handle in enumerate(handles)),
        next_handle=as_whole(content["next_handle"], "next_handle"),
        keys=tuple(_read_key(key, f"keys[{i}]", *coefficients(i)) for i, key in enumerate(keys)),
        frames=_read_range(content["frames"], "frames"),
        work=_read_optional(content["work"], "work", _read_range),
        fps=as_number(content["fps"], "fps"),
        loop=as_flag(content["loop"], "loop"),
        anchor=_read_optional(content["anchor"], "anchor", as_point),
        variant=cast(Variant, as_text(content["variant"], "variant")),
        bounds=Bounds(
            **{name: as_number(bounds[name], name) for name in ("k", "sigma_a", "sigma_b")}
        ),
        export=_read_export(as_object(content["export"], "export")),
    )
    return replace(document, unknown=_unknown_of(content, write_document(document)))


def read_size(content: object, where: str) -> tuple[int, int]:
    """Return a width and a height in pixels."""
    return _read_pair(content, where)


def _read_meshing(content: JsonObject) -> Meshing:
    return Meshing(
        detail=cast(Detail, as_text(content["detail"], "domain.detail")),
        triangles=as_whole(content["triangles"], "domain.triangles"),
        tolerance=as_whole(content["tolerance"], "domain.tolerance"),
    )


def _read_export(content: JsonObject) -> ExportSettings:
    return ExportSettings(
        format=as_text(content["format"], "export.format"),
        size=_read_optional(content["size"], "export.size", read_size),
        background=as_text(content["background"], "export.background"),
        framing=cast(Framing, as_text(content["framing"], "export.framing")),
        frames=_read_optional(content["frames"], "export.frames", _read_range),
    )


def _write_handle(handle: Handle) -> Json:
    known = {
        "id": handle.id,
        "name": handle.name,
        "position": _write_point(handle.position),
        "weight": handle.weight,
    }
    return _with_unknown(known, handle.unknown)


def _read_handle(content: object, where: str) -> Handle:
    fields = as_object(content, where)
    handle = Handle(
        id=as_whole(fields["id"], f"{where}.id"),
        name=as_text(fields["name"], f"{where}.name"),
        position=as_point(fields["position"], f"{where}.position"),
        weight=as_number(fields["weight"], f"{where}.weight"),
    )
    return replace(handle, unknown=_unknown_of(fields, _write_handle(handle)))


def _write_key(key: Keyframe) -> Json:
    certificate = key.pose.certificate
    known = {
        "frame": key.frame,
        "easing": key.easing.written(),
        "turns": key.turns,
        "targets": [_write_target(i, target) for i, target in key.pose.targets.items()],
        "certificate": {
            "k": _write_number(certificate.k),
            "sigma_a": _write_number(certificate.sigma_a),
            "sigma_b": _write_number(certificate.sigma_b),
            "winding": certificate.winding,
            "certified": certificate.certified,
        },
    }
    return _with_unknown(known, key.unknown)


def _read_key(content: object, where: str, phi: Complexes, psi: Complexes) -> Keyframe:
    fields = as_object(content, where)
    certificate = as_object(fields["certificate"], f"{where}.certificate")
    targets = as_list(fields["targets"], f"{where}.targets")
    read = dict(_read_target(target, f"{where}.targets[{i}]") for i, target in enumerate(targets))
    if len(read) < len(targets):
        raise LissomError(f"{where} has two targets for one handle")
    pose = Pose(targets=read, phi=phi, psi=psi, certificate=_read_certificate(certificate))
    key = Keyframe(
        frame=as_whole(fields["frame"], f"{where}.frame"),
        pose=pose,
        easing=Easing.parse(fields["easing"]),
        turns=as_whole(fields["turns"], f"{where}.turns"),
    )
    return replace(key, unknown=_unknown_of(fields, _write_key(key)))


def _write_target(identity: int, target: Target) -> Json:
    known = {
        "handle": identity,
        "position": _write_point(target.position),
        "rotation": target.rotation,
    }
    return _with_unknown(known, target.unknown)


def _read_target(content: object, where: str) -> tuple[int, Target]:
    fields = as_object(content, where)
    identity = as_whole(fields["handle"], f"{where}.handle")
    target = Target(
        position=as_point(fields["position"], f"{where}.position"),
        rotation=_read_optional(fields["rotation"], f"{where}.rotation", as_number),
    )
    return identity, replace(target, unknown=_unknown_of(fields, _write_target(identity, target)))


def _read_certificate(content: JsonObject) -> Certificate:
    where = content.where

    def number(name: str, infinite: float) -> float:
        read = _read_optional(content[name], f"{where}.{name}", as_number)
        return infinite if read is None else read

    return Certificate(
        k=number("k", inf),
        sigma_a=number("sigma_a", inf),
        sigma_b=number("sigma_b", -inf),
        winding=_read_optional(content["winding"], f"{where}.winding", as_whole),
        certified=as_flag(content["certified"], f"{where}.certified"),
    )


def _write_number(value: float) -> float | None:
    """Return null for what is unbounded: JSON has no infinities."""
    return value if isfinite(value) else None


def _write_point(point: complex) -> list[float]:
    return [point.real, point.imag]


def _write_range(frames: FrameRange | None) -> list[int] | None:
    return None if frames is None else [frames.first, frames.last]


def _read_range(content: object, where: str) -> FrameRange:
    return FrameRange(*_read_pair(content, where))


def _read_pair(content: object, where: str) -> tuple[int, int]:
    numbers = as_list(content, where)
    if len(numbers) != 2:
        raise LissomError(f"{where} must be two whole numbers, not {shown(numbers)}")
    return as_whole(numbers[0], where), as_whole(numbers[1], where)


def _read_optional(
    content: object, where: str, read: Callable[[object, str], Value]
) -> Value | None:
    return None if content is None else read(content, where)


def _unknown_of(content: Mapping[str, Any], known: Json) -> Unknown:
    """Return the fields of `content` that are not `known`, those of inner objects among them."""
    unknown = {}
    for name, value in content.items():
        if name not in known:
            unknown[name] = value
        elif isinstance(value, dict) and isinstance(known[name], dict):
            inner = _unknown_of(value, known[name])
            if inner:
                unknown[name] = inner
    return MappingProxyType(unknown)


def _with_unknown(known: Json, unknown: Unknown) -> Json:
    """Return the known fields with the unknown ones, which never take a known one's place."""
    written = dict(known)
    for name, value in unknown.items():
        if name not in known:
            written[name] = value
        elif isinstance(known[name], dict):
            written[name] = _with_unknown(known[name], value)
    return written
