#!/usr/bin/env python3
"""feature-lift in NumPy: the weighted mean of the views' features, by the definition of formats/scene/features.md.

    feature_lift.py compare WEIGHTS MAPS FEATURES    in float64; prints the largest difference from a file of feature-lift, exit 1 above what its numbers allow
    feature_lift.py time WEIGHTS MAPS [OUT]          in float32; prints seconds, MiB and the order of evaluation as JSON, and saves the means in OUT

WEIGHTS is a folder of gs-weigh, not packed; MAPS has VIEW.npy (H,W,C) for each of its views. Of three orders of evaluation the fastest on the first views is
timed. Needs numpy.
"""
import json
import pathlib
import resource
import sys
import time

import numpy as np

from encoder_files import read_safetensors


def views_of(weights, maps):
    names = sorted(p.stem for p in pathlib.Path(weights).glob("*.safetensors"))
    return [n for n in names if (pathlib.Path(maps) / f"{n}.npy").exists()]


def read_view(weights, maps, name, kind):
    """A view's weights as three lists (Gaussian, cell of the map, weight), its unit features (cells, C), and the number of Gaussians."""
    w, meta = read_safetensors(pathlib.Path(weights) / f"{name}.safetensors")
    features = np.load(pathlib.Path(maps) / f"{name}.npy")
    rows, columns, channels = features.shape
    height, width = int(meta["height"]), int(meta["width"])
    row = ((np.arange(height) + 0.5) * rows / height).astype(np.int64)
    column = ((np.arange(width) + 0.5) * columns / width).astype(np.int64)
    cells = (row[:, None] * columns + column[None, :]).reshape(-1)
    weight = w["weight"].astype(kind)
    if w["weight"].dtype == np.uint8:
        weight /= kind(255)
    unit = features.reshape(-1, channels).astype(kind)
    length = np.sqrt((unit.astype(np.float64) ** 2).sum(axis=1))
    unit *= np.where(length > 0, 1 / np.where(length > 0, length, 1), 0).astype(kind)[:, None]
    return w["index"], np.repeat(cells, np.diff(w["indptr"])), weight, unit, int(meta["gaussians"])


def by_channels(sums, index, cell, weight, unit):
    for c in range(unit.shape[1]):
        sums[:, c] += np.bincount(index, weight * unit[cell, c], len(sums))


def in_runs(sums, index, cell, weight, unit):
    """Sorted by Gaussian, and the runs of one summed, some thousands of weights at a time."""
    order = np.argsort(index, kind="stable")
    index, cell, weight = index[order], cell[order], weight[order]
    block = max(1, (1 << 24) // unit.shape[1])
    for a in range(0, len(index), block):
        part = slice(a, a + block)
        begins = np.flatnonzero(np.diff(index[part], prepend=-1))
        sums[index[part][begins]] += np.add.reduceat(weight[part, None] * unit[cell[part]], begins, axis=0)


def pairs_in_runs(sums, index, cell, weight, unit):
    """The weights of a Gaussian in one cell of the map are added first."""
    key = index.astype(np.int64) * len(unit) + cell
    order = np.argsort(key, kind="stable")
    begins = np.flatnonzero(np.diff(key[order], prepend=-1))
    first = order[begins]
    in_runs(sums, index[first], cell[first], np.add.reduceat(weight[order], begins), unit)


ORDERS = {"by channels": by_channels, "in runs": in_runs, "pairs in runs": pairs_in_runs}


def lift(weights, maps, kind, order, names):
    sums = total = None
    for name in names:
        index, cell, weight, unit, gaussians = read_view(weights, maps, name, kind)
        if sums is None:
            sums, total = np.zeros((gaussians, unit.shape[1]), kind), np.zeros(gaussians)
        order(sums, index, cell, weight, unit)
        total += np.bincount(index, weight, gaussians)
    sums /= np.where(total > 0, total, 1).astype(kind)[:, None]
    return sums, total, np.sqrt((sums.astype(np.float64) ** 2).sum(axis=1))


def compare(weights, maps, path):
    got, _ = read_safetensors(path)
    mean, total, reliability = lift(weights, maps, np.float64, pairs_in_runs, views_of(weights, maps))
    allowed = 2.5e-4 if got["features"].dtype == np.float16 else 1e-5
    worst = max(np.abs(got["features"] - mean).max(), np.abs(got["reliability"] - reliability).max(),
                (np.abs(got["weight"] - total) / np.maximum(total, 1)).max())
    print(f"{(total > 0).sum()} of {len(total)} Gaussians are seen; the largest difference is {worst:.3g}, {allowed:g} are allowed")
    return int(worst > allowed or not (total > 0).any())


def measure(weights, maps, out):
    names = views_of(weights, maps)
    taken = {}
    for name, order in ORDERS.items():
        begin = time.perf_counter()
        lift(weights, maps, np.float32, order, names[:2])
        taken[name] = time.perf_counter() - begin
    best = min(taken, key=taken.get)
    begin = time.perf_counter()
    mean = lift(weights, maps, np.float32, ORDERS[best], names)[0]
    if out:
        with open(out, "wb") as f:
            np.save(f, mean.astype(np.float16))
    seconds = time.perf_counter() - begin
    print(json.dumps({"seconds": round(seconds, 2), "mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024, "order": best, "views": len(names)}))
    return 0


if __name__ == "__main__":
    if len(sys.argv) == 5 and sys.argv[1] == "compare":
        sys.exit(compare(*sys.argv[2:]))
    if len(sys.argv) in (4, 5) and sys.argv[1] == "time":
        sys.exit(measure(sys.argv[2], sys.argv[3], sys.argv[4] if len(sys.argv) == 5 else ""))
    sys.exit(__doc__)
