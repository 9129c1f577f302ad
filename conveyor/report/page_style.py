"""How a page looks: on a screen, on a phone, on paper; no colour is the only sign of anything."""

from __future__ import annotations

from typing import Final

from conveyor.models.report import Paper

COLOURS: Final = {
    "paper": "#FFFFFF",
    "ink": "#1B1F24",
    "muted": "#4A5560",
    "accent": "#1F4E79",
    "pale": "#EEF3F8",
    "line": "#C9D3DD",
    "good": "#14602B",
    "good-pale": "#E4F3E8",
    "bad": "#9B1C1C",
    "bad-pale": "#FDEBEB",
    "open": "#5C4400",
    "open-pale": "#FFF4D6",
}
"""Of the page, by what they stand for; contrast of every text is 4.5 or more (WCAG 2.2, 1.4.3)."""

DARK: Final = {
    "paper": "#14181D",
    "ink": "#E6EAF0",
    "muted": "#A9B4C0",
    "accent": "#8FC1F0",
    "pale": "#1E2630",
    "line": "#3A4654",
    "good": "#7FD79A",
    "good-pale": "#15301F",
    "bad": "#FF9B94",
    "bad-pale": "#3D1A1A",
    "open": "#F2CE73",
    "open-pale": "#38300F",
}
"""The same where the reader's screen is dark."""

_STYLE: Final = """
* { box-sizing: border-box; }
html { font: 16px/1.45 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif;
  color-scheme: light dark; -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; padding: 1.5rem 1.25rem 3rem; max-width: 62rem; color: var(--ink); background: var(--paper); }
h1 { font-size: 1.9rem; line-height: 1.2; margin: .15rem 0 .4rem; color: var(--accent); overflow-wrap: anywhere; }
h2 { font-size: 1.3rem; margin: 2.4rem 0 .7rem; padding-top: .5rem; border-top: 2px solid var(--accent);
  color: var(--accent); }
h3 { font-size: 1.05rem; margin: 1.6rem 0 .4rem; }
p, li, dd, td, th { overflow-wrap: anywhere; }
p { margin: .5rem 0; }
a { color: var(--accent); }
:focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
.kind, .note, figcaption, caption { color: var(--muted); }
.kind { margin: 0; font-size: .9rem; letter-spacing: .04em; text-transform: uppercase; }
.note { font-size: .9rem; }
nav { margin: 1.2rem 0; padding: .7rem 1rem; background: var(--pale); }
nav details { margin: 0; }
.checks td[data-label="margin"] { white-space: nowrap; }
nav ol { margin: .6rem 0 0; padding-left: 1.4rem; columns: 15rem; }
nav li { padding: .1rem 0; }
.facts, .tiles { display: grid; gap: .6rem; margin: 1rem 0; }
.facts { grid-template-columns: repeat(auto-fill, minmax(10.5rem, 1fr)); }
.tiles { grid-template-columns: repeat(3, 1fr); }
.facts dt, .tiles dt { font-size: .85rem; color: var(--muted); }
.facts dd, .tiles dd { margin: 0; }
.facts dd { font-weight: 600; }
.tiles > div { padding: .6rem .8rem; background: var(--pale); border-left: 4px solid var(--accent); }
.tiles dd { font-size: 1.45rem; font-weight: 600; line-height: 1.25; color: var(--accent); overflow-wrap: normal; }
.tiles dd small { font-size: .95rem; font-weight: 400; white-space: nowrap; }
.scroll { overflow-x: auto; margin: .8rem 0; }
table { border-collapse: collapse; width: 100%; font-size: .88rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding: 0 0 .35rem; }
th, td { padding: .28rem .55rem; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line);
  overflow-wrap: normal; }
thead th { vertical-align: bottom; font-weight: 600; color: var(--paper); background: var(--accent); }
tbody th { font-weight: 400; }
tfoot th, tfoot td { font-weight: 600; border-top: 2px solid var(--accent); }
.n { text-align: right; white-space: nowrap; }
thead .n { white-space: normal; }
.v { text-align: right; }
tbody .name { white-space: nowrap; }
.wide table { font-size: .8rem; }
.wide th, .wide td { padding: .28rem .4rem; }
.asked { background: var(--open-pale); border: 1px solid var(--line); min-width: 3.5rem; }
.beside { display: flex; flex-wrap: wrap; gap: 0 1.5rem; align-items: flex-start; }
.beside > * { flex: 1 1 20rem; min-width: 0; }
.further { visibility: hidden; }
.stands { padding: .6rem .8rem; border-radius: .2rem; font-weight: 600; font-size: 1.05rem; }
details { margin: .8rem 0; }
summary { color: var(--accent); cursor: pointer; }
.unit { white-space: nowrap; font-weight: 400; }
.long { overflow-wrap: anywhere; min-width: 11rem; }
.verdict { display: inline-block; padding: 0 .5rem; border-radius: .2rem; font-weight: 600; white-space: nowrap; }
.pass { color: var(--good); background: var(--good-pale); }
.fail { color: var(--bad); background: var(--bad-pale); }
.open { color: var(--open); background: var(--open-pale); }
.warnings li { margin: .35rem 0; }
figure { margin: 1rem 0; }
.drawing svg { max-width: 48rem; }
.moving button { font: inherit; padding: .2rem .9rem; margin: 0 0 .3rem; cursor: pointer; }
@media print { .moving button { display: none; } }
@media (prefers-reduced-motion: reduce) { .moving button { display: none; } }
figcaption { font-size: .9rem; }
svg { display: block; width: 100%; height: auto; font-family: system-ui, Arial, sans-serif; }
svg * { stroke-linejoin: round; stroke-linecap: butt; }
footer { margin-top: 2.5rem; padding-top: .6rem; border-top: 1px solid var(--line); color: var(--muted);
  font-size: .85rem; overflow-wrap: anywhere; }
@media screen and (prefers-color-scheme: dark) { .drawing svg { filter: invert(.92) hue-rotate(180deg); } }
@media screen and (max-width: 40rem) {
  body { padding: 1rem .8rem 2rem; }
  h1 { font-size: 1.5rem; }
  .tiles { grid-template-columns: 1fr 1fr; }
  .tiles dd { font-size: 1.2rem; }
  table { font-size: .82rem; }
  th, td { padding: .25rem .4rem; overflow-wrap: anywhere; }
  .unit, tbody .name { white-space: normal; }
  .rows thead { display: none; }
  .rows tr { display: block; padding: .35rem 0; border-bottom: 2px solid var(--line); }
  .rows th, .rows td { display: flex; justify-content: space-between; gap: 1rem; border: 0; text-align: right;
    padding: .1rem .4rem; white-space: normal; min-width: 0; }
  .rows tbody th:first-child { font-weight: 600; text-align: left; }
  .rows td::before, .rows th[data-label]::before { content: attr(data-label); color: var(--muted); text-align: left;
    font-weight: 400; overflow-wrap: normal; }
}
@page { margin: 10mm 11mm 12mm; @bottom-right { content: counter(page) " / " counter(pages);
  font: 8pt sans-serif; } }
@media print {
  html { font-size: 8pt; line-height: 1.22; }
  h1 { font-size: 16pt; }
  h2 { font-size: 11pt; margin: .9rem 0 .3rem; padding-top: .2rem; }
  h3 { margin: .6rem 0 .2rem; }
  p, .scroll, figure { margin: .3rem 0; }
  .facts, .tiles { gap: .25rem; margin: .4rem 0; }
  .facts { grid-template-columns: repeat(5, 1fr); }
  .tiles { grid-template-columns: repeat(6, 1fr); }
  .tiles > div { padding: .2rem .4rem; }
  .tiles dd { font-size: 11pt; }
  .beside { flex-wrap: nowrap; }
  details, .unprinted { display: none; }
  li, .warnings li { margin: 0; }
  ul { margin: .3rem 0; }
  body { max-width: none; padding: 0; }
  nav { display: none; }
  a { text-decoration: none; }
  h2, h3, caption { break-after: avoid; }
  tbody tr:nth-child(-n+2) { break-after: avoid; }
  tbody tr:nth-last-child(-n+3), tfoot tr { break-before: avoid; }
  figure, tr, .tiles, .facts, .keep { break-inside: avoid; }
  thead { display: table-header-group; }
  tfoot { display: table-row-group; }
  .scroll { overflow: visible; }
  table { font-size: 6.9pt; line-height: 1.12; }
  th, td { padding: .07rem .35rem; }
  figure { display: inline-block; width: 49%; vertical-align: top; }
  .drawing svg { max-width: 80mm; max-height: 40mm; }
  .wide table { font-size: 6.5pt; }
  .wide th, .wide td { padding: .07rem .2rem; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
"""


def style(paper: Paper) -> str:
    """Return the style sheet of a page that is printed on a paper."""
    light, dark = (
        ":root { " + " ".join(f"--{name}: {value};" for name, value in colours.items()) + " }"
        for colours in (COLOURS, DARK)
    )
    return (
        f"{light}\n@media screen and (prefers-color-scheme: dark) {{ {dark} }}"
        + _STYLE
        + f"@page {{ size: {paper}; }}\n"
    )
