"""The stream of a workbook inside a compound file, [MS-CFB] 2: sectors in chains of numbers."""

from __future__ import annotations

from struct import unpack_from

_MARK = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_LAST = 0xFFFFFFFA  # larger numbers are no sectors
_NAMES = ("Workbook", "Book")
_ENTRY, _SHORT = 128, 64  # bytes of a directory entry and of a sector of a short stream


def workbook_stream(data: bytes) -> bytes:
    """Return the records of an .xls; a file of records alone is returned as it is.

    Raises
    ------
    ValueError, IndexError, struct.error
        where the file is damaged or holds no workbook.
    """
    if not data.startswith(_MARK):
        return data
    shift = unpack_from("<H", data, 30)[0]
    if shift not in (9, 12):
        raise ValueError("sectors of an unknown size")
    size = 1 << shift
    directory_at, cutoff, short_at = (unpack_from("<I", data, at)[0] for at in (48, 56, 60))
    table = _numbers(b"".join(_sector(data, one, size) for one in _table_sectors(data, size)))
    directory = _chain(data, directory_at, size, table)
    entries = [directory[at : at + _ENTRY] for at in range(0, len(directory) - _ENTRY + 1, _ENTRY)]
    for entry in entries:
        length = unpack_from("<H", entry, 64)[0]
        name = entry[: max(length - 2, 0)].decode("utf-16-le", "replace")
        if name in _NAMES:
            first, count = unpack_from("<II", entry, 116)
            if count >= cutoff:
                return _chain(data, first, size, table)[:count]
            shorts = _chain(data, unpack_from("<I", entries[0], 116)[0], size, table)
            short_table = _numbers(_chain(data, short_at, size, table))
            return _chain(shorts, first, _SHORT, short_table, header=0)[:count]
    raise ValueError("it holds no workbook")


def _table_sectors(data: bytes, size: int) -> list[int]:
    """Numbers of the sectors that hold the table of chains."""
    found = list(unpack_from("<109I", data, 76))
    following, most = unpack_from("<II", data, 68)
    for _ in range(min(most, len(data) // size)):
        if following >= _LAST:
            break
        *numbers, following = _numbers(_sector(data, following, size))
        found += numbers
    return [one for one in found if one < _LAST]


def _chain(data: bytes, first: int, size: int, table: list[int], *, header: int = 1) -> bytes:
    parts: list[bytes] = []
    sector = first
    while sector < _LAST:
        if len(parts) > len(table):
            raise ValueError("a chain of sectors has no end")
        parts.append(_sector(data, sector, size, header=header))
        sector = table[sector]
    return b"".join(parts)


def _sector(data: bytes, number: int, size: int, *, header: int = 1) -> bytes:
    at = (number + header) * size
    if at >= len(data):
        raise ValueError("a sector lies behind the end")
    return data[at : at + size]


def _numbers(data: bytes) -> list[int]:
    return list(unpack_from(f"<{len(data) // 4}I", data))
