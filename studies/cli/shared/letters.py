"""What a terminal or a pipe without UTF-8 gets in place of the letters that it has not."""

from __future__ import annotations

import codecs
import sys
import unicodedata
from contextlib import suppress

_SIGNS = {
    "−": "-", "–": "-", "·": "*", "×": "x", "±": "+-", "°": " deg", "√": "sqrt", "≤": "<=", "≥": ">=", "→": "->",
    "↑": "^", "∞": "inf", "’": "'",
}  # fmt: skip


def spell_out() -> None:
    """From now on, print on stdout and stderr what their encoding has not in letters that it has: φ as phi."""
    codecs.register_error("hoop", _spelled)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            with suppress(OSError):  # it is closed
                stream.reconfigure(errors="hoop")


def as_printed(text: str) -> str:
    """A text as stdout will have it, so that its letters can be counted."""
    if getattr(sys.stdout, "errors", "") != "hoop":
        return text
    return text.encode(sys.stdout.encoding, "hoop").decode(sys.stdout.encoding)


def _spelled(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    written, raised = "", False
    for letter in error.object[error.start : error.end]:
        power = unicodedata.decomposition(letter).startswith("<super>")
        written += f"^{_plain(letter)}" if power and not raised else _plain(letter)
        raised = power
    return written, error.end


def _plain(letter: str) -> str:
    name = unicodedata.name(letter, "").split()
    if name[:1] == ["GREEK"]:
        return name[-1].lower() if "SMALL" in name else name[-1].title()
    signs = [_SIGNS.get(sign, sign) for sign in unicodedata.normalize("NFKD", letter)]
    return "".join(signs).encode("ascii", "ignore").decode() or "?"
