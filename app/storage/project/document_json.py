"""The document as `project.json`, without its layers' pictures and arrays."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import astuple
from functools import partial
from importlib.metadata import version
from math import inf
from operator import attrgetter
from types import MappingProxyType
from typing import Any, Literal

from app.cut_out import CutLine, CutOut, Stroke
from app.document import (
    CAMERA,
    FOLDING_JOINTS,
    FRAME_NAMES,
    PAIRS,
    SWITCH,
    AppliedMotion,
    Attachment,
    Bone,
    Cycle,
    Document,
    DrawingFile,
    ExportSettings,
    FileLayer,
    FrameRange,
    Group,
    Handle,
    Keyframe,
    Layer,
    LayerOrigin,
    LibraryPose,
    MadeKey,
    Marker,
    Meshing,
    PictureFile,
    PictureSettings,
    Pose,
    Slider,
    SliderPose,
    Spring,
    SwitchGroup,
    TangentMode,
    Target,
    Track,
    TrackKey,
    UnreadMotion,
    require_motions,
    with_directed_bones,
)
from app.errors import EMPTY_IMPORT_LOG, EXPECTED_ERRORS, ImportLog, LissomError, join_names
from app.export_formats import FormatOptions, FormatSettings
from app.rigging import Parameters
from app.storage.json_values import JsonObject, as_list, as_object, as_whole
from app.storage.pictures.parallel import require_memory
from app.storage.project.archive import Archive
from app.storage.project.channel_codecs import CHANNELS, EASING, key_codec
from app.storage.project.codecs import (
    ANYTHING,
    FLAG,
    NUMBER,
    POINT,
    TEXT,
    VALUE,
    WHOLE,
    WHOLE_OR_TEXT,
    Codec,
    Field,
    list_of,
    nested_record,
    optional,
    pair,
    record,
    verbatim,
)
from app.storage.project.earlier_schemas import update_schema
from app.storage.project.footage import FOOTAGE
from app.storage.project.members import LayerMembers, earlier_folder, layer_folder
from app.storage.project.sounds import SOUND, with_sound_files
from app.texts import N_, _, message_of
from engine.domain import Domain
from engine.maps import Boundary, Bounds, Certificate, HarmonicMap, certify

SCHEMA = 6
EARLIER_BONES = N_(
    "Bones of {layers} keep their length from now on. Keys stay as they are until they are posed "
    "again, but frames between them may change."
)
NO_LAYERS: Mapping[int, Layer] = MappingProxyType({})
SIZE = pair(WHOLE, WHOLE, N_("two whole numbers"))
RANGE = pair(WHOLE, WHOLE, N_("two whole numbers"), make=FrameRange, of=astuple)
MARKER = record(Marker, Field("frame", WHOLE), Field("name", TEXT))


def _counts(lines: Sequence[Stroke] | Sequence[CutLine]) -> tuple[int, ...]:
    """Return the number of points of each line."""
    return tuple(len(line.points) for line in lines)


def _of_covered(name: str, layer: Layer) -> tuple[Any, ...]:
    """Return an attribute of each cut line; none if no line has a covered side."""
    lines = layer.cut_out.cut_lines
    has_side = any(line.covered != "none" for line in lines)
    return tuple(getattr(line, name) for line in lines) if has_side else ()


def _read_joints(content: object, where: str) -> dict[str, int]:
    """Return the handles of joints by joint name."""
    joints = as_object(content, where)
    return {name: as_whole(handle, f"{where}.{name}") for name, handle in joints.items()}


def _read_targets(content: object, where: str) -> dict[int, complex]:
    """Return places by handle id."""
    targets = as_object(content, where)
    return {int(handle): POINT.read(at, f"{where}.{handle}") for handle, at in targets.items()}


def _options(usual: FormatOptions) -> Codec:
    """Return the codec of a format's options; the defaults give the kind of each option."""
    kinds: dict[type, Codec] = {bool: FLAG, int: WHOLE}
    named = {name: kinds.get(type(getattr(usual, name))) for name in usual.option_fields()}
    fields = (Field(name, kind or optional(NUMBER)) for name, kind in named.items())
    return nested_record(type(usual), *fields)


EXPORT = nested_record(
    ExportSettings,
    Field("format", TEXT),
    Field("size", optional(SIZE)),
    Field("background", TEXT),
    Field("framing", TEXT),
    Field("frames", optional(RANGE)),
    Field("names", TEXT, legacy_default=FRAME_NAMES),
    Field("sound", FLAG, default=True),
    Field("repeat", WHOLE, default=1),
    Field("speed", NUMBER, default=1.0),
    Field(
        "earlier",
        list_of(
            nested_record(
                PictureSettings,
                Field("format", TEXT),
                Field("size", optional(SIZE)),
                Field("background", TEXT),
            )
        ),
        default=(),
    ),
    *(
        Field(name, _options(usual), legacy_default=usual)
        for name, usual in FormatSettings().options().items()
    ),
)
HANDLE = record(
    Handle,
    Field("id", WHOLE),
    Field("name", TEXT),
    Field("position", POINT),
    Field("weight", NUMBER),
    Field("depth", NUMBER, default=0.0, legacy_name="front"),
    Field("extent", optional(NUMBER), default=None),
    Field("locked", FLAG, default=False),
    Field("group", TEXT, default=""),
    Field("is_unpinned", FLAG, default=False, legacy_name="free"),
)
TARGETS = list_of(
    record(
        lambda handle, **target: (handle, Target(**target)),
        Field("handle", WHOLE, lambda pair: pair[0]),
        Field("position", POINT, lambda pair: pair[1].position),
        Field("rotation", optional(NUMBER), lambda pair: pair[1].rotation),
        Field("side", optional(WHOLE), lambda pair: pair[1].side, default=None),
        unknown=lambda pair: pair[1].unknown,
    )
)
# Keys and poses are read as fields first; their maps are added later.
KEY = record(
    dict,
    Field("frame", WHOLE),
    Field("easing", EASING),
    # Before tangent modes existed, every key was a corner.
    Field("tangent_mode", TEXT, legacy_default=TangentMode.CORNER, legacy_name="passing"),
    Field("revolutions", WHOLE, legacy_name="turns"),
    Field("targets", TARGETS, lambda key: key.pose.targets.items()),
    Field("motion", optional(WHOLE), default=None),
)
LIBRARY_POSE = record(
    dict,
    Field("name", TEXT),
    Field("targets", TARGETS, lambda kept: kept.pose.targets.items()),
)
SLIDER = record(
    Slider,
    Field("name", TEXT),
    Field(
        "poses",
        list_of(
            record(
                SliderPose,
                Field("at", VALUE),
                Field("pose", optional(TEXT)),
                Field("turns", WHOLE, default=0),
            )
        ),
    ),
    Field("value", VALUE, default=0j),
    Field("driver", optional(WHOLE), default=None),
    Field("delay", WHOLE, default=0),
    Field(
        "spring",
        optional(pair(NUMBER, NUMBER, N_("a frequency and a damping"))),
        default=None,
    ),
    Field("enabled", FLAG, default=True),
)
TRACK = record(
    Track,
    Field("handles", list_of(WHOLE)),
    Field("is_scene_space", FLAG, default=False, legacy_name="planted"),
    Field(
        "keys",
        list_of(
            record(
                TrackKey,
                Field("frame", WHOLE),
                Field("place", POINT),
                Field("turn", NUMBER, default=0.0),
                Field("easing", EASING),
                Field("tangent_mode", TEXT, legacy_name="passing"),
                Field("velocity", optional(POINT), default=None),
            )
        ),
    ),
    Field("delay", WHOLE, default=0),
    Field("reach", NUMBER, default=1.0),
    Field("keys_rotation", FLAG, default=False, legacy_name="turns"),
    Field("enabled", FLAG, default=True),
)
SPRING = record(
    Spring,
    Field("handle", WHOLE),
    Field("frequency", NUMBER),
    Field("damping", NUMBER),
    Field("lag", NUMBER, default=0.0),
    Field("strength", NUMBER, default=1.0),
    Field("root", optional(WHOLE), default=None),
    # Before springs had roots, all handles swung freely.
    Field("stretch", NUMBER, legacy_default=1.0),
    Field("enabled", FLAG, default=True),
)
CYCLE = record(
    Cycle,
    Field("first", WHOLE),
    Field("last", WHOLE),
    Field("until", optional(WHOLE)),
)
BONE = record(
    Bone,
    Field("ends", pair(WHOLE, WHOLE, N_("two handles"))),
    Field("stiffness", NUMBER, legacy_name="amount"),
    Field("is_shown", FLAG, default=True),
    Field("is_directed", FLAG, legacy_default=False),
)
MADE_KEY = nested_record(
    MadeKey,
    Field("offset", WHOLE),
    Field(
        "targets",
        Codec(
            lambda targets: {str(handle): POINT.write(at) for handle, at in targets.items()},
            _read_targets,
        ),
    ),
)
APPLIED_MOTION = record(
    AppliedMotion,
    Field("id", WHOLE),
    Field("motion", TEXT),
    Field("kind", TEXT),
    Field(
        "joints",
        Codec(dict, _read_joints),
    ),
    Field("facing", WHOLE),
    Field(
        "parameters",
        nested_record(
            Parameters,
            *(Field(name, NUMBER) for name in ("speed", "size", "energy", "start")),
            *(
                Field(name, NUMBER, default=0.0)
                for name in ("lean", "head_delay", "arm_delay", "tail_delay")
            ),
            *(Field(name, FLAG) for name in ("mirrored", "travel")),
        ),
    ),
    *(Field(name, WHOLE) for name in ("first", "start", "last")),
    Field("repeat_count", WHOLE, legacy_name="rounds"),
    Field("stride", NUMBER, default=0.0),
    Field("digest", TEXT),
    Field("made", list_of(MADE_KEY), default=()),
    Field("springs", list_of(SPRING), default=()),
)


def _write_motions(layer: Layer) -> list[Any]:
    """Return a layer's motions, with unread motions in their places."""
    written = [APPLIED_MOTION.write(motion) for motion in layer.motions]
    for unread in layer.unread_motions:
        written.insert(unread.index, unread.content)
    return written


def _read_motions(content: object, handles: Collection[int]) -> dict[str, Any]:
    """Return a layer's motions, and unknown or unfitting motions apart."""
    motions: list[AppliedMotion] = []
    unread = []
    for index, each in enumerate(as_list(content, "motions")):
        try:
            motion = APPLIED_MOTION.read(each, f"motions[{index}]")
            require_motions([*motions, motion], handles)
        except EXPECTED_ERRORS as error:
            unread.append(UnreadMotion(index=index, content=each, reason=message_of(error)))
        else:
            motions.append(motion)
    return {"motions": tuple(motions), "unread_motions": tuple(unread)}


BACKGROUND = Codec(
    lambda value: list(value) if isinstance(value, tuple) else value,
    lambda content, where: (list_of(WHOLE) if isinstance(content, list) else TEXT).read(
        content, where
    ),
)
STROKE = nested_record(
    dict,
    Field("points", WHOLE, lambda stroke: len(stroke.points)),
    Field("radius", NUMBER),
    Field("keeps", FLAG),
)
# How a layer's domain was built, from the layer.
DOMAIN = nested_record(
    dict,
    Field("detail", TEXT, attrgetter("meshing.detail")),
    Field("triangles", WHOLE, attrgetter("meshing.triangles")),
    Field("tolerance", WHOLE, attrgetter("cut_out.tolerance")),
    Field("background", BACKGROUND, attrgetter("cut_out.background"), legacy_default="auto"),
    Field("enclosed", TEXT, attrgetter("cut_out.enclosed"), legacy_default="keep"),
    Field("mask", FLAG, lambda layer: layer.cut_out.mask is not None, legacy_default=False),
    Field("strokes", list_of(STROKE), attrgetter("cut_out.strokes"), legacy_default=()),
    Field("holes", TEXT, attrgetter("cut_out.holes"), legacy_default="fill"),
    Field(
        "toggled_holes",
        list_of(POINT),
        attrgetter("cut_out.toggled_holes"),
        legacy_default=(),
        legacy_name="swapped",
    ),
    Field(
        "cut_lines",
        list_of(WHOLE),
        lambda layer: _counts(layer.cut_out.cut_lines),
        default=(),
        legacy_name="slits",
    ),
    Field("covered", list_of(TEXT), partial(_of_covered, "covered"), default=()),
    Field("covered_from", list_of(WHOLE), partial(_of_covered, "covered_from"), default=()),
    Field("parted", FLAG, lambda layer: layer.domain.closed is not None, default=False),
    Field("stale", FLAG, attrgetter("is_stale"), legacy_default=False),
)
ATTACHMENT = record(
    Attachment,
    Field("parent", optional(WHOLE), legacy_name="to"),
    Field("parent_point", POINT, legacy_name="at"),
    Field("inherits_rotation", FLAG, legacy_name="turns"),
    Field("rest_rotation", NUMBER, legacy_name="rest"),
    Field("rest_scale", NUMBER, default=1.0),
    Field("frame", WHOLE, default=0),
    Field("offset", POINT, default=0j),
    Field("keep_world_transform", FLAG, default=False, legacy_name="keeps"),
    Field("kept_since", optional(WHOLE), default=None, legacy_name="since"),
    Field("applies_transform", FLAG, default=True),
    Field("blends_to_next", FLAG, default=False, legacy_name="leads"),
)
GROUP = record(
    Group,
    Field("name", TEXT),
    Field("opacity", NUMBER, default=1.0),
    Field("hidden", FLAG, default=False),
    Field("blend", TEXT, default="pass-through"),
    Field("clipped", FLAG, default=False),
)
ORIGIN = nested_record(LayerOrigin, Field("drawing", WHOLE), Field("index", WHOLE))
FILE_LAYER = nested_record(
    FileLayer,
    Field("name", TEXT),
    Field("group", TEXT, default=""),
    Field("number", WHOLE, default=0),
    Field("opacity", NUMBER, default=1.0),
    Field("blend", TEXT, default="normal"),
    Field("clipped", FLAG, default=False),
    Field("hidden", FLAG, default=False),
    Field("is_missing", FLAG, default=False),
)
DRAWING = record(
    DrawingFile,
    Field("id", WHOLE),
    Field("name", TEXT),
    Field("sha256", TEXT),
    Field("size", SIZE),
    Field("corner", POINT, default=0j),
    Field("layers", list_of(FILE_LAYER)),
    Field("groups", list_of(GROUP), default=()),
    Field("is_merged", FLAG, default=False),
)
LAYER_FIELDS = (
    Field("id", WHOLE),
    Field(
        "picture",
        nested_record(dict, Field("suffix", TEXT), Field("sha256", TEXT), Field("size", SIZE)),
    ),
    Field("domain", DOMAIN, verbatim),
    Field("handles", list_of(HANDLE)),
    Field("next_handle", WHOLE),
    Field("keys", list_of(KEY)),
    Field("anchor", optional(POINT)),
    # Before auto-pins existed, handles moved freely between keys.
    Field("has_auto_pins", FLAG, default=False, legacy_name="stillness"),
    Field("tracks", list_of(TRACK), default=()),
    Field("springs", list_of(SPRING), default=()),
    Field("cycles", list_of(CYCLE), default=()),
    Field("bones", list_of(BONE), default=()),
    Field("motions", ANYTHING, _write_motions, default=[]),
    Field("stiffness", FLAG, lambda layer: layer.stiffness is not None, default=False),
    Field("variant", TEXT),
    Field(
        "bounds",
        nested_record(Bounds, *(Field(name, NUMBER) for name in ("k", "sigma_a", "sigma_b"))),
    ),
    Field("library", list_of(LIBRARY_POSE)),
    Field("sliders", list_of(SLIDER), default=()),
    Field("mirror", optional(NUMBER)),
    # Properties of a layer among others; a scene of one layer writes none of them.
    Field("name", TEXT, default="layer"),
    Field("corner", POINT, default=0j),
    Field("still", FLAG, default=False),
    Field("footage", optional(FOOTAGE), default=None),
    Field("reference", FLAG, default=False),
    Field("locked", FLAG, default=False),
    Field("hidden", FLAG, default=False),
    Field("opacity", NUMBER, default=1.0),
    Field(
        "channels",
        CHANNELS,
        lambda layer: (layer.channels, layer.unread_channels),
        default=({}, ()),
    ),
    Field("blend", TEXT, default="normal"),
    Field("clipped", FLAG, default=False),
    Field("group", TEXT, default=""),
    # Its attachments: the first one, and the later ones.
    Field(
        "attachment", optional(ATTACHMENT), lambda each: (*each.attachments, None)[0], default=None
    ),
    Field("handovers", list_of(ATTACHMENT), lambda each: each.attachments[1:], default=()),
    Field("origin", optional(ORIGIN), default=None),
    Field("closed_seam", optional(WHOLE), default=None),
    Field("ik_parents", optional(WHOLE), default=None),
    Field("pole_side", WHOLE, default=0),
)
LAYER = record(
    dict,
    *LAYER_FIELDS,
    Field("deform_group", optional(WHOLE), default=None),
    # A member as it was before, with the same fields.
    Field("before_bending", optional(record(dict, *LAYER_FIELDS)), default=None),
)
IMPORT_LOG = nested_record(
    ImportLog,
    Field("warnings", list_of(TEXT), legacy_name="losses"),
    Field("notes", list_of(TEXT), legacy_name="matters"),
)
SWITCH_GROUP = record(
    lambda layers, **fields: SwitchGroup(members=layers, **fields),
    Field("name", TEXT),
    Field("layers", list_of(WHOLE_OR_TEXT), attrgetter("members"), legacy_name="figures"),
    Field("keys", list_of(key_codec(SWITCH))),
)
DOCUMENT = record(
    dict,
    Field("schema", WHOLE, lambda _: SCHEMA),
    Field("app_version", ANYTHING, lambda _: version("lissom"), legacy_default=None),
    Field("layers", list_of(LAYER), legacy_name="figures"),
    Field("frames", RANGE),
    Field("preview", optional(RANGE)),
    Field("markers", list_of(MARKER)),
    Field("fps", NUMBER),
    Field("loop", FLAG),
    Field("export", EXPORT),
    Field("size", optional(SIZE), default=None),
    Field("pairs", list_of(pair(TEXT, TEXT, N_("two words"))), default=PAIRS),
    Field("switch_groups", list_of(SWITCH_GROUP), default=(), legacy_name="choices"),
    Field("groups", list_of(GROUP), default=()),
    Field("camera", list_of(key_codec(CAMERA)), default=()),
    Field("sounds", list_of(SOUND), default=()),
    Field("drawings", list_of(DRAWING), default=()),
    Field("import_log", IMPORT_LOG, default=EMPTY_IMPORT_LOG, legacy_name="told"),
)


def write_document(document: Document) -> dict[str, Any]:
    """Return the fields of a document, with the unknown ones."""
    written: dict[str, Any] = DOCUMENT.write(document)
    return written


def read_document(
    content: JsonObject, archive: Archive, known: Mapping[int, Layer] = NO_LAYERS
) -> Document:
    """Return the document with these fields, and with the pictures and arrays of an archive.

    Layers in `known`, by id, are not read again from a just written archive; they come first.

    Raises `LissomError` or `EngineError` if a field is missing or of another kind, or the document
    would be invalid.
    """
    update_schema(content)
    if known:
        others = [each for each in content["layers"] if each["id"] not in known]
        content = JsonObject({**content, "layers": others}, content.where)
    fields = DOCUMENT.read(content, "")
    del fields["schema"], fields["app_version"]
    layers = fields.pop("layers")
    fields["sounds"] = with_sound_files(fields["sounds"], archive)
    if len({layer["id"] for layer in layers}) < len(layers):
        # Refused here: later each layer's members would be read twice.
        raise LissomError(_("two of its layers have the same id"))
    earlier = [each["name"] for each in layers if any(map(_is_earlier_limb, each["bones"]))]
    if earlier:
        note = _(EARLIER_BONES).format(layers=join_names(earlier))
        fields["import_log"] += ImportLog(notes=(note,))
    shared: dict[str, PictureFile] = {}
    read = tuple(
        _read_layer(layer, LayerMembers(archive, layer_folder(layer["id"])), shared)
        for layer in layers
    )
    if not archive.is_written:
        require_memory(picture.size for picture in {layer.picture for layer in read})
    return Document(layers=(*known.values(), *read), **fields)


def _read_layer(
    fields: dict[str, Any], members: LayerMembers, shared: dict[str, PictureFile]
) -> Layer:
    """Return the layer with these fields, its maps certified again.

    Its picture is taken from or added to `shared`, by checksum.
    """
    made, earlier, archive = fields.pop("domain"), fields.get("before_bending"), members.archive
    if earlier is not None:
        folder = earlier_folder(fields["id"])
        fields["before_bending"] = _read_layer(earlier, LayerMembers(archive, folder), shared)
    picture = members.picture(**fields["picture"])
    same = shared.setdefault(picture.sha256, picture)
    if (same.suffix, same.size) == (picture.suffix, picture.size):
        picture = same
    domain = members.domain(parted=made.pop("parted"))
    proven = _unproven if archive.is_written else _prover(domain, _widest_bounds(fields))

    def pose(kind: Literal["keys", "poses"], index: int, given: tuple[Any, ...]) -> Pose:
        targets, f = dict(given), members.map(domain, kind, index)
        if len(targets) < len(given):
            raise LissomError(
                _("one of its {kind} has two targets for the same handle").format(kind=kind)
            )
        return Pose.of(f, targets, proven(f))

    motions = _read_motions(fields.pop("motions"), {handle.id for handle in fields["handles"]})
    first, later = fields.pop("attachment"), fields.pop("handovers")
    fields["channels"], unread_channels = fields["channels"]
    for index, key in enumerate(fields["keys"]):
        key["pose"] = pose("keys", index, key.pop("targets"))
    for index, kept in enumerate(fields["library"]):
        kept["pose"] = pose("poses", index, kept.pop("targets"))
    layer = Layer(
        **fields
        | motions
        | {
            "picture": picture,
            "unread_channels": unread_channels,
            "attachments": (*(() if first is None else (first,)), *later),
            "domain": domain,
            "meshing": Meshing(detail=made.pop("detail"), triangles=made.pop("triangles")),
            "is_stale": made.pop("stale"),
            "stiffness": members.stiffness(domain) if fields["stiffness"] else None,
            "cut_out": _cut_out(made, members, picture.size),
            "keys": tuple(Keyframe(**key) for key in fields["keys"]),
            "library": tuple(LibraryPose(**kept) for kept in fields["library"]),
        }
    )
    return with_directed_bones(layer)


def _is_earlier_limb(bone: Bone) -> bool:
    """Whether a bone was only stiff when it was saved, and keeps its length from now on."""
    return not bone.is_directed and bone.stiffness > 1


def _widest_bounds(fields: Mapping[str, Any]) -> Bounds:
    """Return the limits that poses of a layer with these fields may have anywhere."""
    bounds: Bounds = fields["bounds"]
    has_limbs = any(bone.is_limb for bone in fields["bones"])
    return bounds.joined(FOLDING_JOINTS) if has_limbs else bounds


def _prover(domain: Domain, bounds: Bounds) -> Callable[[HarmonicMap], Certificate]:
    """Return a function that certifies maps of a domain."""
    boundary = Boundary.sample(domain)
    return lambda f: certify(f, boundary, bounds)


def _unproven(_: HarmonicMap) -> Certificate:
    """Return the certificate of an uncertified map."""
    return Certificate(k=inf, sigma_a=inf, sigma_b=-inf, winding=None, is_certified=False)


def _cut_out(fields: dict[str, Any], members: LayerMembers, size: tuple[int, int]) -> CutOut:
    strokes = fields.pop("strokes")
    lines = members.lines("slits", fields["cut_lines"])
    covered = fields.pop("covered") or ("none",) * len(lines)
    starts = fields.pop("covered_from") or (0,) * len(lines)
    if not len(covered) == len(starts) == len(lines):
        raise LissomError(
            _("the covered sides are of {count} knife lines, not {lines}").format(
                count=len(covered), lines=len(lines)
            )
        )
    ways = members.lines("strokes", [stroke.pop("points") for stroke in strokes])
    return CutOut(
        **fields
        | {
            "mask": members.mask(size) if fields["mask"] else None,
            "strokes": tuple(
                Stroke(points=way, **stroke) for stroke, way in zip(strokes, ways, strict=True)
            ),
            "cut_lines": tuple(
                CutLine(points=way, covered=side, covered_from=start)
                for way, side, start in zip(lines, covered, starts, strict=True)
            ),
        }
    )
