# The weights of text-parse, from marked sentences (formats/records/marked.md).
#
#   make -f pipelines/parse.mk [OUT=work/parse]
#
# makes $(OUT)/parser.safetensors. `make -f pipelines/parse.mk test` prints the shares of the marked sentences kept for testing that
# are taken apart rightly, by PARSER=weights or text-parse's own.
#
# `make -f pipelines/parse.mk things` makes $(OUT)/things.vectors, to become libcommon/lang/things.vectors, with build/bench/fit_things.
#
# SEED (1), EPOCHS (10), MEMBERS (2) networks, MARKED and TESTS (pipelines/marked/learn/*.txt*, .../test/*.txt; also as .gz), SOURCE what the
# weights say that they were learnt from, BERT the encoder's folder, BIN that of the tools.

here := $(dir $(lastword $(MAKEFILE_LIST)))
OUT ?= work/parse
SEED ?= 1
EPOCHS ?= 10
MEMBERS ?= 2
MARKED ?= $(wildcard $(here)marked/learn/*.txt*)
TESTS ?= $(wildcard $(here)marked/test/*.txt)
SOURCE ?= the marked sentences of refersplat
include $(here)common.mk
$(call check,,OUT PARSER,SEED EPOCHS MEMBERS MARKED TESTS SOURCE BERT BIN)
.PHONY: all test things
all: $(OUT)/parser.safetensors

help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(called)

things: $(OUT)/things.vectors

test: $(OUT)/tests.parses.jsonl $(OUT)/tests.gold.jsonl
	jq -rn --slurpfile gold $(OUT)/tests.gold.jsonl --slurpfile parses $(OUT)/tests.parses.jsonl -f $(here)parse-score.jq

$(OUT)/marked.txt: $(MARKED)
	@mkdir -p $(@D)
	gzip -cdf $^ >$@

$(OUT)/tests.txt: $(TESTS)
	@mkdir -p $(@D)
	gzip -cdf $^ >$@

$(OUT)/%.jsonl: $(OUT)/%.txt
	$(tool)parse-train --sentences -o $@ $<

$(OUT)/%.safetensors: $(OUT)/%.jsonl
	$(tool)text-encode --model $(call quoted,BERT) -o $@ $<

$(OUT)/tests.gold.jsonl: $(OUT)/tests.txt $(OUT)/tests.safetensors
	$(tool)parse-train --parses --text $(OUT)/tests.safetensors -o $@ $<

$(OUT)/tests.parses.jsonl: $(OUT)/tests.safetensors $(PARSER)
	$(tool)text-parse $(if $(PARSER),--parser $(PARSER)) -o $@ $<

$(OUT)/parser.safetensors: $(OUT)/marked.txt $(OUT)/marked.safetensors
	$(tool)parse-train --seed $(SEED) --epochs $(EPOCHS) --members $(MEMBERS) --source "$(SOURCE)" --text $(OUT)/marked.safetensors -o $@ $<

# A sentence for each use in the table, whose object is its line.
$(OUT)/things.jsonl: $(here)../libcommon/lang/things.tsv
	@mkdir -p $(@D)
	jq -Rc '(input_line_number - 1) as $$n | split("\t")[1] | split("; ") | to_entries[] | {ref: "\($$n)-\(.key)", object: "\($$n)", text: .value, split: "test"}' $< >$@

$(OUT)/things.vectors: $(OUT)/things.safetensors
	fit_things $< $@
