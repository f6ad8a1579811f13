#!/usr/bin/env bash
# The rooms from the highest floor down: each room's lines and its share of all, and how often its files include files of which
# other rooms. usage: tests/map.sh [--check] [ROOT]
# --check prints instead what breaks tests/floors, and fails where anything does: an include that the table does not allow,
# a file in no room of the table, two files of one name in different rooms, a table that is not in the order of its floors.
set -eu
floors=$(cd "$(dirname "$0")" && pwd)/floors
check=0
[ "${1-}" != --check ] || { check=1; shift; }
cd "${1-$(dirname "$0")/..}"

find cmd formats libcommon -name '*.[ch]' | LC_ALL=C sort | awk -v floors="$floors" -v check=$check '
function wrong(text) {
	if (check)
		print text
	bad = 1
}

# The room of a path: libcommon/base/err.h and base/err.h are in base, cmd/render/draw.h in cmd/render, all of formats/WING in formats. "": none.
function room_of(path, part, n) {
	n = split(path, part, "/")
	if (part[1] == "libcommon")
		return n == 3 ? part[2] : ""
	if (part[1] == "cmd" && n == 3)
		return "cmd/" part[2]
	if (part[1] == "formats")
		return n == 3 ? "formats" : ""
	return n == 2 ? part[1] : ""
}

BEGIN {
	while ((getline line <floors) > 0) {
		if (line ~ /^#/)
			continue
		n = split(line, word, " ")
		room[++rooms] = word[1]
		for (i = 2; i <= n; i++) {
			allowed[word[1], word[i]] = 1
			if (!(word[i] in known))
				wrong("tests/floors: " word[1] " may include " word[i] ", which is on no lower floor")
		}
		known[word[1]] = allowed[word[1], word[1]] = 1
	}
}

{
	from = room_of($0)
	if (!(from in known)) {
		wrong($0 ": in no room of tests/floors")
		next
	}
	name = $0
	sub(/.*\//, "", name)
	sub(/\.[ch]$/, "", name)
	if (name in first && first[name] != from)
		wrong($0 ": the room " first[name] " has a file of this name too")
	first[name] = from
	while ((getline line <$0) > 0) {
		lines[from]++
		all++
		if (line !~ /^[ \t]*#[ \t]*include[ \t]*"/)
			continue
		split(line, word, "\"")
		to = room_of(word[2])
		if (!(to in known))
			wrong($0 ": includes \"" word[2] "\", which is in no room of tests/floors")
		else if (!((from, to) in allowed))
			wrong($0 ": includes \"" word[2] "\", which is not on a lower floor")
		count[from, to]++
	}
	close($0)
}

END {
	if (check)
		exit bad
	for (i = rooms; i > 0; i--) {
		printf "%-12s%7d%6.1f%%", room[i], lines[room[i]], all ? 100 * lines[room[i]] / all : 0
		for (k = 1; k < i; k++)
			if (count[room[i], room[k]])
				printf "  %s %d", room[k], count[room[i], room[k]]
		print ""
	}
	printf "%-12s%7d\n", "all", all
}'
