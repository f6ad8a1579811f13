#!/usr/bin/env bash
# The peer, PyTorch, at each number of Gaussians: BUILD/bench/peer.jsonl, which step.sh shows beside its own.
. tests/bench/common.sh
python=/usr/bin/python3
heading "peer: the feature part of a training iteration in PyTorch"
if ! $python -c 'import torch' 2>/dev/null; then
	echo "left out: $python has no PyTorch (Debian: python3-torch)"
	exit 0
fi
sizes=25000,50000,100000,200000,500000 repeats=5
[ -z "$FULL" ] || repeats=11
$python tests/peers/step_torch.py --gaussians $sizes --repeats $repeats --threads "$threads" >"$out/peer.jsonl" || exit
[ -z "$FULL" ] || $python tests/peers/step_torch.py --gaussians $sizes --repeats $repeats --threads 1 >>"$out/peer.jsonl" || exit
jq -rs '(["Gaussians", "threads", "median, ms", "least, ms", "order"] | @tsv),
	(.[] | [.gaussians, .threads, .feature_ms, .min_ms, .order] | @tsv)' "$out/peer.jsonl" | table
