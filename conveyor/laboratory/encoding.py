"""Decode a text file; other files are refused with advice on what to export."""

from __future__ import annotations

import codecs
import re
from typing import Final

from conveyor.laboratory.cell_grid import cell_error
from conveyor.laboratory.header_meanings import known_names

_LONGEST_HEAD: Final = 20_000
"""Characters searched for column names, to choose the encoding."""
_NOT_TEXT: Final = {
    b"\xd0\xcf\x11\xe0": "an old .xls workbook, or one with a password; save it as .xlsx or CSV",
    b"%PDF": "a PDF report; export the table as CSV or .xlsx",
    b"\x1f\x8b": "compressed (gzip); unpack it first",
}
_MARKUP: Final = re.compile(r"\s*<(!doctype|html|table|\?xml)", re.IGNORECASE)
_BYTE_ORDER_MARKS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig", "UTF-8 with byte-order mark"),
    (codecs.BOM_UTF16_LE, "utf-16", "UTF-16 by its byte-order mark"),
    (codecs.BOM_UTF16_BE, "utf-16", "UTF-16 by its byte-order mark"),
)
_KOREAN: Final = re.compile("[가-힣ㄱ-ㅎㅏ-ㅣ　-〿℃℉°μ㎐㎑㎒㎩㎪㎫㎬·×±′″]+")
_SIGNS: Final = "°℃℉′″‘’“”·×±µμ²³⁻¹【】。、–—Δδωεγτηα*"
"""Signs between words of any language, full-width ones among them."""
_FOREIGN: Final = (
    ("cp932", "Japanese", "ぁ-んァ-ヶー一-鿿々"),
    ("gb18030", "Chinese", "一-鿿"),
    ("big5", "Chinese", "一-鿿"),
    ("cp1251", "Russian", "А-Яа-яЁё№"),
    ("cp1254", "Turkish", "ÇçĞğİıÖöŞşÜüâîû"),
    ("cp1250", "Polish", "ĄąĆćĘęŁłŃńÓóŚśŹźŻżÄäÖöÜüßÉéŐőŰűČčŘřŠšŽž"),
    ("euc_jp", "Japanese", "ぁ-んァ-ヶー一-鿿々"),
)
"""Encodings by language and letters, tried in this order on files with known words."""


def decode_text(data: bytes, name: str) -> tuple[str, str]:
    """Decode a text file, and name its encoding; an empty file, or one that is not text, is refused.

    Notes
    -----
    A byte-order mark decides; then UTF-8 if every byte fits; then EUC-KR or CP949 if what is not ASCII becomes
    Korean; then the encoding of another language in which the most words are names of columns that are read here, two
    at the least and more than in Korean or CP1252; else CP1252, and Latin-1 for bytes CP1252 does not know. Numbers are
    ASCII in all of them. (A detector by frequencies of letters has too few to go by: it takes a short CP1252 file
    with a degree sign for Big5.)

    Examples
    --------
    >>> decode_text("T (°C)".encode("cp1252"), "pad.csv")
    ('T (°C)', 'encoding: cp1252 (not UTF-8)')
    """
    if not data.strip():
        raise cell_error(name, 1, 0, "the file is empty; export the table again as CSV, TXT or .xlsx")
    for magic, what in _NOT_TEXT.items():
        if data.startswith(magic):
            raise cell_error(name, 1, 0, f"this is not text but {what}")
    text, note = _decode_bytes(data, name)
    if _MARKUP.match(text):
        raise cell_error(name, 1, 0, "this is HTML or XML, whatever its name; export it as CSV or .xlsx")
    return text, f"encoding: {note}"


def _decode_bytes(data: bytes, name: str) -> tuple[str, str]:
    for mark, codec, note in _BYTE_ORDER_MARKS:
        if data.startswith(mark):
            try:
                return data.decode(codec), note
            except UnicodeDecodeError as error:
                row = data[: error.start].count(b"\n") + 1
                what = f"damaged text: {note}, broken at byte {error.start}; save it as UTF-8"
                raise cell_error(name, row, 0, what) from None
    if b"\x00" in data:
        row = data[: data.index(b"\x00")].count(b"\n") + 1
        raise cell_error(name, row, 0, "binary data, or UTF-16 without its mark; save it as UTF-8 text")
    text = _try_codec(data, "utf-8")
    if text is not None:
        return text, "ASCII" if data.isascii() else "UTF-8"
    western = _try_codec(data, "cp1252")
    usual = None if western is None else (western, "cp1252 (not UTF-8)")
    for codec in ("cp949", "euc_kr"):
        text = _try_codec(data, codec)
        if text is not None and _is_korean(text, codec):
            usual = text, f"{codec} (not UTF-8; Korean)"
    foreign = _foreign_text(data, 0 if usual is None else known_names(_header_text(usual[0])))
    latin = (data.decode("latin-1"), "latin-1 (neither UTF-8 nor cp1252; words may show wrong letters)")
    return foreign or usual or latin


def _header_text(text: str) -> str:
    """Lines of the head of a text that are not ASCII."""
    return "\n".join(line for line in text[:_LONGEST_HEAD].splitlines() if not line.isascii())


def _foreign_text(data: bytes, known: int) -> tuple[str, str] | None:
    """Text in the encoding with the most known words, and its name; None if CP1252 has as many."""
    best: tuple[int, str, str] | None = None
    for codec, language, letters in _FOREIGN:
        text = _try_codec(data, codec)
        if text is None:
            continue
        runs = re.findall(r"[^\x00-\x7f]+", text)
        if not all(re.fullmatch(f"[{letters}！-～{re.escape(_SIGNS)}]+", run) for run in runs):
            continue
        count = known_names(_header_text(text))
        if count > max(known, 1 if best is None else best[0]):
            best = count, text, f"{codec} (not UTF-8; {language})"
    return None if best is None else best[1:]


def _try_codec(data: bytes, codec: str) -> str | None:
    try:
        return data.decode(codec)
    except UnicodeDecodeError:
        return None


def _is_korean(text: str, codec: str) -> bool:
    """True if all beyond ASCII is Korean, with two syllables in a row: a single one is "°C" of CP1252."""
    foreign = re.findall(r"[^\x00-\x7f]+", text)
    certain = codec == "euc_kr" and any(sign in text for sign in "℃℉")
    return all(map(_KOREAN.fullmatch, foreign)) and (certain or any(re.search("[가-힣]{2}", run) for run in foreign))
