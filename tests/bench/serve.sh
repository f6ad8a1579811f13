#!/usr/bin/env bash
# Usage: [BIN=build/bin] [CLIENTS=8] [SECONDS_LONG=10] tests/bench/serve.sh RUN QUESTIONS
#
# Latency of refer-serve's /v1/ask on RUN, a folder with a lifted model, with so many clients at once, each of which asks again as
# soon as it has an answer: once with the questions of a file, one a line, and once with none asked twice (a number is put behind
# each). All of it twice, so that memory can be seen not to grow. Needs wrk (Debian's package) and an idle machine.
set -euo pipefail
export LC_ALL=C
BIN=${BIN:-build/bin}
[ $# = 2 ] && [ -d "$1" ] && [ -f "$2" ] || { sed -n 's/^# Usage: //p' "$0" >&2; exit 2; }
work=$(mktemp -d)
"$BIN/refer-serve" -q --port 0 "$1" >"$work/address" &
pid=$!
trap 'kill $pid; rm -rf "$work"' EXIT
until [ -s "$work/address" ]; do sleep 0.1; done
address=$(sed 's,/#.*,,' "$work/address")

# load NAME SUFFIX: a script of wrk that asks each question with a Lua expression behind it
load() {
	{
		jq -Rs 'split("\n") | map(select(. != ""))' "$2" | sed '1s/.*/local all = {/; $s/.*/}/'
		printf 'local k, clients = 0, 0\nfunction setup(thread) clients = clients + 1 thread:set("client", clients) end\n'
		printf 'function init(args) math.randomseed(os.time() * 64 + client) k = math.random(#all) end\n'
		printf 'function request() k = k + 1 return wrk.format("POST", "/v1/ask", nil, "{\\"question\\": \\"" .. all[k %% #all + 1]:gsub("[\\"\\\\]", "") .. %s .. "\\"}") end\n' "$3"
	} >"$work/$1.lua"
	printf '%s: ' "$1"
	wrk -t "${CLIENTS:-8}" -c "${CLIENTS:-8}" -d "${SECONDS_LONG:-10}" --latency -s "$work/$1.lua" "$address" |
		awk '/50%|99%/ { printf "%s %s  ", $1, $2 } /requests in/ { printf "%s requests", $1 } /Non-2xx/ { printf "  %s", $0 }'
	printf '  then %s of memory\n' "$(sed -n 's/^VmRSS:[ \t]*//p' "/proc/$pid/status")"
}

for _ in 1 2; do
	load "asked before" "$2" '""'
	load "new" "$2" '" " .. math.random(1000000000)'
done
