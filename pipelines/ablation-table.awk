# A table of ablation.mk from published.tsv and the values that ablation-report.sh gathers.
BEGIN {
	FS = "\t"
	title["modules"] = "Modules (table 1)"
	title["second"] = "What teaches a second stage"
	title["exact"] = "Modules, without the shortcuts of a training step"
	title["similarity"] = "Similarity of features and words, without interaction (table 2)"
	title["masks"] = "Choice of pseudo masks (table 3)"
	title["interaction"] = "Interaction, without contrast (table 4)"
	title["width"] = "Width of the referring feature (table 7)"
	title["encoder"] = "Language encoder (table 6)"
	title["contrast"] = "Contrast, with and without projections"
	title["taught"] = "Parses in place of words, and sentences of the scene's own"
	title["lifted"] = "Without training, and from there"
}

/^#/ { next }
$1 == "row" && FILENAME ~ /published/ { if ($2 == table) { rows++; row[rows] = $3; label[$3] = $4; published[$3] = $5 } next }
$1 == "claim" && FILENAME ~ /published/ { if ($2 == table) { claims++; better[claims] = $3; worse[claims] = $4; source[claims] = $5 } next }

{
	value[$1, $2, $4] = $5
	if (!(($1, $3, $4) in sum)) { pairs[$1, $4]++ }
	sum[$1, $3, $4] += $5; count[$1, $3, $4]++
	has[$1] = 1; kind_seen[$4] = 1
	if (!($2 in cell_seen)) { cell_seen[$2] = 1; cell[++cells] = $2 }
	if (!($3 in seed_seen)) { seed_seen[$3] = 1; seed[++seed_count] = $3 }
	if (!($1 in label)) { rows++; row[rows] = $1; label[$1] = $1 }
}

# Mean over the seeds of the mean over the scenes, and how far the seeds are from it (standard deviation).
function cell_text(run, kind,    i, s, s2, m) {
	if (!((run, kind) in pairs)) return "-"
	s = s2 = 0
	for (i = 1; i <= seed_count; i++) { m = sum[run, seed[i], kind] / count[run, seed[i], kind]; s += m; s2 += m * m }
	m = s / seed_count
	if (seed_count < 2) return sprintf("%.1f", m)
	s2 = (s2 - seed_count * m * m) / (seed_count - 1)
	return sprintf("%.1f ± %.1f", m, sqrt(s2 > 0 ? s2 : 0))
}

# Mean difference of two runs over the same scenes and seeds, and its standard error.
function difference(a, b, kind,    i, d, s, s2) {
	s = s2 = 0
	for (i = 1; i <= cells; i++) { d = value[a, cell[i], kind] - value[b, cell[i], kind]; s += d; s2 += d * d }
	mean_difference = s / cells
	s2 = cells > 1 ? (s2 - s * s / cells) / (cells - 1) / cells : 0
	error_difference = sqrt(s2 > 0 ? s2 : 0)
}

# What a claim is worth in one kind of figures, after a separator; nothing where either run has none of them.
function claim_text(i, kind, what, separator,    verdict) {
	if (!((better[i], kind) in pairs) || !((worse[i], kind) in pairs)) return ""
	difference(better[i], worse[i], kind)
	if (cells < 2) return sprintf("%s%s cannot be told from one scene (%+.1f)", separator, what, mean_difference)
	verdict = mean_difference > 2 * error_difference ? "agrees" : mean_difference < -2 * error_difference ? "is the other way round" : "cannot be told"
	return sprintf("%s%s %s (%+.1f ± %.1f)", separator, what, verdict, mean_difference, error_difference)
}

END {
	quality = "quality" in kind_seen
	printf "### %s\n\n", title[table]
	printf "Scenes %s, seeds %s. mIoU in test views and share of the masks that fit the right object best, in percent: mean over seeds ± spread between them.\n\n", scenes, seeds
	printf "| | published |%s test sentences | right object | training sentences | right object |\n|---|---|%s---|---|---|---|\n", quality ? " quality of masks |" : "", quality ? "---|" : ""
	for (i = 1; i <= rows; i++)
		if (row[i] in has)
			printf "| %s | %s |%s %s | %s | %s | %s |\n", label[row[i]], published[row[i]],
				quality ? " " cell_text(row[i], "quality") " |" : "", cell_text(row[i], "test"), cell_text(row[i], "test-right"), cell_text(row[i], "train"), cell_text(row[i], "train-right")
	if (claims) print "\nThe published order, as mean paired difference ± its standard error:\n"
	for (i = 1; i <= claims; i++)
		if ((better[i] in has) && (worse[i] in has)) {
			told = claim_text(i, "test", "on test sentences", "") claim_text(i, "train", "on training sentences", "; ") \
				claim_text(i, "quality", "the masks themselves", "; ")
			sub(/^; /, "", told)
			printf "- %s above %s (%s): %s\n", label[better[i]], label[worse[i]], source[i], told
		}
	print ""
}
