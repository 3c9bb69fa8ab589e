"""Exceptions: why a font cannot be opened or a glyph cannot be drawn."""

from __future__ import annotations

from typing import Any


class Error(Exception):
    """Why a font cannot be opened or a glyph cannot be drawn. The text is a sentence for people.

    `code` names the cause, as "missing_model"; `values` has what the sentence tells, as {"glyph": 36}.
    """

    def __init__(self, message: str, code: str = "other", values: dict[str, Any] | None = None) -> None:
        super().__init__(message)
        self.code, self.values = code, dict(values or {})

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.code, self.values)


class FontError(Error):
    """The file cannot be used: it is no font, has no models, is damaged, or was changed after its models were made."""


class GlyphError(Error):
    """A glyph cannot be drawn: the font has no such glyph or character, or its model is damaged or stale."""


class MissingModelError(GlyphError):
    """The font has the glyph, but no model of it: draw it by other means, or open the font with `missing_model`."""


class LimitError(Error):
    """The glyph asks for more than the font's `Limits` allow."""


class ArgumentError(Error, ValueError):
    """A size or an offset is out of range."""


_CODES: dict[type[Error], str] = {
    FontError: "not_a_font no_such_font missing_table malformed_table units_per_em not_converted unknown_version"
    " malformed_models renumbered",
    GlyphError: "malformed_model model_too_large stale_model no_such_glyph no_such_character malformed_outline"
    " fields_not_built networks_not_built network_size network_offset network_subpixels",
    MissingModelError: "missing_model",
    LimitError: "bitmap_too_large decoded_too_large too_much_work line_too_large",
    ArgumentError: "invalid_size invalid_offset",
}
_CLASSES = {code: kind for kind, codes in _CODES.items() for code in codes.split()}


def error_of(message: str, code: str, values: dict[str, Any]) -> Error:
    """The exception for a cause. The compiled module calls it."""
    return _CLASSES.get(code, Error)(message, code, values)
