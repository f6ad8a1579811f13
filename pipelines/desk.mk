# The two-stage workflow on a folder in the layout of the desk scene: point_cloud.ply, sparse/0, images, sentences.jsonl,
# candidates.jsonl, truth.jsonl.
#
# DATA        the folder (required)
# OUT         folder for everything that is made; default build/desk
# TEST_VIEWS  default input_0001,input_0009,input_0017,input_0025, the desk's
# SCALE       default 0.1667: training looks at a sixth of the photographs' size
# ITERATIONS  steps of each stage; default 45000
# TRAIN       options for refer-train; default --tolerance 0.01
# SEED, BERT, BIN   as in two-stage.mk

here := $(dir $(lastword $(MAKEFILE_LIST)))
OUT ?= build/desk
TEST_VIEWS ?= input_0001,input_0009,input_0017,input_0025
SCALE ?= 0.1667
ITERATIONS ?= 45000
TRAIN ?= --tolerance 0.01

.PHONY: desk
desk:
	$(if $(DATA),,$(error DATA is not set; see the head of pipelines/desk.mk))
	@$(MAKE) --no-print-directory -f $(here)two-stage.mk SCENE=$(OUT) SPLATS=$(DATA)/point_cloud.ply CAMERAS=$(DATA)/sparse/0 \
		IMAGES=$(DATA)/images TEST_VIEWS=$(TEST_VIEWS) SENTENCES=$(DATA)/sentences.jsonl \
		CANDIDATES=$(DATA)/candidates.jsonl TRUTH=$(DATA)/truth.jsonl SCALE=$(SCALE) ITERATIONS=$(ITERATIONS) \
		TRAIN="$(TRAIN)" $(if $(SEED),SEED=$(SEED)) $(if $(BERT),BERT=$(BERT)) $(if $(BIN),BIN=$(BIN))
