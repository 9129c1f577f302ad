"""Names an engineer guesses (CONTRIBUTING.md, Words): verbs, quantities and nouns of the field."""

from __future__ import annotations

import ast
import collections
import re
from collections.abc import Iterator
from pathlib import Path

from conveyor.units.unit_systems import SYSTEMS

ROOT = Path(__file__).parent.parent
FILES = sorted((ROOT / "conveyor").rglob("*.py"))
GLOSSARY = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").partition("\n## Words\n")[2].partition("\n## ")[0]

IRREGULAR = set(
    "begun borne bound bought broken brought built chosen cut done drawn driven fallen felt found given gone grown "
    "held hidden kept known laid left lent lost made met paid put read ridden risen run said seen sent set shown sold "
    "sought spent spoken stood struck sunk taken thrown told torn won worn written".split()
)
"""Participles that do not end in -ed."""
NOUNS_IN_ED = {"bed", "feed", "need", "seed", "speed"}

ONE_WORD = set(
    "anchor calibrate compare contact desk doctor dynamics fit new optimise power schema shelf size study template "
    "validate "  # commands
    "load calculate dump fingerprint main "
    "solve frictions interior hunter winkler "  # contact: what is solved, and whose closed form
    "bootstrap superpose aicc "  # rubber
    "annuity carryback skirtboards "  # laws
    "belts rolls materials spacings folders names compound resolver "  # shelf and libraries
    "si quantity text percent message require element slug option argument".split()
)
"""Functions of one word: the field's own or everybody's."""


def module_functions() -> list[tuple[str, str]]:
    """File and name of every function of a module, without the underscores around it."""
    return [
        (str(path.relative_to(ROOT)), node.name.strip("_"))
        for path in FILES
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and not node.name.startswith("__")
    ]


def test_no_function_is_a_bare_participle():
    ends_in_ed = re.compile(r"[a-z]{2,}ed")
    assert [
        (path, name)
        for path, name in module_functions()
        if name in IRREGULAR or (ends_in_ed.fullmatch(name) and name not in NOUNS_IN_ED)
    ] == []


def test_functions_of_one_word_are_words_of_the_field():
    single = {name for _, name in module_functions() if "_" not in name}
    assert single - ONE_WORD == set(), (
        "a second word says what is done or returned; commands, and words that everybody knows, stand in ONE_WORD"
    )
    assert ONE_WORD - single == set(), "leave the list when the function goes"


def test_no_file_name_stands_twice():
    names = collections.Counter(path.stem for path in FILES if not path.stem.startswith("__"))
    assert {name for name, count in names.items() if count > 1} == set()


def test_the_glossary_names_what_there_is():
    """Every class and function in backticks stands in the package; every word has one row."""
    source = "\n".join(path.read_text(encoding="utf-8") for path in FILES)
    named = set(re.findall(r"`([A-Za-z_]\w+)`", GLOSSARY))
    assert named, "CONTRIBUTING.md has a part Words"
    assert {name for name in named if not re.search(rf"\b{name}\b", source)} == set()
    rows = re.findall(r"^\| ([^|]+?) \|", GLOSSARY, re.M)
    assert [word for word, count in collections.Counter(rows).items() if count > 1] == []


def test_docstrings_of_functions_do_not_begin_with_riddles():
    """A docstring says what comes back or what is done; it does not begin with "Of" or a question word."""
    riddle = re.compile(r"(Of|Whether|What|Where|Which|How|Why)\b")
    assert [
        (str(path.relative_to(ROOT)), node.name, line)
        for path in FILES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        and (line := (ast.get_docstring(node) or "").split("\n")[0])
        and riddle.match(line)
    ] == []


def test_docstrings_list_every_system_of_units():
    every = "{" + ", ".join(f'"{name}"' for name in SYSTEMS) + "}"
    listed = {
        (str(path.relative_to(ROOT)), written)
        for path in FILES
        for written in re.findall(r"(?:system|units) : (\{[^}]*\})", path.read_text(encoding="utf-8"))
    }
    assert listed, "docstrings list the systems"
    assert {one for one in listed if one[1] != every} == set(), f"the systems of units are {every}"


def described_arguments() -> Iterator[tuple[str, str, str, ast.arguments]]:
    """File and function, names, kind as its docstring describes them, and its arguments, of every such entry."""
    for path in FILES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                continue
            _, _, described = (ast.get_docstring(node) or "").partition("Parameters\n----------\n")
            for names, kind in re.findall(r"^(\w[\w, ]*) : (.*)$", described.split("\n\n")[0], re.MULTILINE):
                for name in names.split(", "):
                    yield f"{path.relative_to(ROOT)}: {node.name}", name, kind, node.args


def test_docstrings_describe_arguments_that_exist_and_optional_ones_have_defaults():
    gone, required = [], []
    for where, name, kind, args in described_arguments():
        by_place = [*args.posonlyargs, *args.args]
        rest = [one for one in (args.vararg, args.kwarg) if one is not None]
        defaults = [None] * (len(by_place) - len(args.defaults)) + [*args.defaults] + [*args.kw_defaults]
        found = dict(zip((one.arg for one in (*by_place, *args.kwonlyargs)), defaults, strict=True))
        if name not in found and name not in {one.arg for one in rest}:
            gone.append((where, name))
        elif "optional" in kind and found.get(name) is None:
            required.append((where, name))
    assert gone == []
    assert required == []
