"""Reports in every language: nothing of the report's own words is left in English, nothing of the user's is touched."""

from __future__ import annotations

import ast
import functools
import re
from itertools import count
from pathlib import Path
from typing import get_args

import openpyxl
import pytest

from conveyor import analyse, load
from conveyor.default_bands import DEFAULTS
from conveyor.errors import InputError
from conveyor.fitting.fit_verdict import GLOSSARY
from conveyor.laboratory import read_dma
from conveyor.languages import TRANSLATED
from conveyor.languages.catalogue import load_catalogue
from conveyor.languages.gapped_sentence import GAP
from conveyor.languages.translator import report_translator
from conveyor.models.belt import Carcass
from conveyor.report import excel, html, pdf, table_model
from conveyor.report.tables.analysis_contents import analysis_contents
from conveyor.report.translated_page import translate_page
from conveyor.report.translated_workbook import translate_table
from conveyor.results.analysis import analyse_studies
from conveyor.text.markup import Html, Markup, element, join_html

ROOT = Path(__file__).parents[2]
SPECS = ROOT / "examples" / "specs"
EVERY = sorted(path.stem for path in SPECS.glob("*.yaml"))
WHERE = (
    "a text without a translation: an entry in every conveyor/languages/*.po, in the order of its msgid, with {} for "
    "figures and names"
)


@functools.cache
def contents(name, system="SI"):
    line = load(SPECS / f"{name}.yaml")
    result = analyse(line)
    return analysis_contents(result.assess(analyse_studies(line, result)).in_units(system))


WORD = re.compile(r"[A-Za-z][a-z]{2,}")
GIVEN = re.compile(r'"[^"]*"|\w+_\w+|\b[a-z_]+(?:\[\d+\])?(?:\.[a-z_]+)+')
"""Names in quotes, keys and paths of fields, the same in every language."""


@pytest.fixture
def translators(monkeypatch):
    """Translators that reports make, in order."""
    made = []
    monkeypatch.setattr(table_model, "report_translator", lambda *of: made.append(report_translator(*of)) or made[-1])
    return made


@functools.cache
def english_words(language):
    """Words that texts of reports have in English, and none in a language."""
    texts = load_catalogue(language).texts
    english = {word.lower() for text in texts for word in WORD.findall(text)}
    return english - {word.lower() for text in texts.values() for word in WORD.findall(text)}


def left_in_english(texts, report):
    """Texts with a word that is neither of the language nor of a name."""
    given = report.document.names() | report.document.notes()
    known = english_words(report.document.language) - {word.lower() for name in given for word in WORD.findall(name)}
    return [text for text in texts if known & {word.lower() for word in WORD.findall(GIVEN.sub("", text))}]


def page_texts(page):
    """Texts of a page and of its drawings, without what is the same in every language."""
    if page.attributes.get("translate") != "no" and page.tag != "style":
        yield from (said for name, said in page.attributes.items() if name in {"aria-label", "alt", "title"})
        for part in page.content:
            if isinstance(part, Html):
                yield from page_texts(part)
            else:
                yield from re.findall(r"<text[^>]*>([^<]*)<", part) if isinstance(part, Markup) else (part,)


def sheet_texts(book, report):
    """Texts of the cells and titles of charts of a workbook, without what is the same in every language."""
    kept = {
        column.get(row)
        for part in report.by_key.values()
        for column in part.columns
        if column.verbatim
        for row in part.rows
    }
    for sheet in book.worksheets:
        yield sheet.title
        yield from (
            cell.value
            for row in sheet.iter_rows()
            for cell in row
            if isinstance(cell.value, str) and cell.data_type != "f" and cell.value not in kept
        )
        for chart in sheet._charts:
            titles = [title for title in (chart.title, chart.x_axis.title, chart.y_axis.title) if title is not None]
            yield from (run.t for title in titles for line in title.tx.rich.p for run in line.r)


@pytest.mark.parametrize("name", EVERY)
def test_every_example_is_translated_whole(name, translators):
    """All that page and workbook show, in German; what is missing in it is missing in all."""
    report = contents(name, "US" if name.endswith("_us") else "SI").in_language("de")
    book, page = excel.build_workbook(report), html.build_page(report)
    assert [words.missing for words in translators] == [{}, {}], WHERE
    assert left_in_english(page_texts(page), report) == []
    assert left_in_english(sheet_texts(book, report), report) == []


@pytest.mark.parametrize("name", EVERY)
@pytest.mark.parametrize("language", TRANSLATED[1:])
def test_tables_of_every_example_are_translated(name, language):
    report = contents(name, "US" if name.endswith("_us") else "SI").in_language(language)
    words = report.make_translator()
    texts = []
    for part in report.by_key.values():
        made = translate_table(part, words)
        texts += [made.heading, made.note, made.foot, *(column.label for column in made.columns)]
        texts += [
            cell
            for row in made.rows
            for column in made.columns
            if column.kind != "verdict" and not column.verbatim and isinstance(cell := column.get(row), str)
        ]
    assert words.missing == {}, WHERE
    assert left_in_english(texts, report) == []


def test_a_file_is_the_same_whatever_was_written_before_it():
    """In a row that has each kind of file after each other."""

    def written(kind, report):
        if kind == "xlsx":
            return list(sheet_texts(excel.build_workbook(report), report))
        return str(html.build_page(report, on_paper=kind == "paper"))

    alone = {kind: written(kind, contents("weighed").in_language("de")) for kind in ("xlsx", "page", "paper")}
    assert "3,5 m/s" in alone["page"]
    assert "4,5 m, mindestens 4,35 m" in alone["xlsx"]
    report = contents("weighed").in_language("de")
    for kind in ("xlsx", "page", "paper", "page", "xlsx", "paper", "xlsx"):
        assert written(kind, report) == alone[kind]


@pytest.mark.parametrize(
    ("language", "at"),
    [
        ("de", "Masterkurve bei 0,1 % (angenommen, das Spektrum ist konstruiert)"),
        ("es", "curva maestra a 0,1 % (supuesta, el espectro es construido)"),
        ("pt", "curva mestra a 0,1 % (adotada, o espectro é construído)"),
        ("zh", "以主曲线为准，其应变 0.1 % (取定值，谱为构造)"),
    ],
)
def test_a_note_of_a_compound_stands_behind_its_figure(language, at):
    report = contents("overland").in_language(language)
    words = report.make_translator()
    said = [words.text(row.text) for row in report["remarks"].rows]
    assert sum(at in one for one in said) == 2
    assert words.missing == {}, WHERE


def test_links_and_signs_of_numbers_hold_in_a_translation(tmp_path):
    german = contents("overland_10km").in_language("de")
    page = str(html.build_page(german))
    assert '<html lang="de">' in page
    assert "Ausreichend wie vorgegeben" in page
    assert "5,5 m/s" in page
    assert "5.5 m/s" not in re.sub(r'<t[dh][^>]*translate="no".*?</t[dh]>', "", page)  # the spec's own stays
    path = excel.write_workbook(german, tmp_path / "german.xlsx")
    book = openpyxl.load_workbook(path)
    assert "Zusammenfassung" in book.sheetnames
    assert {"table_checks", "what_if_motor_reserve"} <= set(book.defined_names)  # links hold in every language
    assert book.defined_names["table_checks"].attr_text.startswith("'Prüfungen und Hinweise'!")
    link = next(cell for row in book["Zusammenfassung"] for cell in row if cell.hyperlink)
    assert link.hyperlink.location == "'Prüfungen und Hinweise'!A1"


def test_what_the_user_named_stays(tmp_path):
    spec = (SPECS / "slider.yaml").read_text(encoding="utf-8").replace("name: incline", "name: drive")
    path = tmp_path / "named.yaml"
    path.write_text(spec + "report: {language: es, client: full}\n", encoding="utf-8")
    line = load(path)
    report = analysis_contents(analyse(line).assess(analyse_studies(line, analyse(line))).in_units("SI"))
    page = str(html.build_page(report))
    assert '<html lang="es">' in page
    assert ">full<" in page
    assert ">drive, carga<" in page
    assert "carga" in page


def test_the_language_changes_no_figure_and_no_fingerprint():
    line = load(SPECS / "slider.yaml")
    spanish = line.replace(report=line.report.replace(language="es"))
    one, other = (
        analysis_contents(analyse(each).assess(analyse_studies(each, analyse(each))).in_units("SI"))
        for each in (line, spanish)
    )
    assert one.document.fingerprint == other.document.fingerprint
    assert {key: part.records() for key, part in one.by_key.items() if not key.startswith("inputs")} == {
        key: part.records() for key, part in other.by_key.items() if not key.startswith("inputs")
    }


def test_an_unknown_language_is_refused_with_the_known_ones(tmp_path):
    path = tmp_path / "french.yaml"
    path.write_text((SPECS / "slider.yaml").read_text(encoding="utf-8") + "report: {language: fr}\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"report\.language: got \"fr\", allowed: 'en', 'de', 'es', 'pt' or 'zh'"):
        load(path)


FILLING = {"of.zone.name": "head", "bad": "a strip of the belt goes slack", "relation": "at most"}
"""Words of the program that fill gaps of its sentences."""


def _messages(folder):
    """Sentences of calls of `message` and of `why` in a folder's modules, with {} where something is put in."""
    for path in sorted((ROOT / "conveyor" / folder).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            if isinstance(node.func, ast.Name) and node.func.id == "message" and node.args:
                yield path.name, _sentence(node.args[0])
            for keyword in node.keywords:
                if keyword.arg in {"why", "missing", "source"}:
                    yield path.name, _sentence(keyword.value)


def _sentence(node):
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value.replace("{calculated}", "{}").replace("{required}", "{}")
    if isinstance(node, ast.JoinedStr):
        parts = [
            part.value if isinstance(part, ast.Constant) else FILLING.get(ast.unparse(part.value), "\0")
            for part in node.values
        ]
        return re.sub(r"\{(?:calculated|required)?\}", "{}", "".join(parts)).replace("\0", "{}")
    return ""


@pytest.mark.parametrize("language", TRANSLATED)
@pytest.mark.parametrize("folder", ["checks", "remarks", "dynamics"])
def test_every_sentence_of_checks_and_remarks_is_translated(folder, language):
    """Whatever fills its gaps, and with all of it; also those that no example says."""
    words, found = report_translator(language), 0
    for name, sentence in _messages(folder):
        if not re.search(r"[a-z]{3}", GAP.sub("", sentence)) or name in {"scenario_sizing.py", "machines.py"}:
            continue
        found += 1
        numbers = count(11)
        filled = GAP.sub(lambda _, numbers=numbers: f"{next(numbers)}", sentence.replace("{{", "{").replace("}}", "}"))
        assert sorted(re.findall(r"\d", words.text(filled))) == sorted(re.findall(r"\d", filled)), filled
    assert found > {"checks": 100, "remarks": 40, "dynamics": 10}[folder]
    assert words.missing == {}, WHERE


def _literals(tree):
    """Texts of a module without its docstrings, also those joined to others, with {} where something is put in."""
    inner = {part for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
    inner |= {node.value for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant | ast.JoinedStr) and node not in inner:
            yield _sentence(node)


def test_every_piece_of_a_sentence_of_checks_is_translated():
    """Sentences joined of pieces are divided at the same places, or have a gap for what is joined."""
    unknown, found = [], 0
    for path in sorted((ROOT / "conveyor" / "checks").rglob("*.py")):
        for piece in _literals(ast.parse(path.read_text(encoding="utf-8"))):
            if re.search(r"[a-z]{3} ", GAP.sub("", piece)):
                found += 1
                one = GAP.sub("7", re.sub(r"(?<=[\w)])\{\}$", "", piece).replace("{{", "{").replace("}}", "}"))
                if all(_missing("de", words) for words in (one, one.strip(" ,;"))):
                    unknown.append(one)
    assert found > 200
    assert unknown == [], WHERE


def _missing(language, text):
    words = report_translator(language)
    words.text(text)
    return words.missing


@pytest.mark.parametrize("language", TRANSLATED)
def test_failed_curves_and_transitions_are_translated(language):
    words = report_translator(language)
    ails = ("the empty belt lifts off", "a strip of the belt is overstressed", "a strip of the belt goes slack")
    cures = ("", "; or raise the pulley towards half trough", "; or raise the pulley towards half the pipe")
    for kind in ("concave", "convex", "horizontal", "concave and horizontal"):
        for bad in ails:
            for cure in ("no radius helps", "at least 318.5 m are needed"):
                words.text(f'section "X2", carry: {bad} on the {kind} curve of 200.5 m; {cure}')
    for place in ("head", "tail", "head, return", "tail, return"):
        for fine in (
            "no strip slack",
            f"no strip slack, length of the {place} transition, strips slackened and 10 more",
        ):
            words.text(f"load state worst for {place} transition: {fine}, 20 °C")
        for bad in ails[1:]:
            words.text(f"{place} transition: {bad} whatever its length, at a belt tension of 5.5 to 9 N/mm per width")
            for cure in cures:
                needed = "at least 1.32 m are needed (ISO 5293 taken on to every strip)"
                translated = words.text(f"{place} transition: {bad} over 0.9 m; {needed}{cure}")
                assert ("0,9" in translated) == (language != "zh")
    assert words.missing == {}, WHERE


def test_notes_on_reading_laboratory_files_are_translated():
    """Of every file that is read, and those of code that no file says."""
    words, said = report_translator("zh"), 0
    for path in sorted((ROOT / "tests" / "laboratory" / "files").glob("*/*")):
        try:
            read = read_dma(path)
        except InputError:
            continue
        said += len(read.understood)
        for line in read.understood:
            words.text(f"{path.name}: {line}")
    assert said > 300
    for path in sorted((ROOT / "conveyor" / "laboratory").glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            called = node.func if isinstance(node, ast.Call) else None
            if isinstance(called, ast.Attribute) and (called.attr, ast.unparse(called.value)) == ("append", "notes"):
                words.text(GAP.sub("7", _sentence(node.args[0])))
    assert words.missing == {}, WHERE


def test_glossary_of_fits_is_translated():
    words = report_translator("pt")
    for pair in GLOSSARY:
        for text in pair:
            words.text(text)
    assert words.missing == {}, WHERE


def test_marked_elements_and_styles_stay():
    words = report_translator("de")
    page = element(
        "html",
        element("style", Markup("p > a { drive: 0 }")),
        element("td", "drive", element("b", "drive", title="drive"), translate="no", data_label="drive"),
        element("p", "drive", element("br"), "< 1.5 kN", title="drive"),
        lang="en",
    )
    assert str(translate_page(page, words)) == (
        '<!DOCTYPE html>\n<html lang="de"><style>p > a { drive: 0 }</style>'
        '<td translate="no" data-label="Antrieb">drive<b title="drive">drive</b></td>'
        '<p title="Antrieb">Antrieb<br>&lt; 1,5 kN</p></html>\n'
    )


def test_attributes_that_are_read_out_are_translated_and_no_others():
    made = translate_page(element("img", alt="drive", aria_label="drive", name="drive"), report_translator("de"))
    assert made.attributes == {"alt": "Antrieb", "aria-label": "Antrieb", "name": "drive"}


def test_a_heading_is_the_reports_own_though_a_name_is_spelled_so():
    """What follows the first element in it is text."""
    words = report_translator("de", frozenset({"drive"}))
    page = join_html([element("dt", "drive"), element("dd", "drive"), element("th", "drive", scope="col")])
    assert translate_page(page, words).text == "AntriebdriveAntrieb"
    named = report_translator("de", frozenset({"drive"}))
    assert translate_page(element("dt", element("b", "x"), "drive"), named).text == "xdrive"


def test_pdf_has_the_language_and_its_hyphens():
    page = html.build_page(contents("slider").in_language("pt"), on_paper=True)
    assert '#set text(lang: "pt", hyphenate: true)' in pdf.typst_source(page, "A4")
    assert pdf.page_pdf(page, "A4").startswith(b"%PDF")


def test_pdf_in_chinese_needs_a_font_with_its_letters(monkeypatch):
    page = html.build_page(contents("slider").in_language("zh"), on_paper=True)
    typst = pytest.importorskip("typst")
    known = typst.Fonts(include_system_fonts=False)
    monkeypatch.setattr(typst, "Fonts", lambda **_: known)
    with pytest.raises(InputError, match="PDF in Chinese needs a font with Chinese letters"):
        pdf.page_pdf(page, "A4")
    assert pdf._chinese_font(["DejaVu Sans", "Noto Sans CJK SC"]) == "Noto Sans CJK SC"


def test_fonts_of_pdf_come_with_matplotlib(tmp_path):
    """Also where the machine has none of them."""
    typst = pytest.importorskip("typst")
    pdf.copy_fonts(tmp_path)
    assert "DejaVu Sans" in typst.Fonts(include_system_fonts=False, font_paths=[tmp_path]).families()


@pytest.mark.parametrize("language", TRANSLATED)
def test_every_kind_of_carcass_is_translated(language):
    words = report_translator(language)
    for kind in get_args(Carcass.model_fields["kind"].annotation):
        words.text(f"{kind}, 1 ply, breaking 400 N/mm")
        words.text(f"{kind}, 4 plies, rated 330 PIW")
    assert words.missing == {}, WHERE


@pytest.mark.parametrize("language", TRANSLATED)
def test_every_default_with_a_band_is_translated(language):
    words = report_translator(language)
    for one in DEFAULTS:
        words.text(one.what)
    assert words.missing == {}, WHERE
