"""What the peers of the encoders share: safetensors, and a file of sentences. Needs numpy."""
import json
import pathlib
import struct

import numpy as np


def read_safetensors(path):
    raw = pathlib.Path(path).read_bytes()
    length = struct.unpack("<Q", raw[:8])[0]
    header, out = json.loads(raw[8:8 + length]), {}
    meta = header.pop("__metadata__", {})
    for name, t in header.items():
        a, b = (8 + length + o for o in t["data_offsets"])
        if t["dtype"] == "BF16":
            array = (np.frombuffer(raw[a:b], "<u2").astype(np.uint32) << 16).view(np.float32)
        else:
            array = np.frombuffer(raw[a:b], {"F16": "<f2", "F32": "<f4", "F64": "<f8", "I64": "<i8", "I32": "<i4", "U8": "u1"}[t["dtype"]])
        out[name] = array.reshape(t["shape"])
    return out, meta


def write_safetensors(path, arrays):
    header, data = {}, b""
    for name, a in arrays.items():
        a = np.ascontiguousarray(a)
        kind_of = {"float16": "F16", "float32": "F32", "int32": "I32", "int64": "I64"}[a.dtype.name]
        header[name] = {"dtype": kind_of, "shape": list(a.shape), "data_offsets": [len(data), len(data) + a.nbytes]}
        data += a.tobytes()
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (1 - len(text) % 2)  # data at an odd offset, as in files of others
    pathlib.Path(path).write_bytes(struct.pack("<Q", len(text)) + text + data)


def write_sentences(path, sentences):
    with open(path, "w") as out:
        for i, text in enumerate(sentences):
            line = {"ref": f"s{i:02}", "object": f"o{i % 7}", "text": text, "split": "test" if i % 5 == 4 else "train"}
            out.write(json.dumps(line, ensure_ascii=i % 2 == 0) + "\n")
