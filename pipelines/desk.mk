# The workflows on a folder in the layout of the desk scene: point_cloud.ply, sparse/0, images, sentences.jsonl,
# candidates.jsonl, truth.jsonl. Targets: desk (two-stage.mk), lift (lift.mk) and
# field (trained fields, that learn what lift made and in the paper's way, with desk-field.sh).
#
# DATA        the folder (required)
# OUT         folder for everything that is made; default build/desk, and build/desk-lift for lift and field
# TEST_VIEWS  default input_0001,input_0009,input_0017,input_0025, the desk's
# SCALE       default 0.1667: training looks at a sixth of the photographs' size; 0.5 for lift
# ASK         of lift: default desk-relations.jsonl beside this file, sentences that say nothing but relations
# ITERATIONS  steps of each stage; default 45000
# TRAIN       options for refer-train; default --tolerance 0.01
# SEEDS       of field; default 1 2 3
# SEED, TEACH, TAUGHT, BERT, BIN   as in two-stage.mk

here := $(dir $(lastword $(MAKEFILE_LIST)))
TEST_VIEWS ?= input_0001,input_0009,input_0017,input_0025
ITERATIONS ?= 45000
ASK ?= $(here)desk-relations.jsonl
TRAIN ?= --tolerance 0.01
SEEDS ?= 1 2 3
field: TAUGHT ?= 200
include $(here)common.mk
# The workflow gets what is said below, and nothing else.
MAKEOVERRIDES :=
$(call check,DATA,DATA OUT ASK,TEST_VIEWS SCALE ITERATIONS TRAIN SEED SEEDS TEACH TAUGHT BERT BIN)

help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(called)

.PHONY: desk lift field
.DEFAULT_GOAL := desk
desk: OUT ?= build/desk
desk: SCALE ?= 0.1667
lift field: OUT ?= build/desk-lift
lift field: SCALE ?= 0.5
# What both workflows are given. $(call flow,FILE)
flow = @$(MAKE) --no-print-directory -f $(here)$(1) SCENE=$(OUT) SPLATS=$(DATA)/point_cloud.ply CAMERAS=$(DATA)/sparse/0 \
	IMAGES=$(DATA)/images TEST_VIEWS=$(call quoted,TEST_VIEWS) SENTENCES=$(DATA)/sentences.jsonl \
	CANDIDATES=$(DATA)/candidates.jsonl TRUTH=$(DATA)/truth.jsonl SCALE=$(call quoted,SCALE) \
	$(if $(SEED),SEED=$(call quoted,SEED)) $(if $(TEACH),TEACH=$(call quoted,TEACH)) $(if $(TAUGHT),TAUGHT=$(call quoted,TAUGHT)) BERT=$(call quoted,BERT) BIN=$(call quoted,BIN)

desk:
	$(call flow,two-stage.mk) ITERATIONS=$(call quoted,ITERATIONS) TRAIN=$(call quoted,TRAIN)

lift:
	$(call flow,lift.mk) ASK=$(ASK)

field: lift
	@TOOLS=$(tool) OUT=$(OUT) SENTENCES=$(DATA)/sentences.jsonl CANDIDATES=$(DATA)/candidates.jsonl TRUTH=$(DATA)/truth.jsonl SEEDS=$(call quoted,SEEDS) \
		TAUGHT=$(call quoted,TAUGHT) BERT=$(call quoted,BERT) $(here)desk-field.sh
