#!/usr/bin/env python3
"""An independent text tower of CLIP: byte pairs merged as published, encoder in float64. Needs numpy.

    python3 tests/peers/clip.py make tests/golden/clip     a tiny random tower in both layouts, and what it should give
    python3 tests/peers/clip.py compare MODEL_DIR          run build/bin/text-encode on MODEL_DIR and compare

`make` writes HuggingFace's layout to the folder, OpenCLIP's to open-clip beside it, and the expected vectors. MODEL_DIR
has HuggingFace's. `compare` prints the worst difference of any word's and sentence's vector, and exits 1 above 1e-4.
"""
import gzip
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time
import unicodedata

import numpy as np

from encoder_files import read_safetensors, write_safetensors, write_sentences

START, END, LAST = "<|startoftext|>", "<|endoftext|>", "</w>"
SENTENCES = [
    "a photo of a cat", "the red cup to the left of the plate", "", "   \t\n ", "a", "A RED CUP",
    "Café crème brûlée, naïve façade", "Ünïcödé ÀÉÎÕÜ ñ ç ß Æ ø Ł İstanbul ı ΟΔΟΣ Å Å Ⱥ",
    "e\u0301 a\u0308o\u0302 combining", "don't stop -- really?! (yes) [no] {maybe}", "a$b+c<d=e>f^g`h|i~j",
    "it's I'm you're we've they'll she'd can't 'tis 'stand ''s '", "IT'S O'Clock rock'n'roll",
    "1234567890 3.14 1,000 2nd 10% #7 @home ½ Ⅳ ²", "cup_with_underscores and-hyphens/slashes\\back",
    "杯子在桌子上 the 红 cup", "한국어 컵 빨간 컵", "красная чашка НА СТОЛЕ ёй", "κόκκινο φλιτζάνι ΟΔΟΣ Σίσυφος",
    "لاكوب أحمر", "लाल कप मेज", "non\u00a0breaking em\u2003space\u3000wide\u0085next\u2028sep",
    "bell\u0007 tab\tend \ufffdkept", "“curly” ‘quotes’ – en — em … «x» ¿qué?",
    "emoji 🙂 cup 👩👩👧 ☕☕ © ™ €", "x" * 300, "ab" * 200, "the cup " * 80, "plates, " * 40, "é" * 120,
    "<|startoftext|> the <|endoftext|> cup<|endoftext|>s <|ENDOFTEXT|> !!<|endoftext|>!", "<|endof text|> </w> a</w>",
    "zzzqqqxxjjvv unknownishword antidisestablishmentarianism", "& &amp; <b> \"quoted\" * # ## ###",
    "the toy that is standing between the grey laptop and the yellow scarf, close to the wall",
    "the second book from the left, under the lamp with the white shade",
]
SPACES = set("\t\n\x0b\x0c\r \x85\xa0\u1680\u2028\u2029\u202f\u205f\u3000") | {chr(c) for c in range(0x2000, 0x200b)}


def letters():
    """How CLIP writes each byte, in its order."""
    shown = [*range(0x21, 0x7f), *range(0xa1, 0xad), *range(0xae, 0x100)]
    hidden = [b for b in range(256) if b not in shown]
    return {b: chr(b) for b in shown} | {b: chr(256 + i) for i, b in enumerate(hidden)}


LETTERS = letters()


def kind(c):
    return "space" if c in SPACES else {"L": "letter", "N": "number"}.get(unicodedata.category(c)[0], "other")


def split_words(text):
    text = "".join(c.lower() for c in unicodedata.normalize("NFC", text))
    words, at = [], 0
    while at < len(text):
        fixed = [s for s in (START, END, "'s", "'t", "'re", "'ve", "'m", "'ll", "'d") if text.startswith(s, at)]
        this, end = kind(text[at]), at + 1
        if fixed:
            end = at + len(fixed[0])
        elif this in ("letter", "other"):
            while end < len(text) and kind(text[end]) == this and not text.startswith((START, END), end):
                end += 1
        if this != "space":
            words.append(text[at:end])
        at = end
    return words


def merge_word(symbols, ranks):
    while len(symbols) > 1:
        best = min(zip(symbols, symbols[1:]), key=lambda pair: ranks.get(pair, math.inf))
        if best not in ranks:
            break
        out, i = [], 0
        while i < len(symbols):
            both = tuple(symbols[i:i + 2]) == best
            out.append("".join(symbols[i:i + 2]) if both else symbols[i])
            i += 2 if both else 1
        symbols = out
    return symbols


def symbols_of(word):
    symbols = [LETTERS[b] for b in word.encode()]
    return symbols[:-1] + [symbols[-1] + LAST]


def tokenise(text, ids, ranks):
    """Token ids of a text, without start and end."""
    out = []
    for word in split_words(text):
        out += [ids[s] for s in ([word] if word in (START, END) else merge_word(symbols_of(word), ranks))]
    return out


class Clip:
    def __init__(self, folder):
        folder = pathlib.Path(folder)
        config = json.loads((folder / "config.json").read_text())
        self.config = config.get("text_config") or config
        self.ids = json.loads((folder / "vocab.json").read_text())
        lines = (folder / "merges.txt").read_text().split("\n")
        self.ranks = {tuple(line.split(" ")): i for i, line in enumerate(x for x in lines if x and "#version" not in x)}
        tensors, _ = read_safetensors(folder / "model.safetensors")
        self.t = {k.removeprefix("text_model."): v.astype(np.float64) for k, v in tensors.items() if "vision" not in k}

    def linear(self, name, x):
        return x @ self.t[name + ".weight"].T + self.t[name + ".bias"]

    def norm(self, name, x):
        centred = x - x.mean(-1, keepdims=True)
        scale = np.sqrt((centred**2).mean(-1, keepdims=True) + self.config.get("layer_norm_eps", 1e-5))
        return centred / scale * self.t[name + ".weight"] + self.t[name + ".bias"]

    def act(self, x):
        if self.config.get("hidden_act", "quick_gelu") == "quick_gelu":
            return x / (1 + np.exp(-1.702 * x))
        return x * 0.5 * (1 + np.vectorize(math.erf)(x / math.sqrt(2)))

    def forward(self, ids):
        heads, n = self.config.get("num_attention_heads", 8), len(ids)
        x = self.t["embeddings.token_embedding.weight"][ids] + self.t["embeddings.position_embedding.weight"][:n]
        hidden = np.triu(np.full((n, n), -np.inf), 1)
        for i in range(self.config.get("num_hidden_layers", 12)):
            at = f"encoder.layers.{i}."
            y = self.norm(at + "layer_norm1", x)
            q, k, v = (self.linear(at + f"self_attn.{m}_proj", y).reshape(n, heads, -1).transpose(1, 0, 2) for m in "qkv")
            score = q @ k.transpose(0, 2, 1) / math.sqrt(q.shape[-1]) + hidden
            share = np.exp(score - score.max(-1, keepdims=True))
            share /= share.sum(-1, keepdims=True)
            x = x + self.linear(at + "self_attn.out_proj", (share @ v).transpose(1, 0, 2).reshape(n, -1))
            y = self.norm(at + "layer_norm2", x)
            x = x + self.linear(at + "mlp.fc2", self.act(self.linear(at + "mlp.fc1", y)))
        x = self.norm("final_layer_norm", x)
        return x @ self.t["text_projection.weight"].T if "text_projection.weight" in self.t else x

    def encode(self, text):
        """The ids between start and end, their vectors, and the sentence's."""
        ids = tokenise(text, self.ids, self.ranks)[:self.config.get("max_position_embeddings", 77) - 2]
        x = self.forward([self.ids[START]] + ids + [self.ids[END]])
        return ids, x[1:-1], x[1 + (ids + [self.ids[END]]).index(self.ids[END])]


def learn_merges(count):
    """The most frequent pairs of the sentences, as byte pair encoding is trained."""
    words = [symbols_of(w) for s in SENTENCES if len(s) < 120 for w in split_words(s) if w not in (START, END)]
    merges = []
    while len(merges) < count:
        counts = {}
        for w in words:
            for pair in zip(w, w[1:]):
                counts[pair] = counts.get(pair, 0) + 1
        best = max(sorted(counts), key=lambda pair: counts[pair])
        merges.append(best)
        words = [merge_word(w, {best: 0}) for w in words]
    return merges


def random_tower(tokens, width, inner, layers, projected):
    """Tensors by HuggingFace's names, of eight significant bits: exact as F16, as BF16 and as F32."""
    rng, arrays = np.random.default_rng(2), {}

    def put(name, *shape, scale, mean=0.0):
        x = (mean + scale * rng.standard_normal(shape)).astype(np.float32)
        x = (x.view(np.uint32) & np.uint32(0xFFFF0000)).view(np.float32)
        arrays[name] = np.where(np.abs(x) < 2.0**-7, np.float32(0), x).astype(np.float16)

    def put_linear(name, rows, columns):
        put(name + ".weight", rows, columns, scale=1.2 / math.sqrt(columns))
        put(name + ".bias", rows, scale=0.1)

    def put_norm(name):
        put(name + ".weight", width, scale=0.2, mean=1)
        put(name + ".bias", width, scale=0.2)

    put("text_model.embeddings.token_embedding.weight", tokens, width, scale=1)
    put("text_model.embeddings.position_embedding.weight", 77, width, scale=0.3)
    for i in range(layers):
        at = f"text_model.encoder.layers.{i}."
        for m in ("k", "v", "q", "out"):
            put_linear(at + f"self_attn.{m}_proj", width, width)
        put_norm(at + "layer_norm1")
        put_linear(at + "mlp.fc1", inner, width)
        put_linear(at + "mlp.fc2", width, inner)
        put_norm(at + "layer_norm2")
    put_norm("text_model.final_layer_norm")
    put("text_projection.weight", projected, width, scale=0.3)
    return arrays


def open_clip_names(arrays, layers):
    """The same numbers by OpenCLIP's names."""
    def at(name):
        return arrays["text_model." + name]

    out = {"positional_embedding": at("embeddings.position_embedding.weight"),
           "text_projection": arrays["text_projection.weight"].T, "logit_scale": np.array(4.6, np.float32)}
    for i in range(layers):
        theirs, ours = f"transformer.resblocks.{i}.", f"encoder.layers.{i}."
        for part in ("weight", "bias"):
            out[theirs + "ln_1." + part] = at(ours + "layer_norm1." + part)
            out[theirs + "attn.in_proj_" + part] = np.concatenate([at(ours + f"self_attn.{m}_proj." + part) for m in "qkv"])
            out[theirs + "attn.out_proj." + part] = at(ours + "self_attn.out_proj." + part)
            out[theirs + "ln_2." + part] = at(ours + "layer_norm2." + part)
            out[theirs + "mlp.c_fc." + part] = at(ours + "mlp.fc1." + part)
            out[theirs + "mlp.c_proj." + part] = at(ours + "mlp.fc2." + part)
    for part in ("weight", "bias"):
        out["ln_final." + part] = at("final_layer_norm." + part)
    out["token_embedding.weight"] = at("embeddings.token_embedding.weight")
    return out


def make(folder):
    folder = pathlib.Path(folder)
    other = folder.with_name("open-clip")
    width, layers, projected, merges = 24, 2, 20, learn_merges(120)
    tokens = list(LETTERS.values()) + [c + LAST for c in LETTERS.values()] + ["".join(m) for m in merges] + [START, END]
    text = {"model_type": "clip_text_model", "hidden_act": "quick_gelu", "hidden_size": width, "intermediate_size": 4 * width,
            "layer_norm_eps": 1e-05, "max_position_embeddings": 77, "num_attention_heads": 4, "num_hidden_layers": layers,
            "projection_dim": projected, "vocab_size": len(tokens)}
    arrays = random_tower(len(tokens), width, 4 * width, layers, projected)
    lines = "\n".join(" ".join(m) for m in merges) + "\n"
    for f in (folder, other):
        f.mkdir(parents=True, exist_ok=True)
    (folder / "config.json").write_text(json.dumps({"model_type": "clip", "projection_dim": projected, "text_config": text}, indent=1) + "\n")
    (folder / "vocab.json").write_text(json.dumps({t: i for i, t in enumerate(tokens)}, indent=0, ensure_ascii=False) + "\n")
    (folder / "merges.txt").write_text("#version: 0.2\n" + lines)
    write_safetensors(folder / "model.safetensors", arrays)
    (other / "open_clip_config.json").write_text(json.dumps({"model_cfg": {"embed_dim": projected, "quick_gelu": True, "text_cfg": {
        "context_length": 77, "vocab_size": len(tokens), "width": width, "heads": 4, "layers": layers}}}, indent=1) + "\n")
    # OpenCLIP's list goes on after the merges that its vocabulary has.
    listed = '"bpe_simple_vocab_16e6.txt#version: 0.2\n' + lines + "not used\nalso not\n"
    (other / "bpe_simple_vocab_16e6.txt.gz").write_bytes(gzip.compress(listed.encode(), mtime=0))
    write_safetensors(other / "open_clip_model.safetensors", open_clip_names(arrays, layers))
    write_sentences(folder / "sentences.jsonl", SENTENCES)
    write_expected(Clip(folder), folder.with_name("clip-expected.safetensors"))


def write_expected(clip, path):
    ids, words, sentences, offsets = [], [], [], [0]
    for text in SENTENCES:
        some, x, sentence = clip.encode(text)
        ids += some
        words.append(x)
        sentences.append(sentence)
        offsets.append(len(ids))
    write_safetensors(path, {"offsets": np.array(offsets, np.int64), "ids": np.array(ids, np.int32),
                             "words": np.concatenate(words).astype(np.float32), "sentences": np.array(sentences).astype(np.float32)})


def compare(folder):
    clip = Clip(folder)
    with tempfile.TemporaryDirectory() as work:
        write_sentences(work + "/sentences.jsonl", SENTENCES)
        begin = time.monotonic()
        subprocess.run(["build/bin/text-encode", "-q", "--model", folder, "-o", work + "/text.safetensors",
                        work + "/sentences.jsonl"], check=True)
        seconds = time.monotonic() - begin
        ours, _ = read_safetensors(work + "/text.safetensors")
    worst = worst_sentence = 0.0
    for i, text in enumerate(SENTENCES):
        ids, x, sentence = clip.encode(text)
        words = ours["words"][ours["offsets"][i]:ours["offsets"][i + 1]]
        if len(words) != len(ids):
            sys.exit(f"sentence {i}: {len(words)} words, expected {len(ids)}: {text[:60]!r}")
        worst = max(worst, np.abs(words - x).max() if ids else 0)
        worst_sentence = max(worst_sentence, np.abs(ours["sentences"][i] - sentence).max())
    print(f"{len(SENTENCES)} sentences, {ours['offsets'][-1]} words, {seconds:.2f} s")
    print(f"worst difference: word vector {worst:.2e}, sentence vector {worst_sentence:.2e}")
    sys.exit(int(worst > 1e-4 or worst_sentence > 1e-4))


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("make", "compare"):
        sys.exit(__doc__)
    {"make": make, "compare": compare}[sys.argv[1]](sys.argv[2])
