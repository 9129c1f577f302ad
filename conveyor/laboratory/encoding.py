"""Bytes of a text file to characters; what is not text is refused with what to export instead."""

from __future__ import annotations

import codecs
import re

from conveyor.laboratory.cells import refusal

_NOT_TEXT = {
    b"\xd0\xcf\x11\xe0": "an old .xls workbook, or one with a password; save it as .xlsx or CSV",
    b"%PDF": "a PDF report; export the table as CSV or .xlsx",
    b"\x1f\x8b": "compressed (gzip); unpack it first",
}
_MARKUP = re.compile(r"\s*<(!doctype|html|table|\?xml)", re.IGNORECASE)
_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig", "UTF-8 with byte-order mark"),
    (codecs.BOM_UTF16_LE, "utf-16", "UTF-16 by its byte-order mark"),
    (codecs.BOM_UTF16_BE, "utf-16", "UTF-16 by its byte-order mark"),
)
_KOREAN = re.compile("[가-힣ㄱ-ㅎㅏ-ㅣ　-〿℃℉°μ㎐㎑㎒㎩㎪㎫㎬·×±′″]+")


def decoded(data: bytes, name: str) -> tuple[str, str]:
    """Characters of a text file and a sentence on its encoding.

    Parameters
    ----------
    data : bytes
        The file [-].
    name : str
        Its name in messages [-].

    Returns
    -------
    tuple of str
        The text, and how it was decoded [-].

    Raises
    ------
    InputError
        If the file is empty or holds something else than text.

    Notes
    -----
    A byte-order mark decides; then UTF-8 if every byte fits; then EUC-KR or CP949 if what is not ASCII becomes
    Korean; else CP1252, and Latin-1 for bytes CP1252 does not know. Numbers are ASCII in all of them.

    Examples
    --------
    >>> decoded("T (°C)".encode("cp1252"), "pad.csv")
    ('T (°C)', 'encoding: cp1252 (not UTF-8)')
    """
    if not data.strip():
        raise refusal(name, 1, 0, "the file is empty; export the table again as CSV, TXT or .xlsx")
    for magic, what in _NOT_TEXT.items():
        if data.startswith(magic):
            raise refusal(name, 1, 0, f"this is not text but {what}")
    text, note = _text(data, name)
    if _MARKUP.match(text):
        raise refusal(name, 1, 0, "this is HTML or XML, whatever its name; export it as CSV or .xlsx")
    return text, f"encoding: {note}"


def _text(data: bytes, name: str) -> tuple[str, str]:
    for mark, codec, note in _BYTE_ORDER_MARKS:
        if data.startswith(mark):
            try:
                return data.decode(codec), note
            except UnicodeDecodeError as error:
                row = data[: error.start].count(b"\n") + 1
                raise refusal(
                    name, row, 0, f"damaged text: {note}, broken at byte {error.start}; save it as UTF-8"
                ) from None
    if b"\x00" in data:
        row = data[: data.index(b"\x00")].count(b"\n") + 1
        raise refusal(name, row, 0, "binary data, or UTF-16 without its mark; save it as UTF-8 text")
    try:
        return data.decode("utf-8"), "ASCII" if data.isascii() else "UTF-8"
    except UnicodeDecodeError:
        pass
    for codec in ("euc_kr", "cp949"):
        text = _korean(data, codec)
        if text is not None:
            return text, f"{codec} (not UTF-8; Korean)"
    try:
        return data.decode("cp1252"), "cp1252 (not UTF-8)"
    except UnicodeDecodeError:
        return data.decode("latin-1"), "latin-1 (neither UTF-8 nor cp1252; words may show wrong letters)"


def _korean(data: bytes, codec: str) -> str | None:
    """The text if `codec` turns everything beyond ASCII into Korean, with at least two syllables in a row.

    CP1252 "°C" is one lone syllable in CP949: a single one proves nothing.
    """
    try:
        text = data.decode(codec)
    except UnicodeDecodeError:
        return None
    foreign = re.findall(r"[^\x00-\x7f]+", text)
    if not all(_KOREAN.fullmatch(run) for run in foreign):
        return None
    certain = codec == "euc_kr" and any(sign in text for sign in "℃℉")
    return text if certain or any(re.search("[가-힣]{2}", run) for run in foreign) else None
