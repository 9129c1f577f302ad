"""Pages as trees: texts are escaped once, when the page is written; what is joined is flat."""

from __future__ import annotations

import pytest

from conveyor.text.markup import Html, Markup, element, join_html, name_value_table


def test_texts_and_attributes_are_escaped_once_when_they_are_written():
    made = element("p", element("b", "<'&amp;\">"), "a & b", title="a\"b'")
    assert made.text == "<'&amp;\">a & b"
    assert str(made) == ('<p title="a&quot;b&#x27;"><b>&lt;&#x27;&amp;amp;&quot;&gt;</b>a &amp; b</p>')
    assert str(element("div", made)) == f"<div>{made}</div>"


def test_markup_stays_as_it_is():
    made = element("figure", Markup("<svg a='&amp;'/>"), "<")
    assert str(made) == "<figure><svg a='&amp;'/>&lt;</figure>"
    assert made.text == "<"


def test_control_characters_become_their_codes():
    made = element("p", "bell\x07 \ud800", title="\x1b[31m")
    assert made.content == ("bell\\x07 \\ud800",)
    assert made.attributes == {"title": "\\x1b[31m"}


def test_attributes_without_a_value_are_left_out():
    assert str(element("th", class_="n", data_label=None, colspan=2)) == '<th class="n" colspan="2"></th>'


def test_an_element_that_holds_nothing_is_not_closed():
    assert str(element("p", "a", element("br"), "b")) == "<p>a<br>b</p>"
    assert str(element("td")) == "<td></td>"


def test_pieces_in_pieces_are_flat_and_texts_beside_each_other_are_one():
    inner = join_html(["b", join_html(["", "c"]), element("br"), Markup("<svg/>")])
    made = element("p", "a", inner, "", "d")
    assert made.content == ("abc", element("br"), "<svg/>", "d")
    assert [one.tag for one in made.elements] == ["br"]


def test_nothing_is_false_and_an_empty_element_is_not():
    assert not join_html(["", Html()])
    assert element("p")
    assert str(Html()) == ""


@pytest.mark.parametrize("content", [None, 1.5, b"x", ["x"]])
def test_what_is_neither_an_element_nor_text_is_refused(content):
    with pytest.raises(TypeError, match=f"an element or text, got {type(content).__name__}"):
        element("p", content)


def test_elements_are_found_in_the_order_of_the_page():
    page = element("html", element("body", element("div", element("p", "a", class_="n v")), element("p", "b")))
    assert [one.tag for one in page.every()] == ["body", "div", "p", "p"]
    assert page.first("p").text == "a"
    assert page.first("p").classes == {"n", "v"}
    assert str(page).startswith("<!DOCTYPE html>\n<html><body>")


def test_long_lists_and_texts_of_a_notebook_are_cut():
    table = str(name_value_table("t", [("list", list(range(20))), ("text", "x" * 400), ("flag", True)]))
    assert "<td" in table
    assert ">0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, ... 20 in all</td>" in table
    assert f"{'x' * 300}... (400 characters)" in table
    assert ">True</td>" in table


def test_names_of_a_notebook_may_be_numbers():
    shown = name_value_table("t", [("bars", {1: [{2: "a"}]})])
    assert [one.text for one in shown.every() if one.tag == "th"] == ["bars", "1", "2"]
