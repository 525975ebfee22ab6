"""The document as `project.json`, except for its layers' pictures and arrays."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import astuple
from importlib.metadata import version
from math import inf
from operator import attrgetter
from types import MappingProxyType
from typing import Any, Literal

from app.document import (
    FRAME_NAMES,
    PAIRS,
    Attachment,
    Bone,
    CameraKey,
    Choice,
    Cycle,
    Document,
    Easing,
    ExportSettings,
    FormatPictures,
    FrameRange,
    GivenMotion,
    Group,
    Handle,
    KeptPose,
    Keyframe,
    Layer,
    Marker,
    Meshing,
    MoveKey,
    OpacityKey,
    Passing,
    PictureFile,
    Placing,
    Pose,
    Spring,
    Switch,
    Target,
    Track,
    TrackKey,
    Turn,
    UnreadMotion,
    require_motions,
)
from app.errors import EXPECTED_ERRORS, NOTHING_TOLD, ImportSummary, LissomError
from app.export_formats import FormatOptions, FormatSettings
from app.storage.json_values import (
    ANYTHING,
    FLAG,
    NUMBER,
    POINT,
    TEXT,
    WHOLE,
    Codec,
    Field,
    JsonObject,
    as_it_is,
    as_list,
    as_object,
    as_whole,
    optional,
    pair,
    part,
    record,
    several,
)
from app.storage.pictures import require_memory
from app.storage.project.archive import Archive
from app.storage.project.members import LayerMembers
from engine.domain import CutOut, Domain, Slit, Stroke
from engine.geometry.motions import Parameters
from engine.maps import Boundary, Bounds, Certificate, HarmonicMap, certify

SCHEMA = 3
NOTHING: Mapping[int, Layer] = MappingProxyType({})
SIZE = pair(WHOLE, WHOLE, "two whole numbers")
RANGE = pair(WHOLE, WHOLE, "two whole numbers", make=FrameRange, of=astuple)
MARKER = record(Marker, Field("frame", WHOLE), Field("name", TEXT))


def _counts(lines: Sequence[Stroke] | Sequence[Slit]) -> tuple[int, ...]:
    """Return how many points each of some lines has."""
    return tuple(len(line.points) for line in lines)


def _read_joints(content: object, where: str) -> dict[str, int]:
    """Return the handles of joints by their names."""
    joints = as_object(content, where)
    return {name: as_whole(handle, f"{where}.{name}") for name, handle in joints.items()}


def _options(usual: FormatOptions) -> Codec:
    """Return how the options of a format are held; of which kinds they are, the usual ones tell."""
    kinds: dict[type, Codec] = {bool: FLAG, int: WHOLE}
    named = {name: kinds.get(type(getattr(usual, name))) for name in usual.asked()}
    fields = (Field(name, kind or optional(NUMBER)) for name, kind in named.items())
    return part(type(usual), *fields)


EXPORT = part(
    ExportSettings,
    Field("format", TEXT),
    Field("size", optional(SIZE)),
    Field("background", TEXT),
    Field("framing", TEXT),
    Field("frames", optional(RANGE)),
    Field("names", TEXT, earlier=FRAME_NAMES),
    Field(
        "earlier",
        several(
            part(
                FormatPictures,
                Field("format", TEXT),
                Field("size", optional(SIZE)),
                Field("background", TEXT),
            )
        ),
        usual=(),
    ),
    *(
        Field(name, _options(usual), earlier=usual)
        for name, usual in FormatSettings().options().items()
    ),
)
HANDLE = record(
    Handle,
    Field("id", WHOLE),
    Field("name", TEXT),
    Field("position", POINT),
    Field("weight", NUMBER),
    Field("front", NUMBER, usual=0.0),
    Field("extent", optional(NUMBER), usual=None),
    Field("locked", FLAG, usual=False),
    Field("group", TEXT, usual=""),
    Field("free", FLAG, usual=False),
)
FRONTS = several(pair(WHOLE, NUMBER, "a handle and a number"))
TARGETS = several(
    record(
        lambda handle, **target: (handle, Target(**target)),
        Field("handle", WHOLE, lambda pair: pair[0]),
        Field("position", POINT, lambda pair: pair[1].position),
        Field("rotation", optional(NUMBER), lambda pair: pair[1].rotation),
        unknown=lambda pair: pair[1].unknown,
    )
)
# Keys and poses are read as their fields, which have no map yet.
EASING = Codec(Easing.written, lambda content, _: Easing.parse(content))
KEY = record(
    dict,
    Field("frame", WHOLE),
    Field("easing", EASING),
    # Before there were passings, every key had a corner.
    Field("passing", TEXT, earlier=Passing.CORNER),
    Field("turns", WHOLE),
    Field("targets", TARGETS, lambda key: key.pose.targets.items()),
    Field("fronts", FRONTS, lambda key: tuple(key.fronts.items()), usual=()),
)
KEPT_POSE = record(
    dict,
    Field("name", TEXT),
    Field("targets", TARGETS, lambda kept: kept.pose.targets.items()),
)
TRACK = record(
    Track,
    Field("handles", several(WHOLE)),
    Field("planted", FLAG, usual=False),
    Field(
        "keys",
        several(
            record(
                TrackKey,
                Field("frame", WHOLE),
                Field("place", POINT),
                Field("turn", NUMBER, usual=0.0),
                Field("easing", EASING),
                Field("passing", TEXT),
                Field("velocity", optional(POINT), usual=None),
            )
        ),
    ),
    Field("delay", WHOLE, usual=0),
    Field("reach", NUMBER, usual=1.0),
    Field("turns", FLAG, usual=False),
    Field("enabled", FLAG, usual=True),
)
SPRING = record(
    Spring,
    Field("handle", WHOLE),
    Field("frequency", NUMBER),
    Field("damping", NUMBER),
    Field("lag", NUMBER, usual=0.0),
    Field("strength", NUMBER, usual=1.0),
    Field("root", optional(WHOLE), usual=None),
    # Before springs had roots, all of them swung freely.
    Field("stretch", NUMBER, earlier=1.0),
    Field("enabled", FLAG, usual=True),
)
CYCLE = record(
    Cycle,
    Field("first", WHOLE),
    Field("last", WHOLE),
    Field("until", optional(WHOLE)),
)
BONE = record(
    Bone,
    Field("ends", pair(WHOLE, WHOLE, "two handles")),
    Field("amount", NUMBER),
    Field("is_shown", FLAG, usual=True),
)
MOTION = record(
    GivenMotion,
    Field("motion", TEXT),
    Field("kind", TEXT),
    Field(
        "joints",
        Codec(dict, _read_joints),
    ),
    Field("facing", WHOLE),
    Field(
        "parameters",
        part(
            Parameters,
            *(Field(name, NUMBER) for name in ("speed", "size", "energy", "start")),
            *(Field(name, FLAG) for name in ("mirrored", "travel")),
        ),
    ),
    *(Field(name, WHOLE) for name in ("first", "start", "last", "rounds")),
    Field("digest", TEXT),
)


def _write_motions(layer: Layer) -> list[Any]:
    """Return a layer's motions, with those that were not read in their places."""
    written = [MOTION.write(motion) for motion in layer.motions]
    for unread in layer.unread_motions:
        written.insert(unread.index, unread.content)
    return written


def _read_motions(content: object, handles: Collection[int]) -> dict[str, Any]:
    """Return a layer's motions, and those that are not known here, or do not fit."""
    motions: list[GivenMotion] = []
    unread = []
    for index, each in enumerate(as_list(content, "motions")):
        try:
            motion = MOTION.read(each, f"motions[{index}]")
            require_motions([*motions[-1:], motion], handles)
        except EXPECTED_ERRORS as error:
            unread.append(UnreadMotion(index=index, content=each, reason=str(error)))
        else:
            motions.append(motion)
    return {"motions": tuple(motions), "unread_motions": tuple(unread)}


BACKGROUND = Codec(
    lambda value: list(value) if isinstance(value, tuple) else value,
    lambda content, where: (several(WHOLE) if isinstance(content, list) else TEXT).read(
        content, where
    ),
)
STROKE = part(
    dict,
    Field("points", WHOLE, lambda stroke: len(stroke.points)),
    Field("radius", NUMBER),
    Field("keeps", FLAG),
)
# How a layer's domain was made, from the layer.
DOMAIN = part(
    dict,
    Field("detail", TEXT, attrgetter("meshing.detail")),
    Field("triangles", WHOLE, attrgetter("meshing.triangles")),
    Field("tolerance", WHOLE, attrgetter("cut_out.tolerance")),
    Field("background", BACKGROUND, attrgetter("cut_out.background"), earlier="auto"),
    Field("enclosed", TEXT, attrgetter("cut_out.enclosed"), earlier="keep"),
    Field("mask", FLAG, lambda layer: layer.cut_out.mask is not None, earlier=False),
    Field("strokes", several(STROKE), attrgetter("cut_out.strokes"), earlier=()),
    Field("holes", TEXT, attrgetter("cut_out.holes"), earlier="fill"),
    Field("swapped", several(POINT), attrgetter("cut_out.swapped"), earlier=()),
    Field("slits", several(WHOLE), lambda layer: _counts(layer.cut_out.slits), usual=()),
    Field("parted", FLAG, lambda layer: layer.domain.closed is not None, usual=False),
    Field("stale", FLAG, attrgetter("is_stale"), earlier=False),
)
SWITCH = pair(WHOLE, FLAG, "a frame and true or false", make=Switch, of=astuple)
ATTACHMENT = record(
    Attachment,
    Field("to", optional(WHOLE)),
    Field("at", POINT),
    Field("turns", FLAG),
    Field("rest", NUMBER),
    Field("frame", WHOLE, usual=0),
    Field("offset", POINT, usual=0j),
    Field("keeps", FLAG, usual=False),
    Field("since", optional(WHOLE), usual=None),
    Field("leads", FLAG, usual=False),
)
WAY = (Field("frame", WHOLE), Field("easing", EASING), Field("passing", TEXT))
CAMERA = several(
    record(CameraKey, *WAY, Field("centre", POINT), Field("zoom", NUMBER), Field("turn", NUMBER))
)
MOVEMENT = several(record(MoveKey, *WAY, Field("shift", POINT), Field("turn", NUMBER)))
OPACITIES = several(record(OpacityKey, *WAY, Field("opacity", NUMBER)))
PLACINGS = several(
    part(
        Placing,
        Field("frame", WHOLE),
        Field("beside", optional(WHOLE)),
        Field("in_front", FLAG),
    )
)
GROUP = record(
    Group,
    Field("name", TEXT),
    Field("opacity", NUMBER, usual=1.0),
    Field("hidden", FLAG, usual=False),
    Field("blend", TEXT, usual="pass-through"),
    Field("clipped", FLAG, usual=False),
)
LAYER = record(
    dict,
    Field("id", WHOLE),
    Field("picture", part(dict, Field("suffix", TEXT), Field("sha256", TEXT), Field("size", SIZE))),
    Field("domain", DOMAIN, as_it_is),
    Field("handles", several(HANDLE)),
    Field("next_handle", WHOLE),
    Field("keys", several(KEY)),
    Field("anchor", optional(POINT)),
    # Before there was stillness, handles moved as they liked between keys.
    Field("stillness", FLAG, usual=False),
    Field("tracks", several(TRACK), usual=()),
    Field("springs", several(SPRING), usual=()),
    Field("cycles", several(CYCLE), usual=()),
    Field("bones", several(BONE), usual=()),
    Field("motions", ANYTHING, _write_motions, usual=[]),
    Field("stiffness", FLAG, lambda layer: layer.stiffness is not None, usual=False),
    Field("variant", TEXT),
    Field("bounds", part(Bounds, *(Field(name, NUMBER) for name in ("k", "sigma_a", "sigma_b")))),
    Field("library", several(KEPT_POSE)),
    Field("mirror", optional(NUMBER)),
    # What it is as a layer: a scene of one layer says none of it.
    Field("name", TEXT, usual="layer"),
    Field("corner", POINT, usual=0j),
    Field("still", FLAG, usual=False),
    Field("reference", FLAG, usual=False),
    Field("locked", FLAG, usual=False),
    Field("hidden", FLAG, usual=False),
    Field("switches", several(SWITCH), usual=()),
    Field("opacity", NUMBER, usual=1.0),
    Field("opacities", OPACITIES, usual=()),
    Field("movement", MOVEMENT, usual=()),
    Field("placings", PLACINGS, usual=()),
    Field("blend", TEXT, usual="normal"),
    Field("clipped", FLAG, usual=False),
    Field("group", TEXT, usual=""),
    # Its joints: the first one, and those that come later.
    Field("attachment", optional(ATTACHMENT), lambda each: (*each.joints, None)[0], usual=None),
    Field("handovers", several(ATTACHMENT), lambda each: each.joints[1:], usual=()),
)
TOLD = part(ImportSummary, Field("losses", several(TEXT)), Field("matters", several(TEXT)))
CHOICE = record(
    Choice,
    Field("name", TEXT),
    Field("layers", several(WHOLE), was="figures"),
    Field("turns", several(pair(WHOLE, WHOLE, "a frame and a layer", make=Turn, of=tuple))),
)
DOCUMENT = record(
    dict,
    Field("schema", WHOLE, lambda _: SCHEMA),
    Field("app_version", ANYTHING, lambda _: version("lissom"), earlier=None),
    Field("layers", several(LAYER), was="figures"),
    Field("frames", RANGE),
    Field("preview", optional(RANGE)),
    Field("markers", several(MARKER)),
    Field("fps", NUMBER),
    Field("loop", FLAG),
    Field("export", EXPORT),
    Field("size", optional(SIZE), usual=None),
    Field("pairs", several(pair(TEXT, TEXT, "two words")), usual=PAIRS),
    Field("choices", several(CHOICE), usual=()),
    Field("groups", several(GROUP), usual=()),
    Field("camera", CAMERA, usual=()),
    Field("told", TOLD, usual=NOTHING_TOLD),
)


def write_document(document: Document) -> dict[str, Any]:
    """Return the fields of a document, those that this version does not know among them."""
    written: dict[str, Any] = DOCUMENT.write(document)
    return written


def read_document(
    content: JsonObject, archive: Archive, known: Mapping[int, Layer] = NOTHING
) -> Document:
    """Return the document with these fields, and with the pictures and arrays of an archive.

    Of an archive that was just written, layers that are `known` by their ids are not read again;
    they come first.

    Raises
    ------
    LissomError, EngineError
        If a field is missing or of another kind, or the document would not be valid.
    """
    if as_whole(content["schema"], "schema") == 1:
        _bring_up_to_schema_2(content)
    if known:
        others = [each for each in content["layers"] if each["id"] not in known]
        content = JsonObject({**content, "layers": others}, content.where)
    fields = DOCUMENT.read(content, "")
    del fields["schema"], fields["app_version"]
    layers = fields.pop("layers")
    if len({layer["id"] for layer in layers}) < len(layers):
        # Told before their members are read, once for each.
        raise LissomError("two of its layers have the same id")
    shared: dict[str, PictureFile] = {}
    read = tuple(_read_layer(layer, archive, shared) for layer in layers)
    if not archive.is_written:
        require_memory(picture.size for picture in {layer.picture for layer in read})
    return Document(layers=(*known.values(), *read), **fields)


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
        {**as_object(layer, f"figures[{i}]"), "library": [], "mirror": None}
        for i, layer in enumerate(as_list(content["figures"], "figures"))
    ]


def _read_layer(fields: dict[str, Any], archive: Archive, shared: dict[str, PictureFile]) -> Layer:
    """Return the layer with these fields; what holds of its maps is proven anew.

    Its picture is one of those that are `shared`, by their checksums, or becomes one.
    """
    members, made = LayerMembers(archive, fields["id"]), fields.pop("domain")
    picture = members.picture(**fields["picture"])
    same = shared.setdefault(picture.sha256, picture)
    if (same.suffix, same.size) == (picture.suffix, picture.size):
        picture = same
    domain = members.domain(parted=made.pop("parted"))
    proven = _unproven if archive.is_written else _prover(domain, fields["bounds"])

    def pose(kind: Literal["keys", "poses"], index: int, given: tuple[Any, ...]) -> Pose:
        targets, f = dict(given), members.map(domain, kind, index)
        if len(targets) < len(given):
            raise LissomError(f"one of its {kind} has two targets for one handle")
        return Pose.of(f, targets, proven(f))

    motions = _read_motions(fields.pop("motions"), {handle.id for handle in fields["handles"]})
    first, later = fields.pop("attachment"), fields.pop("handovers")
    for index, key in enumerate(fields["keys"]):
        key["pose"] = pose("keys", index, key.pop("targets"))
        key["fronts"] = dict(key["fronts"])
    for index, kept in enumerate(fields["library"]):
        kept["pose"] = pose("poses", index, kept.pop("targets"))
    return Layer(
        **fields
        | motions
        | {
            "picture": picture,
            "joints": (*(() if first is None else (first,)), *later),
            "domain": domain,
            "meshing": Meshing(detail=made.pop("detail"), triangles=made.pop("triangles")),
            "is_stale": made.pop("stale"),
            "stiffness": members.stiffness(domain) if fields["stiffness"] else None,
            "cut_out": _cut_out(made, members, picture.size),
            "keys": tuple(Keyframe(**key) for key in fields["keys"]),
            "library": tuple(KeptPose(**kept) for kept in fields["library"]),
        }
    )


def _prover(domain: Domain, bounds: Bounds) -> Callable[[HarmonicMap], Certificate]:
    """Return what proves maps of a domain."""
    boundary = Boundary.sample(domain)
    return lambda f: certify(f, boundary, bounds)


def _unproven(_: HarmonicMap) -> Certificate:
    """Return the certificate of a map of which nothing is said."""
    return Certificate(k=inf, sigma_a=inf, sigma_b=-inf, winding=None, certified=False)


def _cut_out(fields: dict[str, Any], members: LayerMembers, size: tuple[int, int]) -> CutOut:
    strokes = fields.pop("strokes")
    ways = members.lines("strokes", [stroke.pop("points") for stroke in strokes])
    return CutOut(
        **fields
        | {
            "mask": members.mask(size) if fields["mask"] else None,
            "strokes": tuple(
                Stroke(points=way, **stroke) for stroke, way in zip(strokes, ways, strict=True)
            ),
            "slits": tuple(Slit(points=way) for way in members.lines("slits", fields["slits"])),
        }
    )
