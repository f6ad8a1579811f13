# mIoU by relation word and by visibility, pooled over scenes and seeds, from what ablation-report.sh gathers.
BEGIN { FS = "\t"; runs_count = split(runs, run, " ") }

{
	key = $3 SUBSEP $4
	if (!(key in seen)) { seen[key] = 1; order[++keys] = key }
	n[$1, $2, key] += $5
	s[$1, $2, key] += $5 * $6
}

function mean(r, kind, key) {
	return n[r, kind, key] ? sprintf("%.1f", s[r, kind, key] / n[r, kind, key]) : "-"
}

function print_group(name, heading,    i, k, p) {
	printf "### By %s\n\nmIoU in test views over all scenes and seeds.\n\n| %s | pairs (test) |", heading, name
	for (k = 1; k <= runs_count; k++) printf " %s, test | %s, training |", run[k], run[k]
	printf "\n|---|---|"
	for (k = 1; k <= runs_count; k++) printf "---|---|"
	print ""
	for (i = 1; i <= keys; i++) {
		split(order[i], p, SUBSEP)
		if (p[1] != name) continue
		printf "| %s | %d |", p[2], n[run[1], "test", order[i]]
		for (k = 1; k <= runs_count; k++) printf " %s | %s |", mean(run[k], "test", order[i]), mean(run[k], "train", order[i])
		print ""
	}
	print ""
}

END { print_group("alike", "objects that look the same"); print_group("relation", "relation word"); print_group("visibility", "visible share of the target") }
