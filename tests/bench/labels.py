#!/usr/bin/python3
"""Usage: tests/bench/labels.py BIN RUN TRUTH [VIEW]

What labels of refer-serve are worth. RUN is a folder that `make -f pipelines/lift.mk regions` made, TRUTH mask records. Each thing
that TRUTH has in VIEW (default: its first) is labelled there as a person would: a click at the place farthest from its edge; what is
lit is looked at in that view alone, made larger or smaller up to twice, and where it is still off by more than a quarter, another
click goes where most is missing or too much, up to two. Prints clicks and steps of each thing, and the IoU of what was lifted in the
other views of TRUTH, after the first click alone and after all. RUN stays as it is.
"""
import json
import os
import subprocess
import sys
import tempfile


def decode(record):
    """A mask as a list of columns, each an int with a bit a row."""
    (height, width), counts = record["size"], record["counts"]
    if isinstance(counts, str):
        runs, k = [], 0
        while k < len(counts):
            x, shift, more = 0, 0, True
            while more:
                c = ord(counts[k]) - 48
                x |= (c & 31) << shift
                more, shift, k = c & 32, shift + 5, k + 1
                if not more and c & 16:
                    x -= 1 << shift
            runs.append(x + (runs[-2] if len(runs) > 2 else 0))
        counts = runs
    on, bits = False, 0
    at = 0
    for n in counts:
        if on:
            bits |= ((1 << n) - 1) << at
        at, on = at + n, not on
    column = (1 << height) - 1
    return [bits >> (x * height) & column for x in range(width)], height


def shrink(mask, to_height, to_width):
    """The nearest pixels of a mask, for speed: all is judged at that size."""
    columns, height = mask
    width = len(columns)
    rows = [int((y + 0.5) * height / to_height) for y in range(to_height)]
    out = []
    for x in range(to_width):
        column = columns[int((x + 0.5) * width / to_width)]
        out.append(sum(1 << y for y, row in enumerate(rows) if column >> row & 1) if column else 0)
    return out


def area(columns):
    return sum(bin(c).count("1") for c in columns)


def iou(a, b):
    union = area([x | y for x, y in zip(a, b)])
    return area([x & y for x, y in zip(a, b)]) / union if union else 1.0


def middle(columns, height):
    """A pixel of the mask that is farthest from its edge: the last that erosion leaves."""
    left = columns
    while True:
        next_left = [c & (c << 1) & (c >> 1) & (left[x - 1] if x else 0) & (left[x + 1] if x + 1 < len(left) else 0) for x, c in enumerate(left)]
        if not any(next_left):
            break
        left = next_left
    x = max(range(len(left)), key=lambda k: bin(left[k]).count("1"))
    return x, (left[x] & -left[x]).bit_length() - 1


class Server:
    def __init__(self, binary, run):
        self.process = subprocess.Popen([os.path.join(binary, "refer-serve"), "-q", "--stdio", run], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, **request):
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())


def lit(server, view, place, height, width):
    reply = server.ask(do="label", **place)
    for mask in reply.get("masks", []):
        if mask["view"] == view:
            return shrink(decode({"size": [mask["height"], mask["width"]], "counts": mask["counts"]}), height, width)
    return [0] * width


def point(view, camera, x, y, height, width):
    return {"view": view, "x": (x + 0.5) * camera["width"] / width, "y": (y + 0.5) * camera["height"] / height}


def best_size(server, view, place, true, height):
    return max(range(-2, 3), key=lambda size: (iou(lit(server, view, dict(place, size=size), height, len(true)), true), -abs(size)))


def label(server, view, camera, true, height):
    """The first click, all of them, how many, and the steps up or down."""
    width = len(true)
    first = {"points": [point(view, camera, *middle(true, height), height, width)], "outside": []}
    place = dict(first, size=best_size(server, view, first, true, height))
    for _ in range(2):
        now = lit(server, view, place, height, width)
        if iou(now, true) >= 0.75:
            break
        missing, extra = [t & ~n for t, n in zip(true, now)], [n & ~t for t, n in zip(true, now)]
        is_missing = area(missing) >= area(extra)
        click = point(view, camera, *middle(missing if is_missing else extra, height), height, width)
        more = {"points": place["points"] + [click] * is_missing, "outside": place["outside"] + [click] * (not is_missing)}
        more["size"] = best_size(server, view, more, true, height)
        if iou(lit(server, view, more, height, width), true) <= iou(now, true):
            break
        place = more
    return first, place, len(place["points"]) + len(place["outside"]), abs(place["size"])


def main():
    if not 4 <= len(sys.argv) <= 5:
        sys.exit(__doc__.splitlines()[0])
    binary, run, truth = sys.argv[1:4]
    records = [json.loads(line) for line in open(truth)]
    view = sys.argv[4] if len(sys.argv) > 4 else records[0]["view"]
    cameras = {c["name"]: c for c in json.load(open(os.path.join(run, "scene", "cameras.json")))}
    work = tempfile.TemporaryDirectory()
    for part in ("scene", "weights", "regions.safetensors"):
        os.symlink(os.path.realpath(os.path.join(run, part)), os.path.join(work.name, part))
    server = Server(binary, work.name)
    scores, total = [], [0, 0]
    print("thing\tclicks\tsteps\tfirst click\tall")
    for record in records:
        if record["view"] != view:
            continue
        name, camera = record["object"], cameras[view]
        height = 240
        width = round(height * camera["width"] / camera["height"])
        first, place, clicks, steps = label(server, view, camera, shrink(decode(record["segmentation"]), height, width), height)
        row = []
        for way in (first, place):
            server.ask(do="label", name=name, **way)
            found = []
            for other in records:
                if other["object"] == name and other["view"] != view:
                    reply = server.ask(do="mask", view=other["view"], thing=name)
                    true = decode(other["segmentation"])
                    size = (true[1], len(true[0]))
                    got = decode({"size": [reply["height"], reply["width"]], "counts": reply["counts"]})
                    found.append(iou(shrink(got, *size) if (got[1], len(got[0])) != size else got[0], true[0]))
            row.append(100 * sum(found) / max(1, len(found)))
        scores.append(row)
        total = [total[0] + clicks, total[1] + steps]
        print(f"{name}\t{clicks}\t{steps}\t{row[0]:.1f}\t{row[1]:.1f}", flush=True)
    print(f"all\t{total[0]}\t{total[1]}\t{sum(s[0] for s in scores) / len(scores):.1f}\t{sum(s[1] for s in scores) / len(scores):.1f}")


main()
