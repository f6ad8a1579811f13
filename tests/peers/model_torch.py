#!/usr/bin/python3
"""The referring model in PyTorch float64, with autograd, against the C reference.

usage: model_torch.py TEST_REFERENCE

TEST_REFERENCE is the built unit test (build/unit/test_reference); its --dump gives a random problem and the reference's
answer as JSON. Written from the header of libcommon/field/referring_model.h. Prints one line a case and exits 1 where a number differs by
more than 1e-10. Needs PyTorch and NumPy; `make test` does not run it.
"""
import itertools
import json
import math
import subprocess
import sys

import torch
from torch.nn import functional as F

D = 128
WIDTHS = [1, 5, 16, 32]
BOUND = 1e-10


def tensor(values, *shape):
    return torch.tensor(values, dtype=torch.float64).reshape(*shape)


def mlp(t, name, x):
    for layer in range(3):
        x = F.linear(x, t[f"{name}.{layer}.weight"], t[f"{name}.{layer}.bias"])
        x = F.relu(x) if layer < 2 else x
    return x


def interact(t, kind, f, p, w):
    if kind == "none":
        return f
    if kind == "add":
        return f + p
    if kind == "pcmi-proj":
        def project(name, x):
            return F.linear(x, t[name + ".weight"], t[name + ".bias"])

        place = p / p.norm(dim=1, keepdim=True)
        c = torch.softmax(w @ f.T, dim=1) @ place
        query = project("query", f) + project("query_position", place)
        key = project("key", w) + project("key_position", c)
        attention = torch.softmax(query @ key.T / math.sqrt(D), dim=1)
        return F.layer_norm(f + attention @ project("value", w), (D,), t["norm.weight"], t["norm.bias"], 1e-5)
    query, key = f, w
    if kind != "attention":
        query = f + p
    if kind == "pcmi":
        key = w + torch.softmax(w @ f.T / math.sqrt(D), dim=1) @ p
    return f + torch.softmax(query @ key.T / math.sqrt(D), dim=1) @ w


def response(similarity, refined, w):
    if similarity == "cosine":
        return F.cosine_similarity(refined[:, None, :], w[None, :, :], dim=2).sum(1)
    return (refined @ w.T).sum(1)


def contrast_loss(problem, refined, m, embeddings):
    k = max(1, math.floor(problem["tau"] * len(m)))
    top = torch.sort(m.detach(), descending=True, stable=True).indices[:k]
    f_g = refined[top].mean(0)
    if problem["contrast"] == 0:
        return top, torch.zeros((), dtype=torch.float64)
    if problem["contrast"] == 2:
        scores = F.cosine_similarity(f_g[None], embeddings, dim=1)
    else:
        scores = embeddings @ f_g
    logs = torch.log_softmax(scores / problem["temperature"], 0)
    objects = torch.tensor(problem["objects"])
    return top, -logs[objects == objects[problem["target"]]].mean()


def view(problem, gaussians):
    """The blend weights as a dense (P,N) matrix."""
    indptr = problem["indptr"]
    dense = torch.zeros(len(indptr) - 1, gaussians, dtype=torch.float64)
    for v, (begin, end) in enumerate(zip(indptr, indptr[1:])):
        for k in range(begin, end):
            dense[v, problem["index"][k]] += problem["weight"][k]
    return dense


def difference(mine, theirs):
    scale = max(mine.norm().item(), theirs.norm().item())
    return (mine - theirs).norm().item() / scale if scale > 1e-12 else 0.0


def compare(problem):
    t = {
        name: tensor(problem["parameters"][offset:offset + rows * columns], rows, columns).squeeze(1)
        if name.endswith("bias") or name.startswith("norm")
        else tensor(problem["parameters"][offset:offset + rows * columns], rows, columns)
        for name, (offset, rows, columns) in problem["tensors"].items()
    }
    x = tensor(problem["x"], -1, t["feature.0.weight"].shape[1])
    for leaf in [x, *t.values()]:
        leaf.requires_grad_()

    words = mlp(t, "text", tensor(problem["words"], problem["offsets"][-1], -1))
    ends = list(zip(problem["offsets"], problem["offsets"][1:]))
    embeddings = torch.stack([words[a:b].mean(0) for a, b in ends])
    w = words[slice(*ends[problem["target"]])]
    f = mlp(t, "feature", x)
    p = mlp(t, "position", tensor(problem["position"], -1, 3)) if "position.0.weight" in t else None
    refined = interact(t, problem["interaction"], f, p, w)
    m = response(problem["similarity"], refined, w)
    image = view(problem, len(x)) @ m
    bce = F.binary_cross_entropy_with_logits(image, tensor(problem["mask"], -1))
    top, contrast = contrast_loss(problem, refined, m, embeddings)
    loss = bce + problem["lambda"] * contrast
    loss.backward()

    found = {
        "m": difference(m.detach(), tensor(problem["m"], -1)),
        "image": difference(image.detach(), tensor(problem["image"], -1)),
        "bce": abs(bce.item() / problem["bce"] - 1),
        "contrast": abs(contrast.item() - problem["contrast_loss"]),
        "loss": abs(loss.item() / problem["loss"] - 1),
        "top": 0.0 if top.tolist() == problem["top"] else 1.0,
        "dx": difference(x.grad, tensor(problem["dx"], *x.shape)),
    }
    for name, (offset, rows, columns) in problem["tensors"].items():
        theirs = tensor(problem["dparameters"][offset:offset + rows * columns], *t[name].shape)
        found["d " + name] = difference(t[name].grad, theirs)
    return loss.item(), found


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    failed = False
    for interaction in ["none", "attention", "attention+fp", "add", "pcmi", "pcmi-proj"]:
        for similarity in ["dot", "cosine"][:1 if interaction == "pcmi-proj" else 2]:
            for contrast, width in itertools.product(range(3), WIDTHS):
                out = subprocess.run([sys.argv[1], "--dump", interaction, similarity, str(contrast), str(width)], check=True,
                                     stdout=subprocess.PIPE).stdout
                loss, found = compare(json.loads(out))
                worst = max(found, key=found.get)
                values = max(found[k] for k in found if not k.startswith("d"))
                ok = all(v <= BOUND for v in found.values())
                failed |= not ok
                print(f"{interaction:12} {similarity:6} contrast {contrast}, x {width:2}: loss {loss:.15g}, values within "
                      f"{values:.1e}, worst of all {found[worst]:.1e} ({worst}){'' if ok else '  DIFFERS'}", flush=True)
    sys.exit(failed)


if __name__ == "__main__":
    main()
