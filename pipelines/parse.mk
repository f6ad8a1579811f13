# The weights of text-parse, from example sentences, marked ones (formats/records/marked.md) and, if given, from other people's readings.
#
#   make -f pipelines/parse.mk [READINGS=readings.jsonl READINGS_SENTENCES=sentences.jsonl] [OUT=work/parse]
#
# makes $(OUT)/parser.safetensors. `make -f pipelines/parse.mk test` prints the shares of the marked sentences kept for testing that
# are taken apart rightly, by PARSER=weights or text-parse's own. `make -f pipelines/parse.mk folds` makes $(OUT)/folds.jsonl, parses of
# the readings' sentences by weights that saw no sentence of their room (FOLDS, 3), and $(OUT)/folds-blind.jsonl, the same without the grammar.
#
# `make -f pipelines/parse.mk things` makes $(OUT)/things.vectors, to become libcommon/lang/things.vectors, with build/bench/fit_things.
#
# EXAMPLES (20000) sentences, SEED (1), EPOCHS (4), MEMBERS (2) networks, MARKED and TESTS (pipelines/marked/learn/*.txt, .../test/*.txt), SOURCE
# what the weights say that they were learnt from, BERT the encoder's folder, BIN that of the tools.

here := $(dir $(lastword $(MAKEFILE_LIST)))
OUT ?= work/parse
EXAMPLES ?= 20000
SEED ?= 1
EPOCHS ?= 4
MEMBERS ?= 2
FOLDS ?= 3
MARKED ?= $(wildcard $(here)marked/learn/*.txt)
TESTS ?= $(wildcard $(here)marked/test/*.txt)
SOURCE ?= the example and marked sentences of refersplat
include $(here)common.mk
$(call check,,READINGS READINGS_SENTENCES OUT PARSER,EXAMPLES SEED EPOCHS MEMBERS FOLDS MARKED TESTS SOURCE BERT BIN)
LEARN = $(tool)parse-train --seed $(SEED) --epochs $(EPOCHS) --members $(MEMBERS) --marked $(OUT)/marked.txt --marked-text $(OUT)/marked.safetensors \
	$(if $(READINGS),--readings $(READINGS) --readings-text $(OUT)/readings.safetensors)
NEEDS = $(OUT)/examples.safetensors $(OUT)/marked.safetensors $(if $(READINGS),$(OUT)/readings.safetensors)

.PHONY: all folds test things
all: $(OUT)/parser.safetensors

help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(called)

folds: $(OUT)/folds.jsonl $(OUT)/folds-blind.jsonl
things: $(OUT)/things.vectors

test: $(OUT)/tests.parses.jsonl $(OUT)/tests.gold.jsonl
	jq -rn --slurpfile gold $(OUT)/tests.gold.jsonl --slurpfile parses $(OUT)/tests.parses.jsonl -f $(here)parse-score.jq

$(OUT)/marked.txt: $(MARKED)
	@mkdir -p $(@D)
	cat $^ >$@

$(OUT)/tests.txt: $(TESTS)
	@mkdir -p $(@D)
	cat $^ >$@

$(OUT)/%.jsonl: $(OUT)/%.txt
	$(tool)parse-train --marked $< --sentences -o $@

$(OUT)/%.safetensors: $(OUT)/%.jsonl
	$(tool)text-encode --model $(call quoted,BERT) -o $@ $<

$(OUT)/tests.gold.jsonl: $(OUT)/tests.txt $(OUT)/tests.safetensors
	$(tool)parse-train --marked $< --marked-text $(OUT)/tests.safetensors --parses -o $@

$(OUT)/tests.parses.jsonl: $(OUT)/tests.safetensors $(PARSER)
	$(tool)text-parse $(if $(PARSER),--parser $(PARSER)) -o $@ $<

$(OUT)/examples.jsonl:
	@mkdir -p $(@D)
	$(tool)parse-train --seed $(SEED) --write $(EXAMPLES) -o $@

$(OUT)/readings.safetensors: $(READINGS_SENTENCES)
	@mkdir -p $(@D)
	$(tool)text-encode --model $(call quoted,BERT) -o $@ $<

$(OUT)/parser.safetensors: $(NEEDS)
	$(LEARN) --source "$(SOURCE)" -o $@ $<

$(OUT)/folds.jsonl: $(NEEDS)
	$(LEARN) --folds $(FOLDS) -o $@ $<

$(OUT)/folds-blind.jsonl: $(NEEDS)
	$(LEARN) --folds $(FOLDS) --no-grammar -o $@ $<

# A sentence for each use in the table, whose object is its line.
$(OUT)/things.jsonl: $(here)../libcommon/lang/things.tsv
	@mkdir -p $(@D)
	jq -Rc '(input_line_number - 1) as $$n | split("\t")[1] | split("; ") | to_entries[] | {ref: "\($$n)-\(.key)", object: "\($$n)", text: .value, split: "test"}' $< >$@

$(OUT)/things.vectors: $(OUT)/things.safetensors
	fit_things $< $@
