"""Functions drawn by a seed, and one small mistake made in each.

A function and its mistake are drawn by hashes of the function's name and text. What is changed
elsewhere in the project therefore leaves both as they are, and the same mistakes can be tried
before and after a change of the tests.
"""

import ast
import hashlib
from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

ROOMS = ("app", "engine")
SIGNS: dict[type[ast.AST], ast.operator] = {
    ast.Add: ast.Sub(),
    ast.Sub: ast.Add(),
    ast.Mult: ast.Div(),
    ast.Div: ast.Mult(),
}
LIMITS: dict[type[ast.AST], ast.cmpop] = {
    ast.Lt: ast.LtE(),
    ast.LtE: ast.Lt(),
    ast.Gt: ast.GtE(),
    ast.GtE: ast.Gt(),
    ast.Eq: ast.NotEq(),
    ast.NotEq: ast.Eq(),
    ast.Is: ast.IsNot(),
    ast.IsNot: ast.Is(),
    ast.In: ast.NotIn(),
    ast.NotIn: ast.In(),
}
# A place in a function: the kind of mistake, the node that it replaces, and the new text.
Site: TypeAlias = tuple[str, ast.expr | ast.stmt, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class Mutant:
    """A mistake in a function.

    Parameters
    ----------
    path : str
        The file, relative to the project's folder.
    function : str
        The function's qualified name in its module.
    kind : str
        "sign", "limit" or "dropped call".
    line : int
        Where the mistake is.
    before, after : str
        What stood there, and what stands there now.
    code : str
        The line of the function in which it begins, before the mistake.
    turn : int
        How many places of the function before it are alike: in kind, text and line.
    source : str
        The whole file with the mistake.
    """

    path: str
    function: str
    kind: str
    line: int
    before: str
    after: str
    code: str
    turn: int
    source: str

    @property
    def name(self) -> str:
        """What tells the mutant from others."""
        return f"{self.path}:{self.function}"

    def __str__(self) -> str:
        before, after = (" ".join(text.split()) for text in (self.before, self.after))
        return f"{self.name}:{self.line}: {self.kind}, {before!r} -> {after!r}"


def draw_mutants(root: Path, *, seed: int, count: int) -> list[Mutant]:
    """Return mutants of so many functions of a project."""
    candidates: list[tuple[str, tuple[str, str, str, list[Site], int]]] = []
    for path in sorted(each for room in ROOMS for each in (root / room).rglob("*.py")):
        source, place = path.read_text(encoding="utf-8"), path.relative_to(root).as_posix()
        for name, function in _functions(ast.parse(source)):
            if not (sites := list(_sites(function))):
                continue
            text = ast.get_source_segment(source, function) or ""
            digest = hashlib.sha256(f"{seed} {place} {name} {text}".encode()).hexdigest()
            chosen = int(digest[:8], 16) % len(sites)
            candidates.append((digest[8:], (place, name, source, sites, chosen)))
    candidates.sort(key=lambda each: each[0])
    return [_mutant(*candidate) for _, candidate in candidates[:count]]


def find_mutant(root: Path, mutant: Mutant) -> Mutant | None:
    """Return the same mistake in another state of the project, None where its line is gone."""
    path = root / mutant.path
    if not path.is_file():
        return None
    source = path.read_text(encoding="utf-8")
    function = dict(_functions(ast.parse(source))).get(mutant.function)
    if function is None:
        return None
    likeness = (mutant.kind, mutant.before, mutant.after, mutant.code)
    sites = list(_sites(function))
    alike = [place for place, site in enumerate(sites) if _likeness(source, site) == likeness]
    if len(alike) <= mutant.turn:
        return None
    return _mutant(mutant.path, mutant.function, source, sites, alike[mutant.turn])


def with_counters(root: Path, mutants: list[Mutant]) -> dict[str, str]:
    """Return the files of the mutants' functions, each of which tells first that it was called.

    Each tells the place of its mutant in the list. Functions that are not there are left out.
    """
    changed: dict[str, str] = {}
    for number, mutant in enumerate(mutants):
        path = root / mutant.path
        if not path.is_file():
            continue
        source = changed.get(mutant.path) or path.read_text(encoding="utf-8")
        function = dict(_functions(ast.parse(source))).get(mutant.function)
        if function is None:
            continue
        first = function.body[1 if ast.get_docstring(function) and len(function.body) > 1 else 0]
        lines = source.splitlines(keepends=True)
        call = f'__import__("mutant_hits").hit({number})\n'
        # A decorated class or function begins at its first decorator.
        decorators = getattr(first, "decorator_list", [])
        line = min([first.lineno, *(each.lineno for each in decorators)])
        lines.insert(line - 1, " " * first.col_offset + call)
        changed[mutant.path] = "".join(lines)
    return changed


def _likeness(source: str, site: Site) -> tuple[str, str, str, str]:
    """Return by what a place is found again in another state of its function."""
    kind, node, mistake = site
    code = source.splitlines()[node.lineno - 1].strip()
    return kind, ast.get_source_segment(source, node) or "", mistake, code


def _mutant(path: str, function: str, source: str, sites: list[Site], chosen: int) -> Mutant:
    likeness = _likeness(source, sites[chosen])
    kind, before, after, code = likeness
    node = sites[chosen][1]
    return Mutant(
        path=path,
        function=function,
        kind=kind,
        line=node.lineno,
        before=before,
        after=after,
        code=code,
        turn=sum(_likeness(source, site) == likeness for site in sites[:chosen]),
        source=_replaced(source, node, after),
    )


def _functions(tree: ast.Module) -> Iterator[tuple[str, ast.FunctionDef]]:
    """Yield the functions and methods of a module, not those within others, once each."""
    seen: set[str] = set()
    waiting: list[tuple[str, ast.stmt]] = [("", each) for each in tree.body]
    while waiting:
        prefix, node = waiting.pop(0)
        if isinstance(node, ast.ClassDef):
            waiting += [(f"{prefix}{node.name}.", each) for each in node.body]
        elif isinstance(node, ast.FunctionDef) and (name := prefix + node.name) not in seen:
            seen.add(name)
            if not _is_stub(node):
                yield name, node


def _is_stub(function: ast.FunctionDef) -> bool:
    """Tell whether a function has a docstring at most, or stands on the line of its head."""
    first = function.body[-1]
    is_text = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
    return (len(function.body) == 1 and is_text) or first.lineno == function.lineno


def _sites(function: ast.FunctionDef) -> Iterator[Site]:
    """Yield where a mistake can be made."""
    for statement in function.body:
        for node in _walk(statement):
            if not isinstance(node, ast.expr | ast.stmt):
                continue
            wrong = copy(node)
            match wrong:
                case ast.BinOp(op=op) if type(op) in SIGNS and not _is_text(wrong):
                    wrong.op = SIGNS[type(op)]
                    yield "sign", node, f"({ast.unparse(wrong)})"
                case ast.AugAssign(op=op) if type(op) in SIGNS:
                    wrong.op = SIGNS[type(op)]
                    yield "sign", node, ast.unparse(wrong)
                case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
                    yield "sign", node, f"({ast.unparse(operand)})"
                case ast.Compare(ops=[op]) if type(op) in LIMITS:
                    wrong.ops = [LIMITS[type(op)]]
                    yield "limit", node, f"({ast.unparse(wrong)})"
                case ast.BoolOp(op=op):
                    wrong.op = ast.Or() if isinstance(op, ast.And) else ast.And()
                    yield "limit", node, f"({ast.unparse(wrong)})"
                case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
                    yield "limit", node, f"({value + 1})"
                case ast.Expr(value=ast.Call()):
                    yield "dropped call", node, "pass"
                case ast.Call(func=ast.Name(id="max" | "min" | "abs" | "sorted"), args=[first, *_]):
                    if not isinstance(first, ast.Starred | ast.GeneratorExp):
                        yield "dropped call", node, f"({ast.unparse(first)})"


def _walk(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes that are worked out: no annotations, texts, or words of errors."""
    yield node
    if isinstance(node, ast.JoinedStr | ast.Raise):
        return
    for name, child in ast.iter_fields(node):
        if name in {"annotation", "returns", "decorator_list"}:
            continue
        for each in child if isinstance(child, list) else [child]:
            if isinstance(each, ast.AST):
                yield from _walk(each)


def _is_text(node: ast.BinOp) -> bool:
    """Tell whether texts are put together."""
    return any(
        isinstance(each, ast.JoinedStr)
        or (isinstance(each, ast.Constant) and isinstance(each.value, str))
        for each in ast.walk(node)
    )


def _replaced(source: str, node: ast.expr | ast.stmt, text: str) -> str:
    """Return a file with another text in place of a node."""
    lines = source.encode().splitlines(keepends=True)
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line))
    whole = b"".join(lines)
    first = starts[node.lineno - 1] + node.col_offset
    last = starts[(node.end_lineno or node.lineno) - 1] + (node.end_col_offset or 0)
    return (whole[:first] + text.encode() + whole[last:]).decode()
