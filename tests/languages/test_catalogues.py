"""Catalogues: one text for every text in every language, with the same gaps; names of sheets that a workbook takes."""

from __future__ import annotations

import re
from itertools import count, pairwise

import pytest

from conveyor import shelf
from conveyor.languages import LANGUAGES, TRANSLATED
from conveyor.languages.catalogue import NUMBER_FORMATS, Catalogue, load_catalogue
from conveyor.languages.gapped_sentence import GAP
from conveyor.languages.number_format import NumberFormat
from conveyor.languages.translator import Translator, report_translator
from conveyor.models.given_names import given_notes
from conveyor.models.report import Report
from conveyor.report.excel import COMPARISON_SHEETS, SHEETS, SUMMARY_SHEET, VERIFICATION_SHEETS
from conveyor.shelf import built_in
from conveyor.units.sentences import degree_signs

WORDS = re.compile(r"[A-Za-z]{4,}")
SAME = {"de": 0.05, "es": 0.08, "pt": 0.08, "zh": 0.04}
"""Share of texts that a language may write as English does: names, symbols, words of the trade."""


@pytest.mark.parametrize("language", TRANSLATED)
def test_every_text_is_translated_with_its_gaps(language):
    entries = load_catalogue(language).texts
    assert entries.keys() == load_catalogue(TRANSLATED[0]).texts.keys()
    for english, translation in entries.items():
        assert translation.strip(), english
        gaps, taken = GAP.findall(english), GAP.findall(translation)
        numbers = sorted(int(number) if number else i for i, number in enumerate(taken))
        assert numbers == list(range(len(gaps))), (english, translation)
        assert not any(gaps), english
        translation.format(*range(len(gaps)))


@pytest.mark.parametrize("language", TRANSLATED)
def test_gaps_side_by_side_stay_so(language):
    """All that is behind a sentence fills the last one of them."""
    for english, translation in load_catalogue(language).texts.items():
        order = [int(number) if number else i for i, number in enumerate(GAP.findall(translation))]
        beside = {pair for pair in pairwise(order) if f"\0{pair[0]}\0\0{pair[1]}\0" in _numbered(translation)}
        pairs = pairwise(range(len(GAP.findall(english))))
        assert {pair for pair in pairs if f"\0{pair[0]}\0\0{pair[1]}\0" in _numbered(english)} <= beside, english


def _numbered(sentence):
    """A sentence with the numbers of its gaps between marks."""
    numbers = count()
    return GAP.sub(lambda gap: f"\0{gap[1] or next(numbers)}\0", sentence)


@pytest.mark.parametrize("language", TRANSLATED)
def test_notes_of_the_compounds_of_the_shelf_are_translated(language):
    texts = load_catalogue(language).texts
    for compound in map(shelf.compound, map(str, built_in().glob("*.yaml"))):
        written = set() if compound.kind == "illustrative" else {compound.fit.method}  # by conveyor fit
        notes = {degree_signs(note) for note in given_notes(compound) - written}
        assert {degree_signs(compound.description), degree_signs(compound.strain_dependence.reference_note)} <= notes
        assert notes <= texts.keys(), compound.name


def test_notes_that_no_catalogue_has_stay_whole():
    """Names stay even where a catalogue has them."""
    catalogue = Catalogue("de", {"belt": "Gurt", "as new": "wie neu"})
    translator = Translator(catalogue, {"belt"}, {"as new", "as new; belt", "worn; as new"})
    assert translator.text("as new (worn; as new)") == "wie neu (worn; as new)"
    assert (translator.text("belt"), translator.text("as new; belt")) == ("belt", "as new; belt")


@pytest.mark.parametrize("language", TRANSLATED)
def test_hardly_any_text_is_left_in_english(language):
    entries = {english: text for english, text in load_catalogue(language).texts.items() if WORDS.search(english)}
    same = [english for english, text in entries.items() if text == english]
    assert len(same) < SAME[language] * len(entries), same


@pytest.mark.parametrize("language", TRANSLATED)
def test_sheets_have_names_that_a_workbook_takes(language):
    translator = report_translator(language)
    for of in ((SUMMARY_SHEET, *SHEETS), COMPARISON_SHEETS, VERIFICATION_SHEETS):
        names = [translator.heading(name) for name in of]
        assert len(set(names)) == len(names)
        assert not any(re.search(r"[\[\]:*?/\\']", name) or len(name) > 31 for name in names), names
        assert translator.missing == {}


def test_languages_of_the_spec_are_those_with_a_catalogue():
    assert Report().language == "en"
    for language in LANGUAGES:
        assert Report(language=language).language == language
    assert set(NUMBER_FORMATS) == set(TRANSLATED) == set(LANGUAGES) - {"en"}
    with pytest.raises(KeyError):
        load_catalogue("en")


@pytest.mark.parametrize(
    ("language", "written"),
    [("de", "1.250,5 kW"), ("es", "1250,5 kW"), ("pt", "1.250,5 kW"), ("zh", "1,250.5 kW")],
)
def test_numbers_are_written_as_the_language_has_them(language, written):
    assert report_translator(language).text("1,250.5 kW") == written


def test_the_inch_is_no_word():
    translator = report_translator("es")
    assert (translator.text("in"), translator.text("2.5 in"), translator.heading("in")) == ("in", "2,5 in", "en")


def test_large_numbers_of_spanish_are_grouped():
    assert report_translator("es").text("12,500 kW") == "12.500 kW"


@pytest.mark.parametrize(
    "same", ["2026-11-28", "0.1.0", "ISO 5048, F_St", "DIN 22101:2011, 5.1.2", "belt.speed", "6305"]
)
def test_dates_versions_clauses_and_fields_stay(same):
    translator = report_translator("de")
    assert (translator.text(same), translator.missing) == (same, {})


def test_longer_sentences_go_first_and_parts_are_translated():
    entries = {
        "drive {}": "Antrieb {}",
        "drive force": "Antriebskraft",
        "worst for {}": "ungünstigst für {}",
        "full": "voll",
    }
    translator = Translator(Catalogue("de", entries, NumberFormat(",", ".")), frozenset({"full"}))
    assert translator.text("worst for drive force, 2.5 kN") == "ungünstigst für Antriebskraft, 2,5 kN"
    assert (translator.text("drive full"), translator.text("full")) == ("Antrieb voll", "full")
    assert translator.heading("full") == "voll"
    assert translator.text("Drive force") == "Antriebskraft"
    assert translator.text("  drive force\n") == "  Antriebskraft\n"


@pytest.mark.parametrize(
    ("english", "german"),
    [
        ("top", "top"),
        ("thickness of the top cover", "Dicke der Deckplatte oben"),
        ("required top cover", "erforderliche Deckplatte oben"),
        ("travel, load", "Spannweg, Last"),
        ("load, carry, start", "load, Obertrum, Anfahren"),
        ("full (worst for drive force)", "voll (ungünstigster für Antriebskraft)"),
        ("diameter, head pulley", "Durchmesser, Trommel head"),
        ("head transition: no strip slack", "Übergang am Kopf: kein Streifen schlaff"),
        ("concave curve, top, carry: no strip slack", "Kurve konkav, top, Obertrum: kein Streifen schlaff"),
        (
            'section "top", carry: the empty belt lifts off on the concave curve of 200.5 m; no radius helps',
            'Abschnitt "top", Obertrum: der leere Gurt hebt ab in der Kurve (konkav) mit Radius 200,5 m; '
            "kein Radius hilft",
        ),
    ],
)
def test_names_that_are_words_of_the_report_leave_it_its_words(english, german):
    """A section "top" or "load", a pulley "head", a case "full"."""
    translator = report_translator("de", frozenset({"top", "load", "head", "full"}))
    assert (translator.text(english), translator.missing) == (german, {})


@pytest.mark.parametrize(
    ("english", "german"),
    [
        ("DIN 22101, f = 0.022", "DIN 22101, f = 0,022"),
        ("main resistance, f = 0.018 to 0.028, carry", "Hauptwiderstand, f = 0,018 bis 0,028, Obertrum"),
        (
            "gravel, 1,600 kg/m³ (at its heaviest 1,900 kg/m³)",
            "gravel, 1.600 kg/m³ (im schwersten Zustand 1.900 kg/m³)",
        ),
        ("lift force, carry", "Steigungswiderstand, Obertrum"),
        ("Tyc, flexure of the belt, carry", "Tyc, Walkwiderstand des Gurts, Obertrum"),
        ("Tx 0.0082, Tyc 0.0047", "Tx 0,0082, Tyc 0,0047"),
    ],
)
def test_symbols_keep_their_letters_and_have_the_numbers_of_the_language(english, german):
    translator = report_translator("de", frozenset({"gravel"}))
    assert (translator.text(english), translator.missing) == (german, {})


def test_a_sentence_before_another_is_translated():
    both = "Every cleaner takes the same share of what reaches it; over the width of its blade. speed"
    assert report_translator("de").text(both).startswith("Jeder Abstreifer nimmt denselben Anteil")


def test_what_has_no_translation_is_named_and_stays():
    translator = Translator(Catalogue("de", {"belt": "Gurt"}, NumberFormat(",", ".")))
    assert translator.text("belt; something else") == "Gurt; something else"
    assert list(translator.missing) == ["something else"]


def test_names_in_quotes_and_paths_are_not_translated():
    translator = Translator(
        Catalogue("de", {'"{}" of {}': '"{}" von {}', "idlers.{}: {}": "idlers.{}: {}", "return": "Untertrum"})
    )
    assert translator.text('"return" of return') == '"return" von Untertrum'
    assert translator.text("idlers.return: return") == "idlers.return: Untertrum"


@pytest.mark.parametrize("language", TRANSLATED)
def test_pulleys_that_stand_in_for_missing_ones_have_names(language):
    words = report_translator(language)
    for name in ("head", "bend 1", "take-up", "bend 2", "tail"):
        for text in (name, f"wrap, {name}", f"bearings, {name}"):
            assert name not in words.text(text)
    assert words.missing == {}
