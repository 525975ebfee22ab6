"""The groups of a changed file, and the groups of a document that stand for them."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace

from app.document import Document, DrawingFile, Group, ancestor_paths, group_commands
from app.errors import LissomError

SETTINGS = ("opacity", "hidden", "blend", "clipped")


@dataclass(frozen=True, slots=True, eq=False)
class FileGroups:
    """The groups of a file before and now, and which of them are the same."""

    before: DrawingFile
    now: DrawingFile
    matches: Mapping[int, int]  # present index of a layer by its former index

    @property
    def renamed(self) -> Mapping[str, str]:
        """Present paths of groups by their former paths, where these differ."""
        old = {group.name for group in self.before.groups}
        new = {group.name for group in self.now.groups}
        votes: dict[str, Counter[str]] = {}
        for one, other in self.matches.items():
            paths = ancestor_paths(self.before.layers[one].group)
            now = ancestor_paths(self.now.layers[other].group)
            for path, present in zip(paths, now, strict=False):
                if path not in new and present not in old:
                    votes.setdefault(path, Counter())[present] += 1
        found: dict[str, str] = {}
        for path, count in votes.items():
            present = count.most_common(1)[0][0]
            if present not in found.values():
                found[path] = present
        return found

    def present_path(self, path: str) -> str:
        """Return the present path in the file of a group, by its former path."""
        return self.renamed.get(path, path)


def document_paths(document: Document, drawing: DrawingFile) -> dict[str, str]:
    """Return the paths of a document's groups by their paths in the file, found by the members."""
    found: dict[str, str] = {}
    for layer in document.layers:
        origin = layer.origin
        if origin is None or origin.drawing != drawing.id or origin.index >= len(drawing.layers):
            continue
        theirs = ancestor_paths(drawing.layers[origin.index].group)
        ours = ancestor_paths(layer.group)
        if len(theirs) == len(ours):
            for path, own in zip(theirs, ours, strict=True):
                found.setdefault(path, own)
    known = {group.name for group in document.groups}
    for group in drawing.groups:
        if group.name in known:
            found.setdefault(group.name, group.name)
    return found


def update_groups(document: Document, groups: FileGroups) -> Document:
    """Return a document whose groups have the names and settings that changed in the file.

    What was changed in the document stays.
    """
    now = {group.name: group for group in groups.now.groups}
    for old in groups.before.groups:
        present = now.get(groups.present_path(old.name))
        path = document_paths(document, groups.before).get(old.name)
        if present is None or path is None or path not in {each.name for each in document.groups}:
            continue
        own = document.group(path)
        changes = {
            name: getattr(present, name)
            for name in SETTINGS
            if getattr(present, name) != getattr(old, name) == getattr(own, name)
        }
        if changes:
            changed = tuple(
                replace(each, **changes) if each is own else each for each in document.groups
            )
            document = replace(document, groups=changed)
        name = present.name.rpartition("/")[2]
        was = old.name.rpartition("/")[2]
        if name != was == path.rpartition("/")[2]:
            try:
                document = group_commands.rename_group(path, name)(document)
            except LissomError:
                continue  # another group has the name
    return document


def group_for(
    document: Document, groups: FileGroups, known: Mapping[str, str], path: str
) -> tuple[Document, str]:
    """Return the group of the document for a present path in the file; missing groups are added.

    `known` holds the document's paths by the former paths in the file.
    """
    if not path:
        return document, ""
    former = {now: old for old, now in groups.renamed.items()}
    own = ""
    added: list[Group] = []
    theirs = {group.name: group for group in groups.now.groups}
    taken = {group.name for group in document.groups}
    for each in ancestor_paths(path):
        found = known.get(former.get(each, each))
        name = each.rpartition("/")[2]
        own = found or (f"{own}/{name}" if own else name)
        if own not in taken:
            added.append(replace(theirs[each], name=own))
            taken.add(own)
    return group_commands.add_groups(added)(document), own
