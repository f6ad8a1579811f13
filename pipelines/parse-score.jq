# How many parses are right, in percent of the sentences, part by part:
#
#   jq -rn --slurpfile gold DATA/parses.unseen.jsonl --slurpfile parses PARSES -f pipelines/parse-score.jq
#
# gold: what gs-synth wrote beside its unseen sentences; parses: what text-parse made of them, same refs. A part is right where all of it
# is: every anchor's noun, every relation, what is denied and left out, further targets, ordinals, counts, groups, who looks.
def singular: if . == "thing" or . == "object" then "" elif test("(sh|ch|x|ss)es$") then .[:-2] elif test("[^s]s$") then .[:-1] else . end;
def noun: . // "" | ascii_downcase | split(" ") | last // "" | singular;
def found(f): [.. | objects | f] | sort;
def anchors: found(select(has("anchors")) | .anchors[].noun | noun);
def relations: found(select(has("relation") and .relation != "other" and .relation != "viewpoint") | .relation + (.degree // ""));
def denied: found(select(.negated == true) | .relation) + [(.except // [])[] | "except"];
def said(key): .[key] // null;

($parses | map({(.ref): .}) | add) as $parsed
| [$gold[] | . as $g | $parsed[.ref] as $p | {
	head: (($g.target.noun | noun) == ($p.target.noun | noun)),
	anchors: (($g | anchors) == ($p | anchors)),
	relations: (($g | relations) == ($p | relations)),
	denied: (($g | denied) == ($p | denied)),
	"further targets": (($g.also // [] | length) == ($p.also // [] | length)),
	ordinal: (($g | said("ordinal")) == ($p | said("ordinal"))),
	count: (($g.count // "one") == ($p.count // "one")),
	group: (($g | said("group")) == ($p | said("group"))),
	viewpoint: (($g | found(.view // empty)) == ($p | found(.view // empty)))
}] as $right
| ($right | length) as $n
| "sentences \($n)", ($right[0] | keys_unsorted[] | . as $k | "\($k) \(1000 * ([$right[] | select(.[$k])] | length) / $n | round / 10)"),
	"all of it \(1000 * ([$right[] | select(all(.[]; .))] | length) / $n | round / 10)"
