# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Numbers as programs write them beside the plain way, made plain.

A spreadsheet keeps texts by ="1.5" or an apostrophe, Fortran has exponents with D, accountants
write a sign behind a number or brackets around it, and Asian keyboards write wide digits.

"""

import re

import polars as pl

WIDE = '０１２３４５６７８９．，－＋'
NARROW = '0123456789.,-+'
_DIGITS = r"\d(?:[\d.,  '’]*[\d.,])?"
STEPS = (
    (r'^\s*=\s*"([^"]*)"\s*$', '${1}'),
    (r"^\s*'\s*([-+\u2212\u2013]?\s*[.,]?\d)", '${1}'),
    (r'^\s*([-+\u2212\u2013]?\s*[\d.,]*\d[.,]?)[dD]([-+]?\d+)\s*$', '${1}e${2}'),
    (rf'^\s*({_DIGITS})\s*[-\u2212\u2013]\s*$', '-${1}'),
    (rf'^\s*({_DIGITS})\s*\+\s*$', '${1}'),
    (rf'^\s*\(\s*({_DIGITS})\s*\)\s*$', '-${1}'),
)
"""What is replaced: the quotes of a formula, an apostrophe, a D, a sign behind, brackets."""
_PYTHON = [(re.compile(pattern), re.sub(r'\$\{(\d)\}', r'\\\1', by)) for pattern, by in STEPS]
_OTHER = rf"^\s*[='(]|\d[.,]?[dD][-+]?\d+\s*$|\d[.,]?\s*[-+\u2212\u2013]\s*$|[{WIDE[:10]}]"
"""What texts hold that are not plain; most hold none."""
_IS_OTHER = re.compile(_OTHER)
_TRANSLATED = str.maketrans(WIDE, NARROW)


def plain_numeral(text: str) -> str:
    """Return a text as a plain number if it is one in another way, else as it is."""
    plain = text.translate(_TRANSLATED)
    for pattern, by in _PYTHON if _IS_OTHER.search(plain) else ():
        plain = pattern.sub(by, plain)
    return plain


def plain_numerals(texts: pl.Series) -> pl.Series:
    """Return texts with the numbers among them in the plain way."""
    if not texts.str.contains(_OTHER).any():
        return texts
    texts = texts.str.replace_many(list(WIDE), list(NARROW))
    for pattern, by in STEPS:
        texts = texts.str.replace(pattern, by)
    return texts
