"""COCO's compressed run lengths, pixel by pixel from the format's description: the peer of libcommon/mask/rle.c.

Run it to make tests/unit/coco_golden.h again:  python3 tests/peers/coco_rle.py > tests/unit/coco_golden.h
The masks are formulas, which the C test evaluates too.
"""


def pixel(height, width, a, b, c, d, y, x):
    """d > 0: a pattern; d = 0: a disc of radius a/100 of the smaller side, centred."""
    if d:
        return (a * y * y + b * x + c * x * y) % d < d // 2
    side = 2 * min(height, width) * a // 100
    return (2 * y + 1 - height) ** 2 + (2 * x + 1 - width) ** 2 < side * side


def runs(height, width, *formula):
    lengths, current = [0], False
    for x in range(width):
        for y in range(height):
            if pixel(height, width, *formula, y, x) != current:
                current = not current
                lengths.append(0)
            lengths[-1] += 1
    return lengths


def number(x):
    """Groups of 5 bits from the low end; 32 marks that more follow; the last group's top bit (16) is the sign."""
    text = ""
    while True:
        group, x = x & 31, x >> 5
        done = x == (-1 if group & 16 else 0)
        text += chr(48 + group + (0 if done else 32))
        if done:
            return text


def compress(lengths):
    """From the fourth run on, the difference to the run two before."""
    return "".join(number(n - lengths[i - 2] if i > 2 else n) for i, n in enumerate(lengths))


def main():
    cases = [
        (1, 1, 0, 0, 0, 2), (1, 1, 0, 1, 0, 1), (1, 1, 1, 0, 0, 1), (3, 2, 1, 1, 0, 2), (2, 3, 1, 1, 0, 2),
        (7, 5, 1, 2, 3, 4), (17, 33, 3, 5, 7, 11), (64, 64, 1, 1, 1, 100), (40, 9, 2, 9, 1, 60), (100, 1, 1, 0, 0, 90),
        (1, 100, 0, 7, 0, 90), (48, 64, 30, 0, 0, 0), (64, 48, 80, 0, 0, 0), (535, 953, 45, 0, 0, 0),
    ]
    print("/* Made by tests/peers/coco_rle.py: masks by formula and their strings. */")
    print("static const struct {\n\tint height, width, formula[4];\n\tconst char *text;\n} coco_golden[] = {")
    for case in cases:
        text = compress(runs(*case)).replace("\\", "\\\\").replace("??", "?\\?")
        lines = "\n\t\t".join('"%s"' % part for part in pieces(text))
        print("\t{%d, %d, {%d, %d, %d, %d},\n\t\t%s}," % (*case, lines))
    print("};")


def pieces(text):
    """Lines of about 90 characters, not split inside an escape."""
    begin = 0
    while begin < len(text):
        end = min(begin + 90, len(text))
        while end < len(text) and text[end - 1] == "\\":
            end += 1
        yield text[begin:end]
        begin = end


if __name__ == "__main__":
    main()
