"""The document as `project.json`, except for the picture's bytes and the arrays."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from functools import partial
from importlib.metadata import version
from types import MappingProxyType
from typing import Any, Literal, Protocol, TypeVar, cast

import numpy as np

from app.document import (
    FRAME_NAMES,
    Attachment,
    Document,
    Easing,
    ExportSettings,
    Figure,
    FrameRange,
    Framing,
    Handle,
    KeptPose,
    Keyframe,
    Marker,
    Meshing,
    Passing,
    PictureFile,
    Pose,
    Switch,
    Target,
    Unknown,
    Variant,
)
from app.errors import LissomError
from app.export_formats import FormatOptions, FormatSettings
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
from engine.domain import CutOut, Domain, Mask, Stroke
from engine.domain.outline import Detail
from engine.domain.picture import Enclosed, Holes
from engine.maps import Boundary, Bounds, HarmonicMap, certify

SCHEMA = 2
# What a figure is as a layer unless it is written otherwise: a scene of one figure says none of it.
USUAL_LAYER: dict[str, Any] = {
    "name": "figure",
    "corner": [0.0, 0.0],
    "still": False,
    "reference": False,
    "locked": False,
    "hidden": False,
    "switches": [],
    "opacity": 1.0,
    "attachment": None,
}
Json = dict[str, Any]
Value = TypeVar("Value")


class FigureParts(Protocol):
    """What a project holds of its figures besides `project.json`, by their ids."""

    def picture(self, figure: int, content: JsonObject) -> PictureFile:
        """Return the picture that these fields tell of."""

    def domain(self, figure: int) -> Domain:
        """Return the domain."""

    def mask(self, figure: int, size: tuple[int, int]) -> Mask:
        """Return the mask of its cut-out."""

    def strokes(self, figure: int) -> Complexes:
        """Return the points of all strokes of its cut-out."""

    def key_map(self, figure: int, domain: Domain, key: int) -> HarmonicMap:
        """Return the map of the key with this index."""

    def kept_map(self, figure: int, domain: Domain, index: int) -> HarmonicMap:
        """Return the map of the library's pose with this index."""


def write_document(document: Document) -> Json:
    """Return the fields of a document, those that this version does not know among them."""
    known: Json = {
        "schema": SCHEMA,
        "app_version": version("lissom"),
        "figures": [_write_figure(figure) for figure in document.figures],
        "frames": _write_range(document.frames),
        "preview": _write_range(document.preview),
        "markers": [_write_marker(marker) for marker in document.markers],
        "fps": document.fps,
        "loop": document.loop,
        "export": {
            "format": document.export.format,
            "size": None if document.export.size is None else list(document.export.size),
            "background": document.export.background,
            "framing": document.export.framing,
            "frames": _write_range(document.export.frames),
            "names": document.export.names,
            **{name: asdict(options) for name, options in document.export.options().items()},
        },
    }
    if document.size is not None:
        known["size"] = list(document.size)
    return _with_unknown(known, document.unknown)


def read_document(content: JsonObject, parts: FigureParts) -> Document:
    """Return the document with these fields.

    Parameters
    ----------
    content : JsonObject
    parts : FigureParts
        What of the figures is not written in JSON.

    Raises
    ------
    LissomError, EngineError
        If a field is missing or of another kind, or the document would not be valid.
    """
    if as_whole(content["schema"], "schema") < SCHEMA:
        _bring_up_to_schema_2(content)
    figures = [
        as_object(figure, f"figures[{i}]")
        for i, figure in enumerate(as_list(content["figures"], "figures"))
    ]
    identities = [as_whole(figure["id"], f"{figure.where}.id") for figure in figures]
    if len(set(identities)) < len(identities):
        # Told before their parts are read, once for each.
        raise LissomError("two of its figures have the same id")
    document = Document(
        figures=tuple(_read_figure(figure, parts) for figure in figures),
        frames=_read_range(content["frames"], "frames"),
        preview=_read_optional(content["preview"], "preview", _read_range),
        markers=tuple(
            _read_marker(marker, f"markers[{i}]")
            for i, marker in enumerate(as_list(content["markers"], "markers"))
        ),
        fps=as_number(content["fps"], "fps"),
        loop=as_flag(content["loop"], "loop"),
        export=_read_export(as_object(content["export"], "export")),
        size=_read_optional(content.get("size"), "size", read_size),
    )
    known = {"size": None, **write_document(document)}
    return replace(document, unknown=_unknown_of(content, known))


def _bring_up_to_schema_2(content: JsonObject) -> None:
    """Give the fields of schema 1 those that came with schema 2, so that nothing looks different.

    What played was what was exported, unless exports had frames of their own.
    """
    work = content.pop("work")
    content |= {"preview": work, "markers": []}
    export = as_object(content["export"], "export")
    if export["frames"] is None:
        content["export"] = {**export, "frames": work}
    content["figures"] = [
        {**as_object(figure, f"figures[{i}]"), "library": [], "mirror": None}
        for i, figure in enumerate(as_list(content["figures"], "figures"))
    ]


def _write_figure(figure: Figure) -> Json:
    known = {
        "id": figure.id,
        "picture": {
            "suffix": figure.picture.suffix,
            "sha256": figure.picture.sha256,
            "size": list(figure.picture.size),
        },
        "domain": {
            "detail": figure.meshing.detail,
            "triangles": figure.meshing.triangles,
            **_write_cut_out(figure.cut_out),
            "stale": figure.is_stale,
        },
        "handles": [_write_handle(handle) for handle in figure.handles],
        "next_handle": figure.next_handle,
        "keys": [_write_key(key) for key in figure.keys],
        "anchor": None if figure.anchor is None else _write_point(figure.anchor),
        "variant": figure.variant,
        "bounds": {
            "k": figure.bounds.k,
            "sigma_a": figure.bounds.sigma_a,
            "sigma_b": figure.bounds.sigma_b,
        },
        "library": [_write_kept(kept) for kept in figure.library],
        "mirror": figure.mirror,
        **_write_layer(figure),
    }
    return _with_unknown(known, figure.unknown)


def _write_layer(figure: Figure) -> Json:
    """Return how a figure stands among others; what is as usual is left out."""
    joint = figure.attachment
    fields: Json = {
        "name": figure.name,
        "corner": _write_point(figure.corner),
        "still": figure.still,
        "reference": figure.reference,
        "locked": figure.locked,
        "hidden": figure.hidden,
        "switches": [[switch.frame, switch.visible] for switch in figure.switches],
        "opacity": figure.opacity,
        "attachment": None
        if joint is None
        else {
            "to": joint.to,
            "at": _write_point(joint.at),
            "turns": joint.turns,
            "rest": joint.rest,
        },
    }
    return {name: value for name, value in fields.items() if value != USUAL_LAYER[name]}


def _read_layer(fields: JsonObject) -> dict[str, Any]:
    where = fields.where
    given = {**USUAL_LAYER, **fields}
    return {
        "name": as_text(given["name"], f"{where}.name"),
        "corner": as_point(given["corner"], f"{where}.corner"),
        **{
            name: as_flag(given[name], f"{where}.{name}")
            for name in ("still", "reference", "locked", "hidden")
        },
        "switches": tuple(
            _read_switch(switch, f"{where}.switches[{i}]")
            for i, switch in enumerate(as_list(given["switches"], f"{where}.switches"))
        ),
        "opacity": as_number(given["opacity"], f"{where}.opacity"),
        "attachment": _read_optional(given["attachment"], f"{where}.attachment", _read_attachment),
    }


def _read_switch(content: object, where: str) -> Switch:
    pair = as_list(content, where)
    if len(pair) != 2:
        raise LissomError(f"{where} must be a frame and true or false, not {shown(pair)}")
    return Switch(as_whole(pair[0], where), as_flag(pair[1], where))


def _read_attachment(content: object, where: str) -> Attachment:
    fields = as_object(content, where)
    return Attachment(
        to=as_whole(fields["to"], f"{where}.to"),
        at=as_point(fields["at"], f"{where}.at"),
        turns=as_flag(fields["turns"], f"{where}.turns"),
        rest=as_number(fields["rest"], f"{where}.rest"),
    )


def _read_figure(fields: JsonObject, parts: FigureParts) -> Figure:
    where = fields.where
    identity = as_whole(fields["id"], f"{where}.id")
    handles = as_list(fields["handles"], f"{where}.handles")
    keys = as_list(fields["keys"], f"{where}.keys")
    library = as_list(fields["library"], f"{where}.library")
    bounds = _read_bounds(as_object(fields["bounds"], f"{where}.bounds"))
    picture = parts.picture(identity, as_object(fields["picture"], f"{where}.picture"))
    domain = parts.domain(identity)
    meshing = as_object(fields["domain"], f"{where}.domain")
    boundary = Boundary.sample(domain.outline, domain.cage, domain.holes)

    def pose(f: HarmonicMap, targets: Mapping[int, Target]) -> Pose:
        proven = certify(f, boundary, bounds)
        return Pose(targets=targets, phi=f.phi, psi=f.psi, logs=f.logs, certificate=proven)

    figure = Figure(
        id=identity,
        picture=picture,
        domain=domain,
        meshing=_read_meshing(meshing),
        cut_out=_read_cut_out(meshing, identity, picture, parts),
        is_stale=as_flag(meshing.get("stale", False), f"{meshing.where}.stale"),
        handles=tuple(
            _read_handle(handle, f"{where}.handles[{i}]") for i, handle in enumerate(handles)
        ),
        next_handle=as_whole(fields["next_handle"], f"{where}.next_handle"),
        keys=tuple(
            _read_key(key, f"{where}.keys[{i}]", partial(pose, parts.key_map(identity, domain, i)))
            for i, key in enumerate(keys)
        ),
        anchor=_read_optional(fields["anchor"], f"{where}.anchor", as_point),
        variant=cast(Variant, as_text(fields["variant"], f"{where}.variant")),
        bounds=bounds,
        library=tuple(
            _read_kept(
                kept, f"{where}.library[{i}]", partial(pose, parts.kept_map(identity, domain, i))
            )
            for i, kept in enumerate(library)
        ),
        mirror=_read_optional(fields["mirror"], f"{where}.mirror", as_number),
        **_read_layer(fields),
    )
    known = {**USUAL_LAYER, **_write_figure(figure)}
    return replace(figure, unknown=_unknown_of(fields, known))


def _read_bounds(content: JsonObject) -> Bounds:
    names = ("k", "sigma_a", "sigma_b")
    return Bounds(**{name: as_number(content[name], f"{content.where}.{name}") for name in names})


def read_size(content: object, where: str) -> tuple[int, int]:
    """Return a width and a height in pixels."""
    return _read_pair(content, where)


def _read_meshing(content: JsonObject) -> Meshing:
    return Meshing(
        detail=cast(Detail, as_text(content["detail"], f"{content.where}.detail")),
        triangles=as_whole(content["triangles"], f"{content.where}.triangles"),
    )


def _write_cut_out(cut_out: CutOut) -> Json:
    background = cut_out.background
    return {
        "tolerance": cut_out.tolerance,
        "background": list(background) if isinstance(background, tuple) else background,
        "enclosed": cut_out.enclosed,
        "mask": cut_out.mask is not None,
        "strokes": [
            {"points": len(stroke.points), "radius": stroke.radius, "keeps": stroke.keeps}
            for stroke in cut_out.strokes
        ],
        "holes": cut_out.holes,
        "swapped": [_write_point(point) for point in cut_out.swapped],
    }


def _read_cut_out(
    content: JsonObject, figure: int, picture: PictureFile, parts: FigureParts
) -> CutOut:
    """Read a cut-out; files of before there was more of it than the tolerance have no more."""
    where = content.where
    strokes = [
        as_object(stroke, f"{where}.strokes[{i}]")
        for i, stroke in enumerate(as_list(content.get("strokes", []), f"{where}.strokes"))
    ]
    has_mask = as_flag(content.get("mask", False), f"{where}.mask")
    points = parts.strokes(figure) if strokes else np.empty(0, dtype=np.complex128)
    counts = [as_whole(stroke["points"], f"{stroke.where}.points") for stroke in strokes]
    if min(counts, default=1) < 1 or sum(counts) != len(points):
        raise LissomError(f"{where}.strokes do not have as many points as there are")
    ways = np.split(points, np.cumsum(counts)[:-1]) if counts else []
    background = content.get("background", "auto")
    return CutOut(
        tolerance=as_whole(content["tolerance"], f"{where}.tolerance"),
        # Checked there.
        background=cast(
            "Literal['auto', 'none']",
            tuple(as_whole(level, f"{where}.background") for level in background)
            if isinstance(background, list)
            else as_text(background, f"{where}.background"),
        ),
        enclosed=cast(Enclosed, as_text(content.get("enclosed", "keep"), f"{where}.enclosed")),
        mask=parts.mask(figure, picture.size) if has_mask else None,
        strokes=tuple(
            Stroke(
                points=way,
                radius=as_number(stroke["radius"], f"{stroke.where}.radius"),
                keeps=as_flag(stroke["keeps"], f"{stroke.where}.keeps"),
            )
            for stroke, way in zip(strokes, ways, strict=True)
        ),
        holes=cast(Holes, as_text(content.get("holes", "fill"), f"{where}.holes")),
        swapped=tuple(
            as_point(point, f"{where}.swapped[{i}]")
            for i, point in enumerate(as_list(content.get("swapped", []), f"{where}.swapped"))
        ),
    )


def _read_export(content: JsonObject) -> ExportSettings:
    return ExportSettings(
        format=as_text(content["format"], "export.format"),
        size=_read_optional(content["size"], "export.size", read_size),
        background=as_text(content["background"], "export.background"),
        framing=cast(Framing, as_text(content["framing"], "export.framing")),
        frames=_read_optional(content["frames"], "export.frames", _read_range),
        # Earlier versions did not know the rest.
        names=as_text(content.get("names", FRAME_NAMES), "export.names"),
        **{
            name: _read_options(
                as_object(content.get(name, asdict(usual)), f"export.{name}"), usual
            )
            for name, usual in FormatSettings().options().items()
        },
    )


def _read_options(content: JsonObject, usual: FormatOptions) -> FormatOptions:
    """Return the options of a format; which they are, and of which kinds, the usual ones tell."""
    read: dict[str, Any] = {}
    for name in usual.asked():
        where = f"{content.where}.{name}"
        match getattr(usual, name):
            case bool():
                read[name] = as_flag(content[name], where)
            case int():
                read[name] = as_whole(content[name], where)
            case _:
                read[name] = _read_optional(content[name], where, as_number)
    return replace(usual, **read)


def _write_handle(handle: Handle) -> Json:
    known = {
        "id": handle.id,
        "name": handle.name,
        "position": _write_point(handle.position),
        "weight": handle.weight,
    }
    if handle.front:
        known["front"] = handle.front
    if handle.extent is not None:
        known["extent"] = handle.extent
    if handle.locked:
        known["locked"] = True
    if handle.group:
        known["group"] = handle.group
    return _with_unknown(known, handle.unknown)


def _read_handle(content: object, where: str) -> Handle:
    fields = as_object(content, where)
    handle = Handle(
        id=as_whole(fields["id"], f"{where}.id"),
        name=as_text(fields["name"], f"{where}.name"),
        position=as_point(fields["position"], f"{where}.position"),
        weight=as_number(fields["weight"], f"{where}.weight"),
        front=as_number(fields.get("front", 0.0), f"{where}.front"),
        extent=_read_optional(fields.get("extent"), f"{where}.extent", as_number),
        locked=as_flag(fields.get("locked", False), f"{where}.locked"),
        group=as_text(fields.get("group", ""), f"{where}.group"),
    )
    optional = dict.fromkeys(("front", "extent", "locked", "group"))
    known = {**optional, **_write_handle(handle)}
    return replace(handle, unknown=_unknown_of(fields, known))


def _write_key(key: Keyframe) -> Json:
    known: Json = {
        "frame": key.frame,
        "easing": key.easing.written(),
        "passing": key.passing,
        "turns": key.turns,
        "targets": _write_targets(key.pose),
    }
    if key.fronts:
        known["fronts"] = [[handle, front] for handle, front in key.fronts.items()]
    return _with_unknown(known, key.unknown)


def _read_key(
    content: object, where: str, pose: Callable[[Mapping[int, Target]], Pose]
) -> Keyframe:
    fields = as_object(content, where)
    key = Keyframe(
        frame=as_whole(fields["frame"], f"{where}.frame"),
        pose=pose(_read_targets(fields)),
        easing=Easing.parse(fields["easing"]),
        # Projects from before there were passings have a corner at every key.
        passing=cast(Passing, as_text(fields.get("passing", Passing.CORNER), f"{where}.passing")),
        turns=as_whole(fields["turns"], f"{where}.turns"),
        fronts=_read_fronts(fields.get("fronts", []), f"{where}.fronts"),
    )
    return replace(key, unknown=_unknown_of(fields, {"fronts": None, **_write_key(key)}))


def _read_fronts(content: object, where: str) -> dict[int, float]:
    fronts = {}
    for i, pair in enumerate(as_list(content, where)):
        numbers = as_list(pair, f"{where}[{i}]")
        if len(numbers) != 2:
            raise LissomError(f"{where}[{i}] must be a handle and a number, not {shown(numbers)}")
        fronts[as_whole(numbers[0], where)] = as_number(numbers[1], where)
    return fronts


def _write_kept(kept: KeptPose) -> Json:
    known = {"name": kept.name, "targets": _write_targets(kept.pose)}
    return _with_unknown(known, kept.unknown)


def _read_kept(
    content: object, where: str, pose: Callable[[Mapping[int, Target]], Pose]
) -> KeptPose:
    fields = as_object(content, where)
    name = as_text(fields["name"], f"{where}.name")
    kept = KeptPose(name=name, pose=pose(_read_targets(fields)))
    return replace(kept, unknown=_unknown_of(fields, _write_kept(kept)))


def _write_targets(pose: Pose) -> list[Json]:
    return [_write_target(i, target) for i, target in pose.targets.items()]


def _read_targets(fields: JsonObject) -> Mapping[int, Target]:
    where = fields.where
    targets = as_list(fields["targets"], f"{where}.targets")
    read = dict(_read_target(target, f"{where}.targets[{i}]") for i, target in enumerate(targets))
    if len(read) < len(targets):
        raise LissomError(f"{where} has two targets for one handle")
    return read


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


def _write_marker(marker: Marker) -> Json:
    return _with_unknown({"frame": marker.frame, "name": marker.name}, marker.unknown)


def _read_marker(content: object, where: str) -> Marker:
    fields = as_object(content, where)
    marker = Marker(
        frame=as_whole(fields["frame"], f"{where}.frame"),
        name=as_text(fields["name"], f"{where}.name"),
    )
    return replace(marker, unknown=_unknown_of(fields, _write_marker(marker)))


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
