"""The rooms of the project: their layers, their size, and the faces by which they are entered."""

import ast
import re
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from itertools import chain
from pathlib import Path

from importlinter.cli import lint_imports

from app.cli.main import COMMANDS

ROOT = Path(__file__).parents[1]
ROOTS = ("app", "engine")
MOST_IN_A_ROOM = 12  # modules and sub-packages together
MOST_ROOMS, MOST_LOOSE = 14, 5  # of app and engine: packages, and modules beside them

# What puts off loading a face until it is asked for.
PUTTING_OFF = {"__getattr__", "__dir__"}

# Calls that say what a thing is, and compute nothing.
# That BLAS keeps to one thread is said once for all that the engine does.
DECLARATIONS = {"Similarity", "TypeVar", "field", "get_args", "threadpool_limits"}


def module_files() -> dict[str, Path]:
    """Return the file of every module and package, by its dotted name; examples are scripts."""
    files = {}
    for path in chain.from_iterable((ROOT / root).rglob("*.py") for root in ROOTS):
        parts = path.relative_to(ROOT).with_suffix("").parts
        if parts[:2] == ("engine", "examples"):
            continue
        files[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return files


FILES = module_files()
PACKAGES = sorted(name for name, path in FILES.items() if path.name == "__init__.py")


@cache
def parsed(name: str) -> ast.Module:
    return ast.parse(FILES[name].read_text(encoding="utf-8"))


def statements_of(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the statements in a module or statement, and those in them."""
    for part in ("body", "handlers", "orelse", "finalbody", "cases"):
        for statement in getattr(node, part, ()):
            yield statement
            yield from statements_of(statement)


def test_the_layers_keep_their_direction():
    assert lint_imports(config_filename="pyproject.toml", is_debug_mode=False) == 0


def test_the_readmes_have_the_levels_of_the_contracts():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    layers = {
        tuple(contract["containers"]): contract["layers"]
        for contract in settings["tool"]["importlinter"]["contracts"]
        if contract["type"] == "layers"
    }
    numbers: list[int] = []
    for root in ("engine", "app"):
        levels = [
            [f"{root}.{name.strip()}" for name in re.split(r"[|:]", layer)]
            for layer in reversed(layers[root,])
        ]
        readme = (ROOT / root / "README.md").read_text(encoding="utf-8")
        rows = re.findall(r"^\| (\d+) \| ((?:`[\w.]+`(?:, )?)+) \|", readme, flags=re.MULTILINE)
        assert [re.findall(r"`([\w.]+)`", rooms) for _, rooms in rows] == levels
        numbers += [int(number) for number, _ in rows]
    # The program's levels go on where the engine's end.
    assert numbers == list(range(1, len(numbers) + 1))


def test_rooms_have_few_modules():
    crowded = {}
    for package in PACKAGES:
        folder = FILES[package].parent
        modules = {path.stem for path in folder.glob("*.py")} - {"__init__", "__main__"}
        rooms = {path.parent.name for path in folder.glob("*/__init__.py")}
        # The table of commands lists their folder, which has a module for each.
        most = len(COMMANDS) if package == "app.cli.commands" else MOST_IN_A_ROOM
        if package in ROOTS:
            is_crowded = len(rooms) > MOST_ROOMS or len(modules) > MOST_LOOSE
        else:
            is_crowded = len(modules | rooms) > most
        if is_crowded:
            crowded[package] = sorted(modules | rooms)
    assert crowded == {}


def test_rooms_document_input_output_and_imports():
    missing = [
        (package, what)
        for package in PACKAGES
        for what in ("In: ", "Out: ", "Imports: ")
        if f"\n{what}" not in (ast.get_docstring(parsed(package)) or "")
    ]
    assert missing == []


def test_faces_have_only_a_docstring_and_public_names():
    others = []
    for package in PACKAGES:
        docstring, *statements = parsed(package).body
        is_documented = isinstance(docstring, ast.Expr)
        are_names = all(
            isinstance(each, (ast.ImportFrom, ast.Assign))
            or getattr(each, "name", "") in PUTTING_OFF
            or (isinstance(each, ast.If) and ast.unparse(each.test) == "TYPE_CHECKING")
            for each in statements
        )
        # Only the packages directly below the roots show names.
        if not (is_documented and are_names) or (statements and package.count(".") > 1):
            others.append(package)
    assert others == []


def test_commands_load_what_computes_only_when_they_run():
    light = {"app.cli.console", "app.cli.options"}
    light |= {f"app.{each}" for each in ("errors", "export_formats", "folders", "texts")}
    heavy = []
    for name in sorted(name for name in FILES if name.startswith("app.cli.commands.")):
        for node in parsed(name).body:
            modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                modules = [node.module or ""]
            heavy += [
                (name, module)
                for module in modules
                if module not in light and module.split(".")[0] not in sys.stdlib_module_names
            ]
    assert heavy == []


def test_names_of_a_face_are_imported_through_it():
    past_a_face = []
    for name in sorted(FILES):
        for node in statements_of(parsed(name)):
            if isinstance(node, ast.ImportFrom):
                past_a_face += [(name, taken) for taken in taken_past_a_face(name, node)]
    assert past_a_face == []


def taken_past_a_face(name: str, node: ast.ImportFrom) -> list[str]:
    """Return the names of a face that an import from outside takes from a module behind it."""
    module = node.module or ""
    room = room_of(module)
    if module in (room, *ROOTS) or room not in PACKAGES or room_of(name) == room:
        return []
    return [f"{module}.{a.name}" for a in node.names if a.name in public_names(room)]


def room_of(name: str) -> str:
    """Return the package directly below a root that a module belongs to."""
    return ".".join(name.split(".")[:2])


def test_the_engine_computes_nothing_when_it_is_loaded():
    computed = []
    for name in sorted(name for name in FILES if name.startswith("engine")):
        for statement in parsed(name).body:
            if isinstance(statement, ast.FunctionDef):
                continue
            inside = statement.body if isinstance(statement, ast.ClassDef) else [statement]
            calls = {
                ast.unparse(node.func)
                for part in inside
                if not isinstance(part, ast.FunctionDef)
                for node in ast.walk(part)
                if isinstance(node, ast.Call)
            }
            computed += [(name, call) for call in sorted(calls - DECLARATIONS)]
    assert computed == []


@cache
def public_names(package: str) -> set[str]:
    """Return what a face shows: what it imports by its own name, and its tables."""
    body = parsed(package).body
    imports = (alias for node in body if isinstance(node, ast.ImportFrom) for alias in node.names)
    tables = (ast.unparse(node.targets[0]) for node in body if isinstance(node, ast.Assign))
    return {alias.asname for alias in imports if alias.asname is not None} | set(tables)


def defined_names(name: str) -> tuple[set[str], set[str]]:
    """Return the public classes and type aliases of a module, and its public functions."""
    types, functions = set(), set()
    for node in parsed(name).body:
        if isinstance(node, ast.ClassDef):
            types.add(node.name)
        elif isinstance(node, ast.FunctionDef):
            functions.add(node.name)
        elif isinstance(node, (ast.Assign, ast.AnnAssign)) and not (
            node.value is None or isinstance(node.value, ast.Call)
        ):
            target = ast.unparse(node.targets[0] if isinstance(node, ast.Assign) else node.target)
            is_alias = target[0].isupper() and not target.isupper()
            # An abbreviation of a library's own name is no other name.
            if is_alias and not ast.unparse(node.value).endswith(f".{target}"):
                types.add(target)
    return ({n for n in types if n[0] != "_"}, {n for n in functions if n[0] != "_"})


def test_types_have_names_of_their_own():
    modules: dict[str, list[str]] = {}
    for name in FILES:
        for defined in defined_names(name)[0]:
            modules.setdefault(defined, []).append(name)
    assert shared(modules) == {}


def test_functions_have_names_of_their_own_in_their_room():
    modules: dict[str, list[str]] = {}
    for name in FILES:
        if name.startswith("app.cli.commands."):
            continue
        for function in defined_names(name)[1]:
            modules.setdefault(f"{room_of(name)}: {function}", []).append(name)
    assert shared(modules) == {}


def shared(modules: dict[str, list[str]]) -> dict[str, list[str]]:
    """Return the names that several modules define."""
    return {name: users for name, users in modules.items() if len(users) > 1}


def test_the_engine_is_tested_without_the_program():
    support = {path.stem: path for path in (ROOT / "tests" / "support").glob("*.py")}
    waiting = list((ROOT / "tests" / "engine").rglob("*.py"))
    seen, of_the_program = set(), []
    while waiting:
        path = waiting.pop()
        seen.add(path)
        for node in statements_of(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            for name in names:
                if name.split(".")[0] == "app":
                    of_the_program.append((str(path.relative_to(ROOT)), name))
                if name in support and support[name] not in seen:
                    waiting.append(support[name])
    assert of_the_program == []


# Methods that change a list, set or dictionary.
MUTATING = {
    *("add", "append", "clear", "difference_update", "discard", "extend", "insert"),
    *("intersection_update", "pop", "popitem", "remove", "setdefault", "update"),
}


def state_parts() -> Iterator[tuple[str, ast.ClassDef]]:
    """Yield the classes of the parts of a session and of a project, with their modules."""
    for name in sorted(FILES):
        for node in parsed(name).body:
            if isinstance(node, ast.ClassDef) and "Revised" in map(ast.unparse, node.bases):
                yield name, node


def written_attributes(name: str, collections: set[str]) -> Iterator[tuple[str, str]]:
    """Yield the attributes that a module sets, deletes or mutates on an object, with the code.

    An object may write its own attributes, also if a part has one of the same name.
    """
    for node in ast.walk(parsed(name)):
        target: ast.AST = node
        if isinstance(node, ast.Subscript) and not isinstance(node.ctx, ast.Load):
            target = node.value
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith("setattr"):
            for each in ast.walk(node):
                if isinstance(each, ast.Constant) and isinstance(each.value, str):
                    yield each.value, ast.unparse(node)
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            target = node.func.value
            if node.func.attr not in MUTATING or getattr(target, "attr", "") not in collections:
                continue
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load):
            continue
        if isinstance(target, ast.Attribute) and ast.unparse(target.value) != "self":
            yield target.attr, ast.unparse(node)


def test_attributes_of_a_part_are_written_in_its_module():
    homes: dict[str, str] = {}
    collections, shared_names = set(), []
    for name, part in state_parts():
        for field in part.body:
            if isinstance(field, ast.AnnAssign):
                attribute = ast.unparse(field.target)
                # The owner is known by the attribute's name.
                shared_names += [attribute] if attribute in homes else []
                homes[attribute] = name
                if ast.unparse(field.annotation).startswith(("dict", "list", "set")):
                    collections.add(attribute)
    others = [
        (name, written)
        for name in sorted(FILES)
        for attribute, written in written_attributes(name, collections)
        if name != homes.get(attribute, name)
    ]
    assert len(homes) > 100
    assert (shared_names, others) == ([], [])
