#!/usr/bin/env python3
"""feature-query --pixels in NumPy and float64, by formats/scene/selection.md: the masks and peaks of one view.

    query_pixels.py WEIGHTS_OF_VIEW FEATURES TEXT SPLIT CANONICAL|- LEAST SMOOTH MASKS

Prints for how many pixels of how many masks it differs; exit 1 where more than one in a thousand do, or a peak has another mean. The threshold is LangSplat's. Needs numpy.
"""
import json
import sys

import numpy as np

from encoder_files import read_safetensors


def unit(x):
    length = np.linalg.norm(x, axis=-1, keepdims=True)
    return np.where(length > 0, x / np.where(length > 0, length, 1), 0)


def decode(segmentation):
    """COCO's run lengths."""
    height, width = segmentation["size"]
    runs, text, at = [], segmentation["counts"].encode(), 0
    while at < len(text):
        x = k = 0
        more = True
        while more:
            c = text[at] - 48
            x |= (c & 31) << 5 * k
            more, at, k = c & 32, at + 1, k + 1
            if not more and c & 16:
                x |= -1 << 5 * k
        runs.append(x + runs[-2] if len(runs) > 2 else x)
    return np.repeat(np.arange(len(runs)) % 2, runs).reshape(width, height).T.astype(bool)


def means(image, window):
    """Of a window around each pixel, mirrored at the border."""
    before, after = window // 2, window - 1 - window // 2
    padded = np.pad(image, ((before, after), (before, after)), mode="reflect")
    return sum(padded[v:v + image.shape[0], u:u + image.shape[1]] for v in range(window) for u in range(window)) / window ** 2


def main(weights, features, text, split, canonical, least, smooth, masks):
    w, meta = read_safetensors(weights)
    size = int(meta["height"]), int(meta["width"])
    x = read_safetensors(features)[0]["features"].astype(np.float64)
    t, about = read_safetensors(text)
    chosen = [i for i, s in enumerate(json.loads(about["splits"])) if split in ("all", s)]
    refs, objects = json.loads(about["refs"]), json.loads(about["objects"])
    vectors = unit(t["sentences"][chosen].astype(np.float64))
    image = np.zeros((size[0] * size[1], x.shape[1]))
    np.add.at(image, np.repeat(np.arange(len(image)), np.diff(w["indptr"])), w["weight"].astype(np.float64)[:, None] * x[w["index"]])
    length = np.linalg.norm(image, axis=1)
    seen = (length >= float(least)) & (length > 0)
    cosines = unit(image) @ vectors.T
    if canonical != "-":
        against = unit(image) @ unit(read_safetensors(canonical)[0]["sentences"].astype(np.float64)).T
    said = {m["ref"]: m for m in map(json.loads, open(masks)) if m["view"] == weights.split("/")[-1].split(".")[0]}
    wrong = 0
    for k, i in enumerate(chosen):
        if canonical == "-":
            rivals = [j for j, o in enumerate(chosen) if objects[o] != objects[i]]
            values, mask = np.where(seen, cosines[:, k], 0), seen & (cosines[:, k] > cosines[:, rivals].max(axis=1))
        else:
            values = np.where(seen, np.min(1 / (1 + np.exp(10 * (against - cosines[:, k:k + 1]))), axis=1), 0)
        mean = means(values.reshape(size), int(smooth))
        if canonical != "-":
            half = (mean.reshape(-1) + values) / 2
            low, high = half[seen].min(), half[seen].max()
            mask = seen & (half > low + (high - low) * (0.4 + 1) / 2)
        own = said[refs[i]]
        wrong += (decode(own["segmentation"]) != mask.reshape(size)).sum()
        column, row = map(int, own["peak"])
        if mean[row, column] < mean.max() - 1e-6:
            print(refs[i], "has its peak at", own["peak"], "where the mean is", mean[row, column], "and", mean.max(), "elsewhere")
            wrong += mask.size
    print(wrong, "pixels of", len(chosen), "masks differ")
    return int(wrong > len(chosen) * len(image) / 1000 or len(chosen) == 0)


if __name__ == "__main__":
    if len(sys.argv) != 9:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
