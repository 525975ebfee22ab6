"""Pictures of footage for the window: decoded ahead, packed, and bounded in memory."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from app.document import Footage
from app.errors import LissomError
from app.storage.footage.footage_reader import FootageReader
from app.storage.footage.opening import open_footage
from app.storage.footage.packing import PackedPicture, pack_picture
from engine.arrays import Bytes

FOOTAGE_BUDGET: Final = 160 * 2**20  # bytes of packed pictures
# Pictures that a job keeps on the way to the one it was asked for, and after it.
_MOST_PASSED, _AT_ONCE = 24, 4
_MOST_READERS: Final = 4  # open files

PackedPictures = Mapping[int, PackedPicture]  # by their numbers


class BrokenPictureError(LissomError):
    """A picture of footage that cannot be read, while others can."""


class FootageDecoder:
    """Reads footage for the window; for one worker thread.

    `count` is the number of decoded pictures.
    """

    def __init__(self) -> None:
        self.count = 0
        self._readers: dict[Footage, FootageReader] = {}
        self._generation = 0

    def decode(
        self,
        footage: Footage,
        numbers: Sequence[int],
        reduction: int,
        generation: int,
    ) -> PackedPictures:
        """Return the first of some pictures, and others of them that are passed on the way.

        Files of an earlier generation are opened again.

        Raises `LissomError` if the footage cannot be opened, and `BrokenPictureError` if the first
        picture cannot be read.
        """
        if generation != self._generation:
            self.close()
            self._generation = generation
        reader = self._reader(footage)
        found: dict[int, PackedPicture] = {}
        asked = frozenset(numbers)
        for number in numbers[:_AT_ONCE]:
            if number in found:
                continue
            try:
                for decoded in reader.decode_to(number):
                    self.count += 1
                    is_asked = decoded.number == number
                    if is_asked or (decoded.number in asked and len(found) < _MOST_PASSED):
                        found[decoded.number] = pack_picture(decoded.pixels(), reduction)
            except LissomError as error:
                if number == numbers[0]:
                    raise BrokenPictureError(str(error)) from error
                return found
        return found

    def close(self) -> None:
        """Close all files."""
        while self._readers:
            self._readers.popitem()[1].close()

    def __del__(self) -> None:
        self.close()

    def _reader(self, footage: Footage) -> FootageReader:
        reader = self._readers.pop(footage, None)
        if reader is None:
            while len(self._readers) >= _MOST_READERS:
                self._readers.pop(next(iter(self._readers))).close()
            reader = open_footage(footage)
        self._readers[footage] = reader  # the newest last
        return reader


class _Shown(NamedTuple):
    """The picture that a layer shows in the window."""

    packed: PackedPicture
    pixels: Bytes


@dataclass(slots=True, kw_only=True, eq=False)
class FootageCache:
    """Packed pictures of footage, at most `budget` bytes, and the unpacked ones that are shown."""

    budget: int = FOOTAGE_BUDGET
    decoder: FootageDecoder = field(default_factory=FootageDecoder)
    errors: dict[Footage, LissomError] = field(default_factory=dict)  # why footage is not shown
    # When the files of footage were last changed.
    times: dict[Footage, tuple[int, ...]] = field(default_factory=dict)
    # What the pictures of a layer's frames depend on, and their numbers, by layer id.
    numbers: dict[int, tuple[object, list[int]]] = field(default_factory=dict)
    broken: set[tuple[Footage, int]] = field(default_factory=set)  # pictures that cannot be read
    arrivals: int = 0  # counts the pictures that came after they were needed
    generation: int = 0  # counts the changes of files
    nbytes: int = 0
    _packed: dict[Footage, dict[int, PackedPicture]] = field(default_factory=dict)
    _awaited: set[tuple[Footage, int]] = field(default_factory=set)
    _shown: dict[int, _Shown] = field(default_factory=dict)

    def show(self, layer: int, footage: Footage, number: int) -> Bytes | None:
        """Return a picture for a layer; while it is not decoded, the one shown last, if any."""
        packed, shown = self._packed.get(footage, {}).get(number), self._shown.get(layer)
        if packed is None:
            self._awaited.add((footage, number))
        elif shown is None or shown.packed is not packed:
            shown = self._shown[layer] = _Shown(packed, packed.unpack())
        return None if shown is None else shown.pixels

    def lacks(self, footage: Footage, number: int, reduction: int) -> bool:
        """Return whether a picture is not there, or not as fine as with this reduction."""
        if (footage, number) in self.broken:
            return False
        packed = self._packed.get(footage, {}).get(number)
        return packed is None or packed.reduction > reduction

    def note_error(self, footage: Footage, number: int, error: LissomError) -> None:
        """Note why footage, or only a picture of it, cannot be shown. It is not tried again."""
        if isinstance(error, BrokenPictureError):
            self.broken.add((footage, number))
        else:
            self.errors[footage] = error

    def room(self, footage: Footage) -> int:
        """Return how many pictures of footage may be kept, from the mean size of those there."""
        known = self._packed.get(footage, {})
        if not known:
            return 1
        mean = sum(each.nbytes for each in known.values()) / len(known)
        share = self.budget / max(len(self._packed), 1)
        return max(int(share / mean), 1)

    def add(self, footage: Footage, pictures: PackedPictures, needed: Collection[int]) -> None:
        """Keep pictures, and drop others than the needed ones if there is no room for all."""
        known = self._packed.setdefault(footage, {})
        for number, packed in pictures.items():
            old = known.pop(number, None)
            self.nbytes += packed.nbytes - (0 if old is None else old.nbytes)
            known[number] = packed
            if (footage, number) in self._awaited:
                self._awaited.discard((footage, number))
                self.arrivals += 1
        for owner, number in [*self._spare(footage, needed)]:
            if self.nbytes <= self.budget:
                return
            self.nbytes -= self._packed[owner].pop(number).nbytes

    def _spare(self, footage: Footage, needed: Collection[int]) -> Iterator[tuple[Footage, int]]:
        """Yield pictures in the order in which they may go: the oldest unneeded ones first."""
        known = self._packed[footage]
        yield from ((footage, number) for number in known if number not in needed)
        for other, pictures in self._packed.items():
            if other is not footage:
                yield from ((other, number) for number in pictures)
        yield from ((footage, number) for number in known if number in needed)

    def note_times(self, footage: Footage, times: tuple[int, ...]) -> bool:
        """Note when files were changed, and return whether they were since the last time."""
        known, self.times[footage] = self.times.get(footage), times
        return known is not None and known != times

    def note_numbers(self, layer: int, source: object, numbers: list[int]) -> None:
        """Note which pictures the frames of a layer show."""
        self.numbers[layer] = source, numbers

    def keep_only(self, used: Iterable[Footage], layers: Collection[int]) -> None:
        """Forget footage that no layer uses, and shown pictures of other layers."""
        for footage in self._packed.keys() - set(used):
            self.forget(footage)
        self._shown = {layer: each for layer, each in self._shown.items() if layer in layers}
        self.numbers = {layer: each for layer, each in self.numbers.items() if layer in layers}

    def forget(self, footage: Footage) -> None:
        """Forget all pictures of footage, and that it could not be read."""
        self.errors.pop(footage, None)
        self.nbytes -= sum(each.nbytes for each in self._packed.pop(footage, {}).values())
        self._awaited = {each for each in self._awaited if each[0] != footage}
        self.broken = {each for each in self.broken if each[0] != footage}
        self.arrivals += 1
        self.generation += 1
