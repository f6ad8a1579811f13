#!/usr/bin/env python3
"""An independent BERT: tokenizer from unicodedata, encoder in float64. Needs numpy.

    python3 tests/peers/bert.py make tests/golden/bert     a tiny random encoder, sentences and what they should give
    python3 tests/peers/bert.py compare MODEL_DIR          run build/bin/text-encode on MODEL_DIR and compare

`compare` prints the worst difference of any word vector, and exits 1 above 1e-4.
"""
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

SENTENCES = [
    "This is an example sentence", "Each sentence is converted", "the red cup to the left of the plate",
    "", "   \t\n ", "a", "A RED CUP", "Café crème brûlée, naïve façade", "Ünïcödé ÀÉÎÕÜ ñ ç ß Æ ø Ł İstanbul ı",
    "e\u0301 a\u0308o\u0302 combining", "don't stop -- really?! (yes) [no] {maybe}", "a$b+c<d=e>f^g`h|i~j",
    "1234567890 3.14 1,000 2nd 10% #7 @home", "cup_with_underscores and-hyphens/slashes\\back",
    "杯子在桌子上 the 红 cup", "日本語のカップ ひらがな カタカナ が ぱ", "한국어 컵 빨간 컵", "красная чашка НА СТОЛЕ ёй",
    "κόκκινο φλιτζάνι ΟΔΟΣ Σίσυφος", "كوب أحمر على الطاولة", "אדום כוס שׁ", "लाल कप मेज पर की", "ถ้วยสีแดง",
    "soft\u00adhyphen zero\u200bwidth bom\ufeff joiner\u200d non\u00a0breaking em\u2003space\u3000wide",
    "bell\u0007 tab\tend\u0085next line\u2028sep\u2029para\u000bvt \ufffdgone\ue000private",
    "“curly” ‘quotes’ – en — em … ellipsis « guillemets » ¿qué? ¡sí! 、。「」", "emoji 🙂 cup 👩‍👩‍👧 ☕ © ™ € £ ½ ² ﬁ Ⅳ",
    "x" * 100, "x" * 101, "a" + "é" * 99 + " ok", "zzzqqqxxjjvv unknownishword antidisestablishmentarianism",
    "[CLS] the [MASK] cup [SEP] on[UNK]the[PAD] plate [cls] [SE P]", "##ing ## #cup cup##s",
    "豈 更 丽 \u037e \u1fef \u212b \u2126 \u0344 \u0958 \u09cb", "the red cup " * 200, "plates, " * 300,
    "the toy that is standing between the grey laptop and the yellow scarf, close to the wall",
    "the second book from the left, under the lamp with the white shade",
]


def tokenise(text, ids):
    """Token ids of a text, without [CLS] and [SEP]."""
    specials = [t for t in ("[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]") if t in ids]
    out, rest = [], text
    while rest:
        found = [(rest.find(t), t) for t in specials if t in rest]
        at, token = min(found) if found else (len(rest), None)
        for word in split_words(rest[:at]):
            out += [ids[p] for p in word_pieces(word, ids)]
        if token is None:
            break
        out.append(ids[token])
        rest = rest[at + len(token):]
    return out


def is_cjk(c):
    n = ord(c)
    return (0x4E00 <= n <= 0x9FFF or 0x3400 <= n <= 0x4DBF or 0x20000 <= n <= 0x2A6DF or 0x2A700 <= n <= 0x2CEAF
            or 0xF900 <= n <= 0xFAFF or 0x2F800 <= n <= 0x2FA1F)


def is_punctuation(c):
    return unicodedata.category(c)[0] == "P" or (ord(c) < 128 and c.isprintable() and not c.isalnum() and c != " ")


def split_words(text):
    kept = [c for c in text if c in "\t\n\r" or (unicodedata.category(c) not in ("Cc", "Cf", "Co") and c != "\ufffd")]
    text = "".join(f" {c} " if is_cjk(c) else c for c in kept)
    text = "".join(c for c in unicodedata.normalize("NFD", text) if unicodedata.category(c) != "Mn")
    text = "".join(c.lower() for c in text)
    return "".join(f" {c} " if is_punctuation(c) else c for c in text).split()


def word_pieces(word, ids):
    if len(word) > 100:
        return ["[UNK]"]
    pieces, start = [], 0
    while start < len(word):
        for end in range(len(word), start, -1):
            piece = ("##" if start else "") + word[start:end]
            if piece in ids:
                break
        else:
            return ["[UNK]"]
        pieces.append(piece)
        start = end
    return pieces


erf = np.vectorize(math.erf)


class Bert:
    def __init__(self, folder):
        folder = pathlib.Path(folder)
        self.config = json.loads((folder / "config.json").read_text())
        self.ids = json.loads((folder / "tokenizer.json").read_text())["model"]["vocab"]
        tensors, _ = read_safetensors(next(folder.glob("*.safetensors")))
        self.t = {k.removeprefix("bert."): v.astype(np.float64) for k, v in tensors.items()}

    def linear(self, name, x):
        return x @ self.t[name + ".weight"].T + self.t[name + ".bias"]

    def norm(self, name, x):
        centred = x - x.mean(-1, keepdims=True)
        scale = np.sqrt((centred**2).mean(-1, keepdims=True) + self.config["layer_norm_eps"])
        return centred / scale * self.t[name + ".weight"] + self.t[name + ".bias"]

    def forward(self, ids):
        heads, embeddings = self.config["num_attention_heads"], "embeddings."
        n = len(ids)
        x = self.t["embeddings.word_embeddings.weight"][ids] + self.t["embeddings.position_embeddings.weight"][:n]
        x = self.norm("embeddings.LayerNorm", x + self.t["embeddings.token_type_embeddings.weight"][0])
        for i in range(self.config["num_hidden_layers"]):
            at = f"encoder.layer.{i}."
            q, k, v = (self.linear(at + f"attention.self.{m}", x).reshape(n, heads, -1).transpose(1, 0, 2)
                       for m in ("query", "key", "value"))
            score = q @ k.transpose(0, 2, 1) / math.sqrt(q.shape[-1])
            share = np.exp(score - score.max(-1, keepdims=True))
            share /= share.sum(-1, keepdims=True)
            context = (share @ v).transpose(1, 0, 2).reshape(n, -1)
            x = self.norm(at + "attention.output.LayerNorm", x + self.linear(at + "attention.output.dense", context))
            h = self.linear(at + "intermediate.dense", x)
            h = h * 0.5 * (1 + erf(h / math.sqrt(2)))
            x = self.norm(at + "output.LayerNorm", x + self.linear(at + "output.dense", h))
        return x

    def encode(self, text):
        """The ids between [CLS] and [SEP], and all vectors, those of [CLS] and [SEP] included."""
        ids = tokenise(text, self.ids)[:self.config["max_position_embeddings"] - 2]
        return ids, self.forward([self.ids["[CLS]"]] + ids + [self.ids["[SEP]"]])


def make_vocab():
    letters = "abcdefghijklmnopqrstuvwxyz"
    tokens = ["[PAD]", "[unused0]", "[UNK]", "[CLS]", "[SEP]", "[MASK]"] + list(letters) + ["##" + c for c in letters]
    tokens += list("0123456789") + ["##" + c for c in "0123456789"] + list("!#$(),-./<=>?[]_{|}~'") + list("“”‘—…«。")
    tokens += list("杯子在上红") + ["κ", "##ο", "##κ", "σ", "##σ", "##δ", "ο", "##υ", "##ς", "н", "а", "##а", "с", "##т", "##о"]
    tokens += ["ᄏ", "##ᅥ", "##ᆸ", "か", "##か", "は", "ß", "##ı", "☕"]
    tokens += ["the", "red", "cup", "##s", "left", "plate", "of", "to", "is", "an", "example", "sentence", "this", "each",
               "and", "toy", "##ing", "stand", "wall", "grey", "book", "from", "cafe", "creme", "na", "##ive", "lamp"]
    tokens = list(dict.fromkeys(tokens))
    return tokens


def make(folder):
    rng, folder = np.random.default_rng(1), pathlib.Path(folder)
    width, inner, layers, tokens = 24, 40, 2, make_vocab()
    config = {"model_type": "bert", "hidden_act": "gelu", "hidden_size": width, "intermediate_size": inner,
              "layer_norm_eps": 1e-12, "max_position_embeddings": 64, "num_attention_heads": 4,
              "num_hidden_layers": layers, "type_vocab_size": 2, "vocab_size": len(tokens)}
    arrays = {}

    def put(name, *shape, scale, mean=0.0):
        # Eight significant bits: exact as F16, as BF16 and as F32.
        x = (mean + scale * rng.standard_normal(shape)).astype(np.float32)
        bits = x.view(np.uint32) & np.uint32(0xFFFF0000)
        x = bits.view(np.float32)
        arrays[name] = np.where(np.abs(x) < 2.0**-7, np.float32(0), x).astype(np.float16)

    def put_linear(name, rows, columns):
        put(name + ".weight", rows, columns, scale=1.2 / math.sqrt(columns))
        put(name + ".bias", rows, scale=0.1)

    def put_norm(name):
        put(name + ".weight", width, scale=0.2, mean=1)
        put(name + ".bias", width, scale=0.2)

    put("embeddings.word_embeddings.weight", len(tokens), width, scale=1)
    put("embeddings.position_embeddings.weight", 64, width, scale=0.3)
    put("embeddings.token_type_embeddings.weight", 2, width, scale=0.3)
    put_norm("embeddings.LayerNorm")
    for i in range(layers):
        at = f"encoder.layer.{i}."
        for m in ("self.query", "self.key", "self.value", "output.dense"):
            put_linear(at + "attention." + m, width, width)
        put_norm(at + "attention.output.LayerNorm")
        put_linear(at + "intermediate.dense", inner, width)
        put_linear(at + "output.dense", width, inner)
        put_norm(at + "output.LayerNorm")
    tokenizer = {"version": "1.0", "truncation": {"max_length": 8}, "padding": {"strategy": {"Fixed": 16}},
                 "normalizer": {"type": "BertNormalizer", "clean_text": True, "handle_chinese_chars": True,
                                "strip_accents": None, "lowercase": True},
                 "pre_tokenizer": {"type": "BertPreTokenizer"},
                 "model": {"type": "WordPiece", "unk_token": "[UNK]", "continuing_subword_prefix": "##",
                           "max_input_chars_per_word": 100, "vocab": {t: i for i, t in enumerate(tokens)}}}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "config.json").write_text(json.dumps(config, indent=1) + "\n")
    (folder / "tokenizer.json").write_text(json.dumps(tokenizer, indent=1, ensure_ascii=False) + "\n")
    (folder / "vocab.txt").write_text("\n".join(tokens) + "\n")
    write_safetensors(folder / "model.safetensors", arrays)
    write_sentences(folder / "sentences.jsonl", SENTENCES)
    write_expected(Bert(folder), folder.with_name("bert-expected.safetensors"))


def write_expected(bert, path):
    ids, words, offsets = [], [], [0]
    for text in SENTENCES:
        some, x = bert.encode(text)
        ids += some
        words.append(x[1:-1])
        offsets.append(len(ids))
    write_safetensors(path, {"offsets": np.array(offsets, np.int64), "ids": np.array(ids, np.int32),
                             "words": np.concatenate(words).astype(np.float32)})


def compare(folder):
    bert = Bert(folder)
    with tempfile.TemporaryDirectory() as work:
        write_sentences(work + "/sentences.jsonl", SENTENCES)
        begin = time.monotonic()
        subprocess.run(["build/bin/text-encode", "-q", "--model", folder, "-o", work + "/text.safetensors",
                        work + "/sentences.jsonl"], check=True)
        seconds = time.monotonic() - begin
        ours, meta = read_safetensors(work + "/text.safetensors")
    worst = worst_mean = 0.0
    for i, text in enumerate(SENTENCES):
        ids, x = bert.encode(text)
        words = ours["words"][ours["offsets"][i]:ours["offsets"][i + 1]]
        if len(words) != len(ids):
            sys.exit(f"sentence {i}: {len(words)} words, expected {len(ids)}: {text[:60]!r}")
        if ids:
            worst = max(worst, np.abs(words - x[1:-1]).max())
            worst_mean = max(worst_mean, np.abs(ours["sentences"][i] - x[1:-1].mean(0)).max())
    assert json.loads(meta["texts"]) == SENTENCES
    pooled = bert.encode(SENTENCES[0])[1].mean(0)
    print(f"{len(SENTENCES)} sentences, {ours['offsets'][-1]} words, {seconds:.2f} s")
    print(f"worst difference: word vector {worst:.2e}, sentence vector {worst_mean:.2e}")
    print(f"'{SENTENCES[0]}', pooled with [CLS] and [SEP]:", *(f"{v:.7f}" for v in (pooled / np.linalg.norm(pooled))[:3]))
    sys.exit(int(worst > 1e-4 or worst_mean > 1e-4))


if len(sys.argv) != 3 or sys.argv[1] not in ("make", "compare"):
    sys.exit(__doc__)
{"make": make, "compare": compare}[sys.argv[1]](sys.argv[2])
