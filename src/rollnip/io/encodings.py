"""The encodings of text files: UTF-8, UTF-16, and the code page of western Windows."""

from __future__ import annotations

import codecs

from rollnip._errors import InvalidInputError

_ZEROS = 0.2  # part of zero bytes that says UTF-16 without a mark
_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig", "UTF-8"),
    (codecs.BOM_UTF16_LE, "utf-16", "UTF-16"),
    (codecs.BOM_UTF16_BE, "utf-16", "UTF-16"),
)


def decoded(data: bytes, source: str) -> tuple[str, str]:
    """Return the text of a file's bytes, and the name of its encoding.

    Raises InvalidInputError with the ``source`` where they are no text.
    """
    for mark, codec, name in _MARKS:
        if data.startswith(mark):
            return _decode(data, codec, name, source), name
    if data.count(0) > _ZEROS * len(data):
        codec = "utf-16-le" if data[1:2] == b"\0" else "utf-16-be"
        return _decode(data, codec, "UTF-16", source), "UTF-16"
    if 0 in data:
        raise InvalidInputError(f"{source}: is not a text file (it holds zero bytes).")
    try:
        return data.decode("utf-8"), "UTF-8"
    except UnicodeDecodeError:
        return _decode(data, "cp1252", "Windows-1252", source), "Windows-1252"


def _decode(data: bytes, codec: str, name: str, source: str) -> str:
    try:
        return data.decode(codec)
    except UnicodeDecodeError as problem:
        raise InvalidInputError(
            f"{source}: must be text in UTF-8, UTF-16 or Windows-1252; as {name} the byte at "
            f"{problem.start} cannot be read. Save it as UTF-8."
        ) from None
