#!/usr/bin/python3
"""Times the part of a training iteration of ReferSplat that is not rasterising, in PyTorch on CPU, well tuned.

usage: step_torch.py [--gaussians N,...] [--words n] [--sentences S] [--repeats K] [--threads T] [--orders NAME,...]

The peer of tests/bench/bench_step.c. One iteration, as the paper's program computes it, every feature 128 wide for every
Gaussian: MLP_f, MLP_p and MLP_t, the words' positions by a softmax over the Gaussians, attention of Gaussians to words (PCMI,
section 4 of the paper, no projections), responses m, backward from a given dL/dm, Adam on features and MLPs. A softmax over
few words and another over all Gaussians, float32.

It does less than a step of refer-train, so that the comparison favours it: no image is blended from m and none back (dL/dm is
given), no contrast and no choice of its top set, and only the step's own sentences go through MLP_t, where the contrast needs
all of the scene's. What it has not is the folding of field/fold.h: that is what is compared.

Several orders of evaluation that give the same numbers are tried at each N, and the fastest is printed:
  code    f' = f + alpha w as a matrix, m = sum of f' w^T, as the released program has it
  scalar  m = f.s + alpha.(w s): what a sum over words of dot products comes to
  split   scalar, with (f+p) k^T as f k^T + p k^T: nothing 128 wide is made but f and p
  stacked split, with f.s, f w^T and p k^T each a part of one product
Every order is checked against the first. Prints JSON Lines, one an N: the median and the least over the repeats of the
fastest order, in milliseconds. Needs PyTorch 1.13 or later on Linux; `make test` does not run it.
"""
import argparse
import ctypes
import json
import math
import os
import statistics
import sys
import time

D, X, TEXT = 128, 16, 384
M_TRIM_THRESHOLD, M_TOP_PAD, M_MMAP_MAX = -1, -2, -4


def tune(threads):
    """What must be set before PyTorch is loaded: kernels for this processor; threads of its two pools (OpenMP's and OpenBLAS's)
    that do not spin against each other where they wait, which costs twice the time on two processors; and a heap that
    gives no pages back, for otherwise much of the time goes to zeroing fresh pages."""
    with open("/proc/cpuinfo", encoding="ascii", errors="replace") as f:
        flags = next((line.split() for line in f if line.startswith("flags")), [])
    if "avx512vl" in flags and "avx512dq" in flags:
        os.environ.setdefault("OPENBLAS_CORETYPE", "SkylakeX")
        os.environ.setdefault("ATEN_CPU_CAPABILITY", "avx512")
    os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = str(threads)
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", "4")
    libc = ctypes.CDLL(None)
    if hasattr(libc, "mallopt"):
        libc.mallopt(M_MMAP_MAX, 0)
        libc.mallopt(M_TRIM_THRESHOLD, 2**31 - 1)
        libc.mallopt(M_TOP_PAD, 2**28)


def arguments():
    def numbers(text):
        return [int(n) for n in text.split(",")]

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--gaussians", type=numbers, default=[100000], metavar="N,...")
    parser.add_argument("--words", type=int, default=14, help="of a sentence (default 14)")
    parser.add_argument("--sentences", type=int, default=1, help="in an iteration (default 1)")
    parser.add_argument("--repeats", type=int, default=7, help="timed iterations at each N (default 7)")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--orders", type=lambda text: text.split(","), default=list(ORDERS), metavar="NAME,...",
                        help="orders of evaluation to try (default: all)")
    a = parser.parse_args()
    if min(*a.gaussians, a.words, a.sentences, a.repeats, a.threads) < 1 or not set(a.orders) <= set(ORDERS):
        parser.error("every number is at least 1, and an order one of " + ", ".join(ORDERS))
    return a


def mlp(layers, x):
    for layer in layers[:-1]:
        x = torch.relu_(layer(x))
    return layers[-1](x)


def per_sentence(scores, sentences):
    """Softmax over the words of each sentence: scores (N, S n) to alpha (N, S, n)."""
    return torch.softmax(scores.view(len(scores), sentences, -1), 2)


def positions(beta_scores, p):
    """c (S n, 128): where each word's Gaussians are."""
    return torch.softmax(beta_scores, 1) @ p


def order_code(f, p, w, sentences):
    """w is (S n, 128); gives m (N, S)."""
    c = positions(w @ f.T / math.sqrt(D), p)
    alpha = per_sentence((f + p) @ (w + c).T / math.sqrt(D), sentences)
    each = w.view(sentences, -1, D)
    return torch.stack([((f + alpha[:, i] @ each[i]) @ each[i].T).sum(1) for i in range(sentences)], 1)


def respond(fs, alpha, w, s):
    """m from f.s (N, S), alpha (N, S, n) and w.s."""
    return fs + (alpha * (w.view(len(s), -1, D) * s[:, None]).sum(2)).sum(2)


def order_scalar(f, p, w, sentences):
    s = w.view(sentences, -1, D).sum(1)
    c = positions(w @ f.T / math.sqrt(D), p)
    alpha = per_sentence((f + p) @ ((w + c) / math.sqrt(D)).T, sentences)
    return respond(f @ s.T, alpha, w, s)


def order_split(f, p, w, sentences):
    s = w.view(sentences, -1, D).sum(1)
    c = positions((w / math.sqrt(D)) @ f.T, p)
    k = ((w + c) / math.sqrt(D)).T
    return respond(f @ s.T, per_sentence(torch.addmm(f @ k, p, k), sentences), w, s)


def order_stacked(f, p, w, sentences):
    s, scaled = w.view(sentences, -1, D).sum(1), w / math.sqrt(D)
    own = f @ torch.cat([scaled, s]).T
    c = positions(own[:, :len(w)].T, p) / math.sqrt(D)
    scores = own[:, :len(w)] + f @ c.T + p @ (scaled + c).T
    return respond(own[:, len(w):], per_sentence(scores, sentences), w, s)


ORDERS = {"code": order_code, "scalar": order_scalar, "split": order_split, "stacked": order_stacked}


def networks():
    def layers(*widths):
        return torch.nn.ModuleList(torch.nn.Linear(a, b) for a, b in zip(widths, widths[1:]))

    return layers(X, 32, 64, D), layers(3, 16, 64, D), layers(TEXT, 512, 256, D)


class Iteration:
    """A training iteration over N Gaussians; the same problem each time it is made."""

    def __init__(self, gaussians, words, sentences):
        torch.manual_seed(1)
        self.sentences = sentences
        self.x = torch.rand(gaussians, X).requires_grad_()
        self.means = torch.rand(gaussians, 3) * 2 - 1
        self.text = torch.randn(sentences * words, TEXT) * 0.1
        self.dm = torch.randn(gaussians, sentences) / gaussians
        self.nets = networks()
        parameters = [p for net in self.nets for p in net.parameters()]
        self.adam = torch.optim.Adam([{"params": [self.x], "lr": 0.0025}, {"params": parameters, "lr": 0.0001}], eps=1e-15)

    def gradient(self, order):
        feature, position, text = self.nets
        self.adam.zero_grad(set_to_none=True)
        m = order(mlp(feature, self.x), mlp(position, self.means), mlp(text, self.text), self.sentences)
        m.backward(self.dm)
        return m.detach()

    def run(self, order):
        self.gradient(order)
        self.adam.step()


def agree(a, gaussians=500):
    """Every order gives the first one's responses and gradient of x, to rounding."""
    results = []
    for name, order in ORDERS.items():
        problem = Iteration(gaussians, a.words, a.sentences)
        results.append((problem.gradient(order), problem.x.grad))
        for mine, first in zip(results[-1], results[0]):
            if not (mine - first).norm() <= 1e-4 * first.norm():
                sys.exit(f"step_torch: the order {name} gives other numbers than {next(iter(ORDERS))}")


def measure(problem, order, repeats, warm):
    times = []
    for i in range(repeats + warm):
        start = time.perf_counter()
        problem.run(order)
        times.append(1e3 * (time.perf_counter() - start))
    return times[warm:]


def main():
    a = arguments()
    torch.set_num_threads(a.threads)
    torch.set_flush_denormal(True)
    agree(a)
    for n in a.gaussians:
        problem = Iteration(n, a.words, a.sentences)
        trial = {name: min(measure(problem, ORDERS[name], 2, 1)) for name in a.orders}
        best = min(trial, key=trial.get)
        times = measure(problem, ORDERS[best], a.repeats, 0)
        print(json.dumps({"bench": "torch", "gaussians": n, "words": a.words, "sentences": a.sentences,
                          "threads": a.threads, "feature_ms": round(statistics.median(times), 3),
                          "min_ms": round(min(times), 3), "repeats": a.repeats, "order": best,
                          "orders": {name: round(ms, 3) for name, ms in trial.items()},
                          "torch": torch.__version__}), flush=True)


if __name__ == "__main__":
    options = arguments() if "-h" in sys.argv[1:] or "--help" in sys.argv[1:] else None
    wanted = [sys.argv[i + 1] for i, s in enumerate(sys.argv[:-1]) if s == "--threads"]
    wanted += [s.split("=", 1)[1] for s in sys.argv if s.startswith("--threads=")]
    tune(wanted[-1] if wanted else os.cpu_count())
    import torch

    main()
