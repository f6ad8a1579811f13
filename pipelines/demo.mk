# The whole method on a small synthetic scene: both stages of training, and the answers without training.
#
# DEMO        folder; default demo
# SEED        of the scene and the training; default 1
# SYNTH       more options for gs-synth: "--objects 4 --gaussians 50000", say; with other ones, or another SEED, the data are
#             made anew, and all that depends on them
# ITERATIONS  steps of each stage; default 3000
# SCALE       as in two-stage.mk; default 0.5
# TRAIN       more options for refer-train
# BERT, BIN   as in two-stage.mk

here := $(dir $(lastword $(MAKEFILE_LIST)))
DEMO ?= demo
SEED ?= 1
ITERATIONS ?= 3000
SCALE ?= 0.5
BIN ?= $(if $(wildcard $(here)../build/bin/gs-synth),$(abspath $(here)../build/bin))
data := $(DEMO)/data
make_data := gs-synth --seed $(SEED)$(if $(SYNTH), $(SYNTH))

.PHONY: demo FORCE
demo: $(data)/made-by
	@$(MAKE) --no-print-directory -f $(here)lift.mk predictions overlays scores lifted SCENE=$(DEMO) SPLATS=$(data)/point_cloud.ply CAMERAS=$(data)/sparse/0 \
		IMAGES=$(data)/images TEST_VIEWS=$$(cat $(data)/test-views) SENTENCES=$(data)/sentences.jsonl \
		CANDIDATES=$(data)/candidates.jsonl TRUTH=$(data)/truth.jsonl WHOLE=$(data)/whole.jsonl BOXES=$(data)/boxes.jsonl SCALE=$(SCALE) ITERATIONS=$(ITERATIONS) SEED=$(SEED) \
		$(if $(TRAIN),TRAIN="$(TRAIN)") \
		$(if $(BIN),BIN=$(BIN)) $(if $(BERT),BERT=$(BERT))
	@echo
	@echo "photographs: $(data)/images"
	@echo "sentences:   $(data)/sentences.jsonl"
	@echo "masks drawn over the test views, a picture for each test sentence: $(DEMO)/lifted/overlays (without training),"
	@echo "             $(DEMO)/stage2/overlays (trained as in the paper)"
	@echo "where the things are in space: $(DEMO)/lifted/boxes.jsonl"

# The command that made the data, once they are whole. They stay as they are while it is the same.
$(data)/made-by: FORCE
	@[ "$$(cat $@ 2>/dev/null)" = "$(make_data)" ] || { rm -f $@ && echo "$(make_data) -o $(data)" && \
		$(if $(BIN),$(BIN)/)$(make_data) -o $(data) && echo "$(make_data)" >$@; }
