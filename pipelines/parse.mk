# The weights of text-parse, from example sentences and, if given, from other people's readings.
#
#   make -f pipelines/parse.mk [READINGS=readings.jsonl READINGS_SENTENCES=sentences.jsonl] [OUT=work/parse]
#
# makes $(OUT)/parser.safetensors. `make -f pipelines/parse.mk folds` makes $(OUT)/folds.jsonl, parses of the readings'
# sentences by weights that saw no sentence of their room (FOLDS, 3), and $(OUT)/folds-blind.jsonl, the same without the grammar.
#
# EXAMPLES (20000) sentences, SEED (1), EPOCHS (4), MEMBERS (2) networks, SOURCE what the weights say that they were learnt from, BERT the encoder's folder.
OUT ?= work/parse
EXAMPLES ?= 20000
SEED ?= 1
EPOCHS ?= 4
MEMBERS ?= 2
FOLDS ?= 3
SOURCE ?= the example sentences of refersplat
BERT ?= $(HOME)/.cache/refersplat/encoder
LEARN = parse-train --seed $(SEED) --epochs $(EPOCHS) --members $(MEMBERS) $(if $(READINGS),--readings $(READINGS) --readings-text $(OUT)/readings.safetensors)
NEEDS = $(OUT)/examples.safetensors $(if $(READINGS),$(OUT)/readings.safetensors)

.DELETE_ON_ERROR:
.PHONY: all folds
all: $(OUT)/parser.safetensors
folds: $(OUT)/folds.jsonl $(OUT)/folds-blind.jsonl

$(OUT)/examples.jsonl:
	@mkdir -p $(@D)
	parse-train --seed $(SEED) --write $(EXAMPLES) -o $@

$(OUT)/examples.safetensors: $(OUT)/examples.jsonl
	text-encode --model $(BERT) -o $@ $<

$(OUT)/readings.safetensors: $(READINGS_SENTENCES)
	@mkdir -p $(@D)
	text-encode --model $(BERT) -o $@ $<

$(OUT)/parser.safetensors: $(NEEDS)
	$(LEARN) --source "$(SOURCE)" -o $@ $<

$(OUT)/folds.jsonl: $(NEEDS)
	$(LEARN) --folds $(FOLDS) -o $@ $<

$(OUT)/folds-blind.jsonl: $(NEEDS)
	$(LEARN) --folds $(FOLDS) --no-grammar -o $@ $<
