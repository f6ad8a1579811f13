# The whole method on a small synthetic scene.
#
# DEMO        folder; default demo
# SEED        of the scene and the training; default 1
# ITERATIONS  steps of each stage; default 3000
# BERT, BIN   as in two-stage.mk

here := $(dir $(lastword $(MAKEFILE_LIST)))
DEMO ?= demo
SEED ?= 1
ITERATIONS ?= 3000
BIN ?= $(if $(wildcard $(here)../build/bin/gs-synth),$(abspath $(here)../build/bin))
data := $(DEMO)/data

.PHONY: demo
demo: $(data)/truth.jsonl
	@$(MAKE) --no-print-directory -f $(here)two-stage.mk SCENE=$(DEMO) SPLATS=$(data)/point_cloud.ply CAMERAS=$(data)/sparse/0 \
		IMAGES=$(data)/images TEST_VIEWS=$$(cat $(data)/test-views) SENTENCES=$(data)/sentences.jsonl \
		CANDIDATES=$(data)/candidates.jsonl TRUTH=$(data)/truth.jsonl SCALE=0.5 ITERATIONS=$(ITERATIONS) SEED=$(SEED) \
		$(if $(BIN),BIN=$(BIN)) $(if $(BERT),BERT=$(BERT))
	@echo
	@echo "photographs: $(data)/images"
	@echo "sentences:   $(data)/sentences.jsonl"
	@echo "masks drawn over the test views, a picture for each test sentence: $(DEMO)/stage2/overlays"

$(data)/truth.jsonl:
	$(if $(BIN),$(BIN)/)gs-synth --seed $(SEED) -o $(data)
