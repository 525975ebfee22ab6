"""Several layers as members of one mesh: bent as one, drawn apart, saved, and parted again."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from layered import openraster
from numpy.testing import assert_allclose
from PIL import Image, ImageDraw

from app.document import (
    DRAW_ORDER,
    OPACITY,
    VISIBILITY,
    Attachment,
    Channel,
    Document,
    DrawOrder,
    ExportSettings,
    FrameRange,
    Meshing,
    channel_commands,
    cycle_commands,
    deform_group_commands,
    group_commands,
    handle_commands,
    key_commands,
    layer_commands,
    opacity_at,
)
from app.document.commands import scene_commands
from app.document.keyframe import Target
from app.errors import LissomError
from app.export import ExportRequest, FrameRenderer, MeshExport, plan_export
from app.motion import Evaluator
from app.render.gpu.context import create_context
from app.solving import (
    DragSolver,
    Rig,
    bend_as_one,
    find_drawing,
    part_deform_group,
    plan_reload,
    pose_document,
    replace_member_picture,
    start_reload,
    step_reload,
    suggest_deform_groups,
)
from app.solving.script.pose_script import parse_pose_script
from app.storage import (
    Picture,
    cut_picture,
    encode_png,
    flatten_layers,
    load_project,
    make_still_layer,
    make_still_picture,
    open_layered,
    read_drawing,
    save_project,
)

SIZE = (200, 120)
MESHING = Meshing(triangles=1_000, detail="coarse")
BODY = [(30, 60), (60, 30), (140, 30), (170, 60), (140, 90), (60, 90)]


def drawn(paint):
    image = Image.new("RGBA", SIZE)
    paint(ImageDraw.Draw(image))
    return image


INK = drawn(lambda draw: draw.line([*BODY, BODY[0]], fill=(20, 10, 30, 255), width=4))
SHADE = drawn(lambda draw: draw.rectangle((60, 62, 140, 88), fill=(60, 20, 120, 130)))
COLOUR = drawn(lambda draw: draw.polygon(BODY, fill=(240, 150, 60, 255)))
BUBBLE = drawn(lambda draw: draw.ellipse((90, 40, 130, 80), fill=(80, 200, 240, 255)))
SKY = Image.new("RGBA", SIZE, (210, 230, 250, 255))
STACK = {"ink": INK, "bubble": BUBBLE, "shade": SHADE, "colour": COLOUR, "sky": SKY}
NAMES = ("colour", "shade", "ink")


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    path = tmp_path_factory.mktemp("group") / "fish.ora"
    tags = "".join(
        f'<layer name="{name}" src="data/{number}.png" x="0" y="0"/>'
        for number, name in enumerate(STACK)
    )
    path.write_bytes(openraster(SIZE, tags, [*STACK.values()]))
    return open_layered(path, MESHING)


@pytest.fixture(scope="module")
def bent(opened):
    """Colour, shade and ink as members of a posed deform group, and all pictures by layer id."""
    document, pictures = opened.document, dict(opened.pictures)
    made = bend_as_one(document, ids(document, NAMES), pictures, name="fish")
    assert made.notices == ()
    document = made.command(document)
    pictures[made.group.id] = made.picture
    return posed(document, made.group.id), pictures


def by_name(document, name):
    return next(layer for layer in document.layers if layer.name == name)


def ids(document, names):
    return [by_name(document, name).id for name in names]


def posed(document, identity, to=168 + 100j):
    """Return a document with two handles on a layer, and a key at frame 10 that bends it."""
    for place in (32 + 60j, 168 + 60j):
        document = handle_commands.add_handle(identity, place)(document)
    layer = document.layer(identity)
    targets = {handle.id: Target(position=handle.position) for handle in layer.handles}
    targets[layer.handles[-1].id] = Target(position=to)
    drag = DragSolver.begin(Rig.of(layer), layer.keys[0].pose).step_towards(targets, 60)
    return key_commands.insert_key(identity, 10, drag.make_pose(targets))(document)


def frames(document: Document, pictures: dict[int, Picture], *times: float) -> list[np.ndarray]:
    """Return frames of a document on clear ground, straight alpha."""
    settings = ExportSettings(format="picture", framing="canvas")
    request = ExportRequest(out=Path("a.png"), settings=settings, project="fish")
    evaluator, context = Evaluator.exact(document), create_context()
    textures = {
        layer.id: cut_picture(pictures[layer.id], layer.cut_out).texture
        for layer in document.layers
    }
    plan = plan_export(document, request, evaluator)
    renderer = FrameRenderer(context, document, textures, evaluator, plan)
    found = [renderer.draw(renderer.pose(time)) for time in times]
    renderer.release()
    context.release()
    return found


def premultiplied(pixels):
    return pixels[..., :3] * (pixels[..., 3:] / 255)


def test_members_move_as_one_flattened_picture(bent):
    document, pictures = bent
    group = by_name(document, "fish")
    for name in ("sky", "bubble"):
        document = layer_commands.remove_layer(by_name(document, name).id)(document)
    flat = Image.new("RGBA", SIZE)
    for each in (COLOUR, SHADE, INK):
        flat.alpha_composite(each)
    # The group's own picture, drawn alone on the same mesh.
    alone = replace(document, layers=(group,), size=document.canvas)
    apart = frames(document, pictures, 0, 5, 10)
    whole = frames(alone, pictures, 0, 5, 10)
    assert_allclose(premultiplied(whole[0]), premultiplied(np.asarray(flat)), atol=2)
    assert (apart[2] != apart[0]).any(axis=-1).sum() > 2_000
    for one, other in zip(apart, whole, strict=True):
        # Filtered before or after compositing, pixels of edges differ by some levels.
        difference = np.abs(premultiplied(one) - premultiplied(other))
        assert difference.mean() < 0.2
        assert (difference > 24).mean() < 2e-3


def test_a_layer_between_two_members_stays_between_them(bent):
    document, pictures = bent
    (frame,) = frames(document, pictures, 0)
    below, through = frame[120 - 50, 110], frame[120 - 50, 145]
    assert below.tolist() == [80, 200, 240, 255]
    assert through.tolist() != below.tolist()
    ink = by_name(document, "ink")
    above = layer_commands.move_layer(by_name(document, "bubble").id, 5)(document)
    assert by_name(above, "ink").deform_group == ink.deform_group
    hidden = layer_commands.set_hidden(ink.deform_group, hidden=True)(document)
    (rest,) = frames(hidden, pictures, 0)
    assert rest[60, 45].tolist() == [210, 230, 250, 255]


def test_members_have_opacity_blend_and_visibility_of_their_own(bent):
    document, pictures = bent
    colour, shade = by_name(document, "colour"), by_name(document, "shade")
    faded = document.with_layer(colour.with_keys_of(OPACITY, (OPACITY.key(0, 0.5),)))
    faded = layer_commands.set_blend(shade.id, "multiply")(faded)
    faded = layer_commands.key_visibility(shade.id, 5, visible=False)(faded)
    shown, gone = frames(faded, pictures, 0, 6)
    sky, orange = np.array([210, 230, 250]), np.array([240, 150, 60])
    assert_allclose(shown[50, 80, :3], (sky + orange) / 2, atol=2)
    below = (sky + orange) / 2
    purple, alpha = np.array([60, 20, 120]), 130 / 255
    expected = (1 - alpha) * below + alpha * below * purple / 255
    assert_allclose(shown[75, 80, :3], expected, atol=2)
    assert (VISIBILITY.name, None) in by_name(faded, "shade").channels
    assert_allclose(gone[75, 80, :3], below, atol=2)


def test_a_group_is_solved_and_moved_once(bent):
    document, _ = bent
    group = by_name(document, "fish")
    evaluator = Evaluator.exact(document)
    assert group.id in evaluator.layers
    assert not evaluator.layers.keys() & {*ids(document, NAMES)}
    scene = evaluator.evaluate(document, 5)
    shared = {id(scene.layers[each].vertices) for each in ids(document, NAMES)}
    assert len(shared) == 1
    assert group.id not in scene.layers


def test_projects_keep_groups_and_what_members_had(bent, tmp_path):
    document, pictures = bent
    save_project(tmp_path / "a.lissom", document)
    again = load_project(tmp_path / "a.lissom")
    before, after = frames(document, pictures, 5), frames(again, pictures, 5)
    assert (before[0] == after[0]).all()
    ink = by_name(again, "ink")
    assert ink.before_bending is not None
    assert not ink.before_bending.still
    assert ink.before_bending.picture is ink.picture


def test_parting_gives_back_meshes_handles_and_keys(opened):
    document, pictures = opened.document, opened.pictures
    ink = by_name(document, "ink")
    document = posed(document, ink.id, 168 + 75j)
    colour, bubble = by_name(document, "colour"), by_name(document, "bubble")
    joint = Attachment(parent=colour.id, parent_point=110 + 60j)
    document = layer_commands.attach_layer(bubble.id, 110 + 60j, joint)(document)
    rigged = document.layer(ink.id)
    made = bend_as_one(document, ids(document, NAMES), pictures)
    group = made.command(document)
    whole = group.layer(made.group.id)
    assert [handle.position for handle in whole.handles] == [
        handle.position for handle in rigged.handles
    ]
    assert [key.frame for key in whole.keys] == [0, 10]
    assert group.layer(bubble.id).attachments[0].parent == whole.id
    changed = layer_commands.set_opacity(ink.id, 0.5)(group)
    command, notices = part_deform_group(changed, whole.id, pictures)
    parted = command(changed)
    assert notices == ()
    assert [layer.name for layer in parted.layers] == [layer.name for layer in document.layers]
    assert parted.layer(ink.id).keys == rigged.keys
    assert parted.layer(ink.id).opacity == 0.5
    assert parted.layer(bubble.id).attachments[0].parent in {*ids(document, NAMES)}
    assert not any(layer.deform_group for layer in parted.layers)


def test_members_have_no_motion_of_their_own(bent):
    document, _ = bent
    ink, group = by_name(document, "ink"), by_name(document, "fish")
    joint = Attachment(parent=by_name(document, "bubble").id, parent_point=110 + 60j)
    with pytest.raises(LissomError, match="member of a deform group"):
        layer_commands.attach_layer(ink.id, ink.pivot, joint)(document)
    with pytest.raises(LissomError, match="attach it to the deform group"):
        layer_commands.attach_layer(
            by_name(document, "bubble").id, 110 + 60j, replace(joint, parent=ink.id)
        )(document)
    with pytest.raises(LissomError, match="neither still nor a member"):
        layer_commands.replace_layer(group.id, make_still_layer(group))(document)


def test_groups_are_copied_and_deleted_with_their_members(bent):
    document, _ = bent
    group = by_name(document, "fish")
    two = deform_group_commands.duplicate_deform_group(group.id)(document)
    copy = by_name(two, "fish copy")
    assert [each.name for each in two.deform_members(copy.id)] == [f"{name} copy" for name in NAMES]
    one = layer_commands.remove_layer(copy.id)(two)
    assert [each.name for each in one.layers] == [each.name for each in document.layers]
    for name in NAMES:
        one = layer_commands.remove_layer(by_name(one, name).id)(one)
    assert [each.name for each in one.layers] == ["sky", "bubble"]


def test_layers_that_cannot_be_members_are_refused(bent):
    document, pictures = bent
    with pytest.raises(LissomError, match="at least two"):
        bend_as_one(document, ids(document, ["bubble"]), pictures)
    with pytest.raises(LissomError, match="ink"):
        bend_as_one(document, ids(document, ["bubble", "ink"]), pictures)


def test_a_reload_of_members_rebuilds_their_group(bent, tmp_path):
    document, pictures = bent
    group = by_name(document, "fish")
    path = tmp_path / "fish.ora"
    horned = drawn(lambda draw: draw.polygon([*BODY, (80, 10), (60, 30)], fill=(240, 150, 60, 255)))
    moved = {**STACK, "colour": horned}
    tags = "".join(
        f'<layer name="{name}" src="data/{number}.png" x="0" y="0"/>'
        for number, name in enumerate(moved)
    )
    path.write_bytes(openraster(SIZE, tags, [*moved.values()]))
    drawing = find_drawing(document, path.name)
    plan = plan_reload(document, drawing, read_drawing(path), pictures)
    reloading = start_reload(plan)
    while not reloading.is_over:
        reloading = step_reload(reloading)
    after = reloading.command(document)
    whole = after.layer(group.id)
    assert whole.covers(np.array([75 + 95j])).all()
    assert not group.covers(np.array([75 + 95j])).any()
    assert [handle.position for handle in whole.handles] == [
        handle.position for handle in group.handles
    ]
    assert by_name(after, "colour").deform_group == group.id
    new = {
        each.id: reloading.pictures.get(each.picture, pictures[each.id]) for each in after.layers
    }
    (frame,) = frames(after, new, 0)
    assert frame[25, 75].tolist() == [240, 150, 60, 255]
    # The member's mesh of its own follows once it is alone again.
    command, notices = part_deform_group(after, group.id, new)
    assert len(notices) == 1
    assert by_name(command(after), "colour").covers(np.array([75 + 95j])).all()


def test_a_member_with_another_picture_changes_the_shape_of_its_group(bent):
    document, pictures = bent
    group, colour = by_name(document, "fish"), by_name(document, "colour")
    tall = drawn(lambda draw: draw.rectangle((60, 4, 140, 110), fill=(240, 150, 60, 255)))
    picture = Picture(rgba=np.asarray(tall))
    file = replace(make_still_picture(encode_png(tall), picture), id=colour.id, name="colour")
    member = replace(colour, picture=file.picture, domain=file.domain, corner=0j, keys=file.keys)
    command, known, notices = replace_member_picture(document, member, picture, pictures)
    after = command(document)
    assert notices == ()
    assert set(known) == {member.picture, after.layer(group.id).picture}
    assert after.layer(group.id).covers(np.array([100 + 112j])).all()
    assert [key.frame for key in after.layer(group.id).keys] == [0, 10]


def test_scripts_bend_layers_as_one(opened):
    script = {
        "schema": 1,
        "layers": [
            {
                "layers": ["ink", "colour"],
                "layer": "fish",
                "handles": {"head": [32, 60], "tail": [168, 60]},
                "keys": [{"frame": 0}, {"frame": 6, "targets": {"tail": [160, 85]}}],
            },
            {"layer": "ink", "opacity": [[0, 1], [6, 0.5]]},
            {"layer": "bubble", "attach": {"to": "ink", "at": [110, 60]}},
        ],
    }
    document, notices = pose_document(opened.document, parse_pose_script(script), lambda _: None)
    assert notices == ()
    group = by_name(document, "fish")
    assert [each.name for each in document.deform_members(group.id)] == ["colour", "ink"]
    assert [key.frame for key in group.keys] == [0, 6]
    assert by_name(document, "bubble").attachments[0].parent == group.id
    assert len(by_name(document, "ink").keys_of(OPACITY)) == 2
    del script["layers"][0]["layer"]
    document, _ = pose_document(opened.document, parse_pose_script(script), lambda _: None)
    assert by_name(document, "ink + colour").handles
    script["layers"][1]["handles"] = {"eye": [60, 60]}
    with pytest.raises(LissomError, match="bends with"):
        pose_document(opened.document, parse_pose_script(script), lambda _: None)
    for layers in (["ink"], ["ink", "ink"]):
        script["layers"][0]["layers"] = layers
        with pytest.raises(LissomError, match="two different layers"):
            parse_pose_script(script)


def test_a_faded_group_is_one_composite_around_a_layer_between_its_members(bent):
    document, pictures = bent
    document = group_commands.group_layers(ids(document, ["colour", "ink", "fish"]), "all")(
        document
    )
    document = layer_commands.set_hidden(by_name(document, "shade").id, hidden=True)(document)
    document = group_commands.set_group_opacity("all", 0.5)(document)
    bubble, colour = by_name(document, "bubble"), by_name(document, "colour")
    key = DRAW_ORDER.key(0, DrawOrder(colour.id, in_front=True))
    document = document.with_layer(bubble.with_keys_of(DRAW_ORDER, (key,)))
    textures = {
        each.id: cut_picture(pictures[each.id], each.cut_out).texture for each in document.layers
    }
    for frame in (*frames(document, pictures, 0), flatten_layers(document, textures)):
        sky, orange = np.array([210, 230, 250]), np.array([240, 150, 60])
        line, blue = np.array([20, 10, 30]), np.array([80, 200, 240])
        assert_allclose(frame[60, 70, :3], (sky + orange) / 2, atol=2)
        # The line hides the colour below it, as in a single picture that is faded.
        assert_allclose(frame[30, 80, :3], (sky + line) / 2, atol=2)
        # The layer between is not faded.
        assert_allclose(frame[60, 110, :3], blue, atol=2)


def test_layers_that_lie_on_each_other_are_suggested(opened):
    document, pictures = opened.document, opened.pictures
    assert suggest_deform_groups(document, pictures) == (tuple(ids(document, NAMES)),)
    hidden = layer_commands.set_hidden(by_name(document, "ink").id, hidden=True)(document)
    assert suggest_deform_groups(hidden, pictures) == ()


def test_channels_of_members_repeat_with_the_cycles_of_their_group(bent):
    document, _ = bent
    group, ink = by_name(document, "fish"), by_name(document, "ink")
    keys = (OPACITY.key(0, 1.0), OPACITY.key(10, 0.5), OPACITY.key(20, 1.0))
    document = document.with_layer(ink.with_keys_of(OPACITY, keys))
    document = key_commands.insert_key(group.id, 20, group.keys[0].pose)(document)
    document = scene_commands.set_frames(FrameRange(0, 60))(document)
    document = cycle_commands.set_cycle(group.id, 0, 20, 60)(document)
    ink = document.layer(ink.id)
    assert ink.cycles == document.layer(group.id).cycles
    assert opacity_at(document, ink, 50) == pytest.approx(0.5)


@pytest.mark.parametrize("kind", ["html", "glb"])
def test_pages_and_models_have_members_as_one_mesh(bent, tmp_path, kind):
    """The texture of this mesh is all members over each other; a hidden one stays apart."""
    document, pictures = bent
    textures = {each: picture.rgba for each, picture in pictures.items()}
    settings = ExportSettings(format=kind, framing="canvas")
    request = ExportRequest(out=tmp_path / f"a.{kind}", settings=settings, project="fish")

    def exported(document):
        evaluator = Evaluator.exact(document)
        plan = plan_export(document, request, evaluator)
        maker = MeshExport(document, textures, evaluator, plan)
        assert list(maker.run())
        return maker

    # A bubble lies between these two and the ink.
    lower, upper = (by_name(document, name) for name in ("colour", "shade"))
    plain = document
    for each in (lower, upper):
        plain = plain.with_layer(replace(each, blend="normal", clipped=False, opacity=1.0))
    whole = exported(plain)
    assert [mesh.name for mesh in whole.meshes] == ["sky", "colour + shade", "bubble", "ink"]
    on, off = (
        channel_commands.set_key(Channel(VISIBILITY, upper.id), frame, value=value)
        for frame, value in ((0, True), (5, False))
    )
    apart = exported(off(on(plain)))
    assert [mesh.name for mesh in apart.meshes] == ["sky", "colour", "shade", "bubble", "ink"]
    (notice,) = (notice for notice in apart.notices if "one after the other" in notice)
    assert "paints colour, shade, ink one" in notice
    one, other = (Image.fromarray(mesh.texture) for mesh in apart.meshes[1:3])
    one.alpha_composite(other)
    merged = premultiplied(whole.meshes[1].texture)
    assert_allclose(merged, premultiplied(np.asarray(one)), atol=1)
