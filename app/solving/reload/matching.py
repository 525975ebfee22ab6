"""Which layer of a changed file is which layer of the file before."""

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Hashable, Iterator, Mapping, Sequence

from app.document import FileLayer

HasSamePixels = Callable[[int, int], bool]  # of an index before and an index now


def match_layers(
    before: Sequence[FileLayer], now: Sequence[FileLayer], has_same_pixels: HasSamePixels
) -> Mapping[int, int]:
    """Return the present index of each layer that a changed file still has, by its former index.

    Layers match by id, then by group and name, then by a name that is unique in both, then by equal
    pixels. The order of the layers never counts.
    """
    found: dict[int, int] = {}

    def left() -> tuple[list[int], list[int]]:
        taken = set(found.values())
        return (
            [index for index in range(len(before)) if index not in found],
            [index for index in range(len(now)) if index not in taken],
        )

    found |= dict(_by_number(before, now, has_same_pixels))
    for key in (_path, _name):
        found |= dict(_by_key(before, now, *left(), key, has_same_pixels))
    remaining = left()
    for one in remaining[0]:
        same = [other for other in left()[1] if has_same_pixels(one, other)]
        if same:
            found[one] = same[0]
    return found


def _by_number(
    before: Sequence[FileLayer], now: Sequence[FileLayer], has_same_pixels: HasSamePixels
) -> Iterator[tuple[int, int]]:
    """Yield layers with the same id, unless a program has numbered them anew."""
    numbers = [Counter(each.number for each in layers) for layers in (before, now)]
    paths = [{each.path for each in layers} for layers in (before, now)]
    present = {each.number: index for index, each in enumerate(now)}
    pairs = [
        (index, present[layer.number])
        for index, layer in enumerate(before)
        if layer.number and all(count[layer.number] == 1 for count in numbers)
    ]

    def is_likely(pair: tuple[int, int]) -> bool:
        """Another name and other pixels mean another layer, if one of the names still exists."""
        layer, other = before[pair[0]], now[pair[1]]
        is_reused = layer.path in paths[1] or other.path in paths[0]
        return layer.name == other.name or not is_reused or has_same_pixels(*pair)

    likely = [pair for pair in pairs if is_likely(pair)]
    # If most ids are those of the same layers, all are.
    yield from pairs if 2 * len(likely) > len(pairs) else likely


def _path(layer: FileLayer) -> Hashable:
    return layer.path


def _name(layer: FileLayer) -> Hashable:
    return layer.name


def _by_key(
    before: Sequence[FileLayer],
    now: Sequence[FileLayer],
    old: Collection[int],
    new: Collection[int],
    key: Callable[[FileLayer], Hashable],
    has_same_pixels: HasSamePixels,
) -> Iterator[tuple[int, int]]:
    """Yield layers with equal keys: among several, those with equal pixels, then the rest in turn.

    Names alone must be unique.
    """
    olds, news = defaultdict[Hashable, list[int]](list), defaultdict[Hashable, list[int]](list)
    for index in old:
        olds[key(before[index])].append(index)
    for index in new:
        news[key(now[index])].append(index)
    for each, ours in olds.items():
        theirs = news[each]
        is_one = len(ours) == len(theirs) == 1
        if not is_one and key is _name:
            continue
        for index in list(ours) if not is_one else ():
            same = next((other for other in theirs if has_same_pixels(index, other)), None)
            if same is not None:
                yield index, same
                ours.remove(index)
                theirs.remove(same)
        # Several layers of one name, of which some were deleted and others redrawn, are ambiguous.
        if len(ours) == len(theirs):
            yield from zip(ours, theirs, strict=True)
