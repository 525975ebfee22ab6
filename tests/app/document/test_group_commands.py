from dataclasses import replace

import pytest
from documents import disc_document

from app.document import group_commands as groups, layer_commands as layers
from app.document.layers.groups import Group
from app.document.queries.layers.compositing import CompositeGroup, composite_layers
from app.document.queries.layers.visibility import is_visible
from app.errors import LissomError


def scene(*names):
    """A document with a layer for each name, from back to front, with the ids 0, 1, 2 …"""
    document = disc_document()
    layers = tuple(
        replace(document.layers[0], id=identity, name=name) for identity, name in enumerate(names)
    )
    return replace(document, layers=layers)


def grouped(names, *found):
    """A scene of layers that are named as "sky limbs/arm", each in the group before its slash."""
    made = scene(*names.split())
    layers = tuple(
        replace(layer, name=layer.name.rpartition("/")[2], group=layer.name.rpartition("/")[0])
        for layer in made.layers
    )
    return replace(made, layers=layers, groups=tuple(Group(name=name) for name in found))


def paths(document):
    return [f"{layer.group}/{layer.name}".removeprefix("/") for layer in document.layers]


def names_of(document):
    return [group.name for group in document.groups]


@pytest.mark.parametrize("name", ["", "/", "a/", "/a", "a//b", " a", "a/b ", "/".join("a" * 51)])
def test_a_group_has_a_path_of_names(name):
    with pytest.raises(LissomError, match=r"is not a path of a group|at most 50 deep"):
        Group(name=name)


def test_every_group_around_a_layer_is_there_once_and_after_its_own():
    document = scene("sky", "arm")
    for found in (("b",), ("a/b", "a"), ("a/b",), ("a", "a")):
        with pytest.raises(LissomError, match="group"):
            replace(
                document,
                layers=(document.layers[0], replace(document.layers[1], group="a/b")),
                groups=tuple(Group(name=name) for name in found),
            )
    with pytest.raises(LissomError, match="Opacity"):
        Group(name="a", opacity=1.5)
    with pytest.raises(LissomError, match="blend of a group must be one of"):
        Group(name="a", blend="dissolve")
    with pytest.raises(LissomError, match="blend of 'sky' must be one of normal, darken, multiply"):
        replace(document.layers[0], blend="pass-through")


def test_layers_are_gathered_in_a_group_in_their_order():
    document = scene("sky", "leg", "body", "arm", "hat")
    limbs = groups.group_layers([3, 1], "limbs")(document)
    assert paths(limbs) == ["sky", "body", "limbs/leg", "limbs/arm", "hat"]
    more = groups.group_layers({0}, "limbs/far")(limbs)
    assert paths(more) == ["body", "limbs/leg", "limbs/arm", "limbs/far/sky", "hat"]
    assert names_of(more) == ["limbs", "limbs/far"]
    assert groups.group_layers({0}, "limbs/far")(more) is more
    # The last one of a group takes it along.
    assert names_of(groups.group_layers({0}, "")(more)) == ["limbs"]
    assert document.canvas == more.canvas


def test_what_leaves_a_group_does_not_part_it():
    document = grouped("a/one a/two a/three sky", "a")
    out = groups.group_layers({1}, "")(document)
    assert paths(out) == ["a/one", "a/three", "two", "sky"]
    inner = groups.group_layers({1}, "a/b")(document)
    assert paths(inner) == ["a/one", "a/three", "a/b/two", "sky"]
    beside = groups.group_layers({1}, "c")(document)
    assert paths(beside) == ["a/one", "a/three", "c/two", "sky"]


@pytest.mark.parametrize(
    ("identity", "index", "wanted"),
    [
        (0, 1, "a/one a/sky a/two b/c/hat tail"),  # amid a group: it joins
        (0, 2, "a/one a/two sky b/c/hat tail"),  # between two: in none
        (1, 2, "sky a/two a/one b/c/hat tail"),  # beside its own: it stays
        (1, 3, "sky a/two b/c/hat one tail"),  # away from them: it leaves
        (3, 0, "b/c/hat sky a/one a/two tail"),  # alone, it takes its groups along
        (3, 2, "sky a/one a/hat a/two tail"),
        (3, 4, "sky a/one a/two tail b/c/hat"),
    ],
)
def test_a_layer_that_is_moved_joins_and_leaves_groups_so_that_they_stay_whole(
    identity, index, wanted
):
    document = grouped("sky a/one a/two b/c/hat tail", "a", "b", "b/c")
    after = layers.move_layer(identity, index)(document)
    assert paths(after) == wanted.split()
    filled = {layer.group for layer in after.layers}
    assert all(any(path.startswith(name) for path in filled) for name in names_of(after))


def test_a_group_is_moved_as_a_whole():
    document = grouped("sky a/one a/b/two a/b/three c/four c/five", "a", "a/b", "c")
    document = groups.set_group_opacity("a/b", 0.5)(document)
    inside = groups.move_group_into("a/b", "c")(document)
    assert paths(inside) == ["sky", "a/one", "c/four", "c/five", "c/b/two", "c/b/three"]
    assert inside.group("c/b").opacity == 0.5
    free = groups.move_group_into("a/b", "")(document)
    assert paths(free) == ["sky", "a/one", "b/two", "b/three", "c/four", "c/five"]
    # Before a group that is listed first, and with all of its own around it left empty.
    late = groups.move_group_into("a", "c")(document)
    assert paths(late) == ["sky", "c/four", "c/five", "c/a/one", "c/a/b/two", "c/a/b/three"]
    beside = groups.reorder_group("a/b", 0, in_front=False)(document)
    assert paths(beside) == ["b/two", "b/three", "sky", "a/one", "c/four", "c/five"]
    amid = groups.reorder_group("a/b", 4, in_front=True)(document)
    assert paths(amid) == ["sky", "a/one", "c/four", "c/b/two", "c/b/three", "c/five"]
    stays = groups.reorder_group("a/b", 1, in_front=False)(document)
    assert paths(stays) == ["sky", "a/b/two", "a/b/three", "a/one", "c/four", "c/five"]
    assert groups.reorder_group("a/b", 1, in_front=True)(document) is document
    with pytest.raises(LissomError, match="'a' cannot be moved into itself"):
        groups.move_group_into("a", "a/b")(document)
    # Where its name is taken, it has a number.
    twice = groups.move_group_into("b", "a")(grouped("a/b/one b/two", "a", "a/b", "b"))
    assert paths(twice) == ["a/b/one", "a/b 2/two"]


def test_a_new_layer_amid_a_group_is_in_it_and_a_copy_is_beside_its_original():
    document = grouped("sky a/one a/two", "a")
    new = replace(document.layers[0], id=9, name="new")
    assert paths(layers.add_layer(new, 2)(document)) == ["sky", "a/one", "a/new", "a/two"]
    assert paths(layers.add_layer(new, 1)(document)) == ["sky", "new", "a/one", "a/two"]
    assert paths(layers.duplicate_layer(1)(document))[2] == "a/one copy"
    alone = layers.remove_layer(2)(layers.remove_layer(1)(document))
    assert (paths(alone), alone.groups) == (["sky"], ())


def test_groups_are_renamed_with_what_is_in_them():
    document = grouped("a/one a/b/two ab/three", "a", "a/b", "ab")
    renamed = groups.rename_group("a", "limbs")(document)
    assert paths(renamed) == ["limbs/one", "limbs/b/two", "ab/three"]
    assert names_of(renamed) == ["limbs", "limbs/b", "ab"]
    inner = groups.rename_group("limbs/b", " far ")(renamed)
    assert names_of(inner) == ["limbs", "limbs/far", "ab"]
    assert groups.rename_group("a", "a")(document) is document
    with pytest.raises(LissomError, match="'ab' already"):
        groups.rename_group("a", "ab")(document)
    with pytest.raises(LissomError, match="not contain a slash"):
        groups.rename_group("a", "x/y")(document)
    with pytest.raises(LissomError, match="no group 'z'"):
        groups.rename_group("z", "a")(document)


def test_ungrouping_hands_on_what_the_group_did():
    document = grouped("a/one a/a/two a/b/three b/four", "a", "a/a", "a/b", "b")
    document = groups.set_group_opacity("a", 0.5)(document)
    document = groups.set_group_hidden("a", hidden=True)(document)
    free = groups.ungroup_layers("a")(document)
    assert paths(free) == ["one", "a/two", "b 2/three", "b/four"]
    assert [group.opacity for group in free.groups] == [0.5, 0.5, 1.0]
    for layer in free.layers[:3]:
        assert not is_visible(free, layer, 0)
    assert (free.layers[0].opacity, free.layers[1].opacity) == (0.5, 1.0)
    nested = groups.ungroup_layers("a/b")(document)
    assert paths(nested)[2] == "a/three"


def test_a_hidden_group_hides_all_that_is_in_it():
    document = grouped("sky a/one a/b/two", "a", "a/b")
    hidden = groups.set_group_hidden("a", hidden=True)(document)
    assert [is_visible(hidden, layer, 3) for layer in hidden.layers] == [True, False, False]
    assert [layer.name for layer in hidden.exported_layers] == ["sky"]
    assert groups.set_group_hidden("a", hidden=True)(hidden) is hidden
    inner = groups.set_group_hidden("a/b", hidden=True)(document)
    assert [is_visible(inner, layer, 3) for layer in inner.layers] == [True, True, False]


def test_each_run_of_a_group_is_composited_by_itself_unless_it_is_faded():
    document = grouped("a/one sky a/two a/b/three", "a", "a/b")

    def drawn(changed):
        return composite_layers(changed, {layer.id: layer.name for layer in changed.layers}, 0)

    assert drawn(document) == ("one", "sky", "two", "three")
    # Faded, it is one, and what lies between its runs is not faded.
    faded = groups.set_group_opacity("a", 0.5)(document)
    whole = CompositeGroup(("one", "sky", "two", "three"), 0.5, is_pass_through=True, kept=("sky",))
    assert drawn(faded) == (whole,)
    inner = groups.set_group_blend("a/b", "multiply")(faded)
    # Faded as one, it still lets through what blends in it.
    shade = CompositeGroup(("three",), 1.0, "multiply")
    assert drawn(inner) == (replace(whole, parts=("one", "sky", "two", shade)),)
    # A group keeps what blends in it from what is behind only if it does not let it through.
    alone = groups.set_group_blend("a/b", "multiply")(document)
    assert drawn(alone)[3] == CompositeGroup(("three",), 1.0, "multiply")
    apart = groups.set_group_blend("a", "normal")(alone)
    assert drawn(apart)[2] == CompositeGroup(("two", CompositeGroup(("three",), 1.0, "multiply")))
    assert drawn(groups.set_group_blend("a", "normal")(document)) == drawn(document)


def clipped(document, *names):
    layers = (
        replace(layer, clipped=layer.name in names, opacity=0.5 if layer.name == "arm" else 1.0)
        for layer in document.layers
    )
    return replace(document, layers=tuple(layers))


def test_what_is_clipped_is_painted_on_what_lies_below_it_in_its_group():
    document = clipped(grouped("sky arm shade light a/two a/three", "a"), "shade", "light", "two")
    names = {layer.id: layer.name for layer in document.layers}
    cut = [CompositeGroup((name,), clipped=True) for name in ("shade", "light")]
    # At the bottom of its group there is nothing that cuts.
    whole = ("sky", CompositeGroup(("arm", *cut), 0.5), "two", "three")
    assert composite_layers(document, names, 0) == whole
    # What cuts is not seen, and nothing of what it cuts.
    assert composite_layers(
        document, {i: name for i, name in names.items() if name != "arm"}, 0
    ) == (
        "sky",
        "two",
        "three",
    )
    assert composite_layers(document, {1: "arm"}, 0) == (CompositeGroup(("arm",), 0.5),)
    assert layers.set_clipped(2, clipped=True)(document) is document


def test_a_group_is_clipped_and_cuts():
    document = clipped(grouped("arm a/one a/two hat", "a"), "hat")
    document = replace(document, groups=(Group(name="a", clipped=True),))
    names = {layer.id: layer.name for layer in document.layers}
    parts = composite_layers(document, names, 0)
    cut = CompositeGroup(("one", "two"), clipped=True), CompositeGroup(("hat",), clipped=True)
    assert parts == (CompositeGroup(("arm", *cut), 0.5),)
    free = replace(document, groups=(Group(name="a"),))
    assert composite_layers(free, names, 0)[1] == CompositeGroup(
        ("one", "two", CompositeGroup(("hat",), clipped=True))
    )
