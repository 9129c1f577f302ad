"""The page as PDF: every word that prints is in it, on the paper asked for, whatever the words are."""

from __future__ import annotations

import re
from collections import Counter
from html.parser import HTMLParser
from importlib import util
from io import BytesIO
from pathlib import Path

import pypdf
import pytest

import conveyor
from conveyor.errors import InputError
from conveyor.files import output_marks
from conveyor.report import html, page_elements, pdf
from conveyor.report.table_model import Column, Table
from conveyor.results.analysis import analyse_studies
from conveyor.text.markup import Html, join_html
from tests.command_line import run
from tests.report.reading import HOSTILE, VOID

EXAMPLES = Path(__file__).parent.parent.parent / "examples"
SPECS = EXAMPLES / "specs"
NOT_PRINTED = {"head", "nav", "details", "button", "footer", "svg"}


class Printed(HTMLParser):
    """Words of a page that a browser prints, cell by cell."""

    def __init__(self, text):
        super().__init__()
        self.hidden, self.open, self.words = 0, [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag not in VOID:
            self.open.append(tag in NOT_PRINTED or (dict(attrs).get("class") or "") in {"unprinted", "further"})
            self.hidden += self.open[-1]

    def handle_endtag(self, _):
        self.hidden -= self.open.pop()

    def handle_data(self, data):
        if not self.hidden and data.strip():
            self.words.append(data)


def bare(text):
    return re.sub(r"\s", "", text)


def read(content):
    return pypdf.PdfReader(BytesIO(content))


def text_of(content):
    return bare("".join(one.extract_text() for one in read(content).pages))


def sheets(*content):
    parts = [page_elements.PagePart("x", "Part", join_html(content))]
    return read(pdf.page_pdf(page_elements.page_html("Ore 1", "r", Html(), parts, "foot"), "A4")).pages


@pytest.fixture(scope="module")
def report():
    line = conveyor.load(EXAMPLES / "specs" / "in_plant_us.yaml")
    return conveyor.analyse(line), analyse_studies(line)


@pytest.fixture(scope="module")
def built(report):
    analysis, asked = report
    return html.build_page(analysis.contents(asked))


def test_every_word_that_prints_is_in_it_and_nothing_less_often(built):
    words = Counter(map(bare, Printed(str(built)).words))
    found = text_of(pdf.page_pdf(built, "A4"))
    assert sum(words.values()) > 500
    assert {word: n for word, n in words.items() if found.count(word) < n} == {}


def test_what_is_not_printed_is_not_in_it(built):
    hidden = re.findall(r"<summary>(.*?)</summary>", str(built))
    assert hidden
    text = text_of(pdf.page_pdf(built, "A4"))
    assert [words for words in hidden if bare(words) in text] == []


@pytest.mark.parametrize(("paper", "size"), [("A4", (595.28, 841.89)), ("Letter", (612.0, 792.0))])
def test_paper_title_and_bookmarks_are_those_of_the_page(paper, size):
    parts = [page_elements.PagePart("x", "Forces", page_elements.bullet_list(["one"]))]
    page = page_elements.page_html("Ore 1", "a report", Html(), parts, "foot", paper=paper)
    made = read(pdf.page_pdf(page, paper))
    (sheet,) = made.pages
    assert (float(sheet.mediabox.width), float(sheet.mediabox.height)) == pytest.approx(size, abs=0.01)
    assert made.metadata is not None
    assert made.metadata.title == "Ore 1"
    assert [one["/Title"] for one in made.outline[1]] == ["Forces"]


def test_a_table_has_its_heads_on_every_page():
    column = Column("force of a name that is found nowhere else", "force", float)
    shown = page_elements.table_html(Table("t", "", "", (column,), range(200)), "Forces")
    made = sheets(shown)
    assert len(made) > 2
    assert all(bare(column.label) in bare(sheet.extract_text()) for sheet in made)


def test_words_of_a_wide_table_are_whole():
    words = "extraordinarily"
    columns = tuple(
        Column(f"{words} {k}", "text", lambda _, k=k: f"{words} {words}{k}" if k % 2 else "x") for k in range(12)
    )
    shown = page_elements.table_html(Table("t", "", "", columns, range(3)), "Wide")
    text = sheets(shown)[0].extract_text().split()
    assert text.count(words) >= 12 + 3 * 6  # the first head stands above every part
    assert sum(f"{words}{k}" in text for k in range(1, 12, 2)) == 6


def test_a_table_wider_than_its_paper_is_parted_and_names_its_rows_in_every_part():
    columns = (
        Column("row", "text", "name{}".format),
        *(Column(f"head{k}", "force", lambda _, k=k: 1e6 * k) for k in range(40)),
    )
    shown = page_elements.table_html(Table("t", "", "", columns, range(2)), "Wide")
    text = sheets(shown)[0].extract_text().split()
    assert {f"head{k}" for k in range(40)} <= set(text)
    assert text.count("name0") == text.count("name1") == text.count("row") > 1
    assert text.count("head7") == 1


@pytest.mark.parametrize("name", ["overland_10km", "in_plant_us", "transfer", "curved"])
def test_no_letter_on_paper_is_smaller_than_eight_points(name):
    line = conveyor.load(EXAMPLES / "specs" / f"{name}.yaml")
    source = pdf.typst_source(
        html.build_page(conveyor.analyse(line).contents(analyse_studies(line)), on_paper=True), "A4"
    )
    sizes = [float(size) for size in re.findall(r"#captioned\(\w+,\n([\d.]+)pt,", source)]
    assert len(sizes) > 10
    assert min(sizes) == pytest.approx(8.0)
    half = 0.5 * (595.28 - 2 * 13 * 72 / 25.4 - 8.0)  # a column between margins and gutter of page.typ [pt]
    drawn = re.findall(r'<svg[^>]*viewBox=\\"0 0 ([\d.]+) [\d.]+\\"(.*?)</svg>', source)
    found = ((float(width), float(size)) for width, text in drawn for size in re.findall(r"font-size: ([\d.]+)", text))
    letters = [half / width * size for width, size in found]
    assert len(letters) > 50
    assert min(letters) > 7.95  # 9 pt on 4 in, to the rounding of that


@pytest.mark.parametrize("words", [HOSTILE, '#panic("x") [a] *b* _c_ `d` $e$ <f> @g \\ // /* "', "Ωμ °C ≥ δ ✓ – é ß ж"])
def test_words_are_not_markup(words):
    parts = [page_elements.PagePart("p", words, page_elements.bullet_list([words]))]
    made = page_elements.page_html(words, words, page_elements.fact_list([(words, words)]), parts, words)
    (as_printed,) = Printed(str(page_elements.bullet_list([words]))).words
    found = text_of(pdf.page_pdf(made, "A4"))
    assert found.count(bare(as_printed)) == 7  # kind, title, fact twice, heading, line, foot


@pytest.mark.parametrize(
    ("content", "longest"),
    [
        (page_elements.bullet_list(["x" * 400]), 160),
        (page_elements.fact_list([("client", "x" * 60)]), 30),
        (
            page_elements.table_html(Table("t", "", "", (Column("head", "text", lambda _: "x" * 400),), range(2)), "T"),
            160,
        ),
    ],
)
def test_a_word_longer_than_its_line_is_broken(content, longest):
    (sheet,) = sheets(content)
    text = sheet.extract_text()
    assert text.count("x") >= 60
    assert max(map(len, text.splitlines())) < longest


def test_a_long_word_does_not_make_the_letters_of_its_table_small():
    columns = (Column("name", "text", lambda _: "x" * 400), Column("mark", "text", lambda _: "beside"))
    sizes = {}
    (sheet,) = sheets(page_elements.table_html(Table("t", "", "", columns, range(2)), "Wide"))
    sheet.extract_text(visitor_text=lambda text, _cm, _tm, _font, size: sizes.setdefault(text.strip(), size))
    assert sizes["beside"] == pytest.approx(8.0, abs=0.01)


def test_a_short_table_of_long_texts_goes_on_on_the_next_page():
    column = Column("note", "text", lambda k: f"mark{k}. " + "words " * 600)
    made = sheets(page_elements.table_html(Table("t", "", "", (column,), range(12)), "Notes"))
    found = [len(re.findall(r"mark\d+", sheet.extract_text())) for sheet in made]
    assert sum(found) == 12
    assert max(found) < 6


def test_a_letter_that_the_font_lacks_is_not_drawn_by_the_font_of_last_resort():
    (sheet,) = sheets(page_elements.bullet_list(["\u4e2d ore"]))
    fonts = [str(one.get_object()["/BaseFont"]) for one in sheet["/Resources"]["/Font"].values()]
    assert fonts
    assert [name for name in fonts if "LastResort" in name] == []


@pytest.mark.parametrize(
    "content",
    [
        page_elements.fact_list([]),
        page_elements.fact_list([], "tiles"),
        page_elements.table_html(Table("t", "", "", (), range(2)), "Empty"),
    ],
)
def test_what_is_empty_prints_as_nothing(content):
    (sheet,) = sheets(content, page_elements.bullet_list(["after it"]))
    assert "after it" in sheet.extract_text()


def test_the_same_page_gives_the_same_bytes_and_is_known_again(built):
    made = pdf.page_pdf(built, "A4")
    assert made == pdf.page_pdf(built, "A4")
    assert output_marks.output_kind(made) == output_marks.PAGE


def test_it_is_refused_before_anything_is_written(report, tmp_path, monkeypatch):
    analysis, _ = report
    with pytest.raises(InputError, match=r'a\.html: a PDF\'s name ends in \.pdf, got "\.html"'):
        analysis.to_pdf(tmp_path / "a.html")
    with pytest.raises(InputError, match="its folder does not exist"):
        analysis.to_pdf(tmp_path / "none" / "a.pdf")
    monkeypatch.setattr(pdf, "find_spec", lambda name: None if name == "typst" else util.find_spec(name))
    with pytest.raises(InputError, match=r'PDF needs the package typst \(pip install "conveyor\[pdf\]"\)'):
        analysis.to_pdf(tmp_path / "a.pdf")
    assert list(tmp_path.iterdir()) == []


def test_results_write_it(report, tmp_path):
    analysis, asked = report
    assert analysis.to_pdf(tmp_path / "a.pdf", asked, system="SI") == tmp_path / "a.pdf"
    (tmp_path / "a.pdf").read_bytes()
    assert float(read((tmp_path / "a.pdf").read_bytes()).pages[0].mediabox.width) == pytest.approx(595.28, abs=0.01)


@pytest.mark.parametrize(
    "asked",
    [
        ("power", SPECS / "shuttle.yaml", "-o", "a.html"),
        ("compare", SPECS / "in_plant_us.yaml", "-c", "standard-cover", "-c", "s100", "-o", "a.html"),
        ("verify-sheet", "standard-cover", "--load", "1:3:1 N/mm", "--roll", "159 mm", "-o", "a.html"),
        ("fit", EXAMPLES / "laboratory" / "isotherms.csv", "--at", "20 degC", "-o", "a.html"),
        ("dynamics", SPECS / "in_plant_us.yaml", "-s", "start empty", "--error", "0.2", "-o", "a.html"),
        ("size", EXAMPLES / "duties" / "in_plant.yaml", "-n", "1", "-o", "a.html"),
        ("calibrate", SPECS / "overland.yaml", "--measured", EXAMPLES / "measured" / "overland.csv", "-o", "a.html"),
    ],
)
def test_commands_write_the_page_they_write_as_html(asked, tmp_path):
    done = run(*asked, "-o", "a.pdf", "--force", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "PDF: a.pdf" in done.stdout
    words = Counter(map(bare, Printed((tmp_path / "a.html").read_text(encoding="utf-8")).words))
    found = text_of((tmp_path / "a.pdf").read_bytes())
    assert {word: n for word, n in words.items() if found.count(word) < n} == {}


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("none/a.pdf", "its folder does not exist"),
        ("foreign.pdf", "exists and is no report page that conveyor wrote"),
    ],
)
def test_a_pdf_is_refused_before_anything_is_calculated(name, message, tmp_path):
    (tmp_path / "foreign.pdf").write_bytes(b"%PDF-1.7\n")
    done = run("power", tmp_path / "not-even-there.yaml", "-o", name, cwd=tmp_path)
    assert done.returncode == 2
    assert message in done.stderr
