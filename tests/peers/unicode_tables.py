#!/usr/bin/env python3
"""Writes libcommon/nn/unicode_tables.c from Python's unicodedata.

    python3 tests/peers/unicode_tables.py > libcommon/nn/unicode_tables.c
    python3 tests/peers/unicode_tables.py --checksum     the crc32 that tests/unit/test_wordpiece.c expects

The tables hold what BERT's uncased normalisation needs of Unicode (nn/unicode.h says what each is). Hangul
syllables are left out of the mapping, since they decompose by arithmetic.
"""
import sys
import unicodedata
import zlib

POINTS = [c for c in range(0x110000) if not 0xD800 <= c <= 0xDFFF]


def ranges(wanted):
    out = []
    for c in POINTS:
        if wanted(c):
            if out and out[-1][1] == c - 1:
                out[-1][1] = c
            else:
                out.append([c, c])
    return out


def category(c):
    return unicodedata.category(chr(c))


def normalised(c):
    """NFD, nonspacing marks dropped, each character lowered by itself."""
    kept = (d for d in unicodedata.normalize("NFD", chr(c)) if unicodedata.category(d) != "Mn")
    return [ord(x) for d in kept for x in d.lower()]


def is_dropped(c):
    return category(c) in ("Cc", "Cf", "Co") and chr(c) not in "\t\n\r" or c == 0xFFFD


def mapping():
    """Runs (first, count, step, to, to_step) of single targets, and lists (from, targets) of several."""
    runs, lists = [], []
    for c in POINTS:
        if 0xAC00 <= c <= 0xD7A3 or category(c) == "Mn":
            continue
        to = normalised(c)
        if to == [c]:
            continue
        if len(to) != 1:
            lists.append((c, to))
            continue
        to = to[0]
        if runs:
            first, count, step, target, target_step = run = runs[-1]
            if count == 1 and c - first in (1, 2) and to - target in (0, 1, 2):
                run[1:] = [2, c - first, target, to - target]
                continue
            if count > 1 and count < 255 and c == first + count * step and to == target + count * target_step:
                run[1] += 1
                continue
        runs.append([c, 1, 1, to, 0])
    return runs, lists


def cell(v):
    if isinstance(v, list):
        return "{" + ", ".join(cell(x) for x in v) + "}"
    return str(v) if v < 256 else hex(v)


def table(kind, name, rows):
    print(f"\nconst struct {kind} {name}[] = {{")
    line = "\t"
    for row in rows:
        item = "{" + ", ".join(cell(v) for v in row) + "}, "
        if len(line) + len(item) > 103:
            print(line.rstrip())
            line = "\t"
        line += item
    print(line.rstrip() + "\n};")
    print(f"const size_t {name}_count = sizeof {name} / sizeof *{name};")


def main():
    runs, lists = mapping()
    longest = max(len(to) for _, to in lists)
    assert longest <= 3 and all(to for _, to in lists), "unicode.h's struct unicode_list holds 1 to 3 targets"
    print(f"/* Made by tests/peers/unicode_tables.py from Unicode {unicodedata.unidata_version}: do not edit. */")
    print("/* clang-format off */")
    print('#include "nn/unicode.h"')
    table("unicode_range", "unicode_dropped", ranges(is_dropped))
    table("unicode_range", "unicode_marks", ranges(lambda c: category(c) == "Mn"))
    table("unicode_range", "unicode_punctuation", ranges(lambda c: category(c).startswith("P")))
    table("unicode_run", "unicode_runs", runs)
    table("unicode_list", "unicode_lists", lists)


def checksum():
    """Over one line for every character: its classes and what it folds to, straight from unicodedata."""
    crc = 0
    for c in POINTS:
        kind = category(c)
        is_space = kind == "Zs" or 9 <= c <= 13 or c in (0x85, 0x2028, 0x2029)
        is_punctuation = kind[0] == "P" or chr(c) in "$+<=>^`|~"
        folded = " ".join(f"{x:x}" for x in normalised(c))
        crc = zlib.crc32(f"{c:x} {is_dropped(c):d}{is_space:d}{is_punctuation:d} {folded}\n".encode(), crc)
    print(f"{crc:08x}")


if sys.argv[1:] == ["--checksum"]:
    checksum()
else:
    main()
