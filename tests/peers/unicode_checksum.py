#!/usr/bin/env python3
"""Prints the crc32 that tests/unit/test_wordpiece.c expects of nn/unicode.h, from Python's unicodedata.

    python3 tests/peers/unicode_checksum.py

It is over one line for every character of BLOCKS: its classes and what it folds to. In these blocks no version of
Unicode since 14.0 has changed anything of that, so that Python's and utf8proc's versions need not be the same.
"""
import unicodedata
import zlib

BLOCKS = [(0, 0x52F), (0x600, 0x6FF), (0x900, 0x97F), (0x1E00, 0x23FF), (0x3000, 0x30FF), (0x4E00, 0x9FFF),
          (0xAC00, 0xD7A3), (0xE000, 0xFAFF), (0xFE30, 0xFFFF), (0x1D100, 0x1D1FF), (0x1D400, 0x1D7FF),
          (0x2F800, 0x2FA1F), (0x10FF00, 0x10FFFF)]


def category(c):
    return unicodedata.category(chr(c))


def normalised(c):
    """NFD, nonspacing marks dropped, each character lowered by itself."""
    kept = (d for d in unicodedata.normalize("NFD", chr(c)) if unicodedata.category(d) != "Mn")
    return [ord(x) for d in kept for x in d.lower()]


def is_dropped(c):
    return category(c) in ("Cc", "Cf", "Co") and chr(c) not in "\t\n\r" or c == 0xFFFD


crc = 0
for first, last in BLOCKS:
    for c in range(first, last + 1):
        kind = category(c)
        is_space = kind == "Zs" or 9 <= c <= 13 or c in (0x85, 0x2028, 0x2029)
        is_punctuation = kind[0] == "P" or chr(c) in "$+<=>^`|~"
        folded = " ".join(f"{x:x}" for x in normalised(c))
        crc = zlib.crc32(f"{c:x} {is_dropped(c):d}{is_space:d}{is_punctuation:d} {folded}\n".encode(), crc)
print(f"{crc:08x}")
