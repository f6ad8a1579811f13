# The whole method on a small synthetic scene: both stages of training, and the answers without training.
#
# DEMO        folder; default demo
# SEED        of the scene and the training; default 1
# SYNTH       more options for gs-synth: "--objects 4 --gaussians 50000", say; with other ones, or another SEED, the data are
#             made anew, and all that depends on them
# ITERATIONS  steps of each stage; default 3000
# SCALE       as in two-stage.mk; default 0.5
# TRAIN       more options for refer-train
# TEACH, BERT, BIN   as in two-stage.mk

here := $(dir $(lastword $(MAKEFILE_LIST)))
DEMO ?= demo
SEED ?= 1
ITERATIONS ?= 3000
SCALE ?= 0.5
include $(here)common.mk
# The workflow gets what is said below, and nothing else.
MAKEOVERRIDES :=
$(call check,DEMO,DEMO,SEED SYNTH ITERATIONS SCALE TRAIN TEACH BERT BIN)
data := $(DEMO)/data
make_data = gs-synth --seed $(call quoted,SEED) $(call options,SYNTH) -o $(data)

help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(called)

.PHONY: demo
.DEFAULT_GOAL := demo
page = all of it on one page; open in a browser: file://$(abspath $(DEMO))/report.html
demo: $(data)/made-by
	@$(MAKE) --no-print-directory -f $(here)lift.mk predictions overlays scores lifted WORDS=1 SCENE=$(DEMO) SPLATS=$(data)/point_cloud.ply \
		CAMERAS=$(data)/sparse/0 IMAGES=$(data)/images TEST_VIEWS="$$(cat $(data)/test-views)" SENTENCES=$(data)/sentences.jsonl \
		CANDIDATES=$(data)/candidates.jsonl TRUTH=$(data)/truth.jsonl WHOLE=$(data)/whole.jsonl BOXES=$(data)/boxes.jsonl \
		SCALE=$(call quoted,SCALE) ITERATIONS=$(call quoted,ITERATIONS) SEED=$(call quoted,SEED) \
		$(if $(TRAIN),TRAIN=$(call quoted,TRAIN)) $(if $(TEACH),TEACH=$(call quoted,TEACH)) BIN=$(call quoted,BIN) BERT=$(call quoted,BERT)
	@$(tool)refer-report --truth $(data)/truth.jsonl $(DEMO)
	@printf '%s\n' $(call quoted,page)

# The command that made the data, once they are whole. They stay as they are while it is the same.
$(data)/made-by: $(if $(call same,$(file <$(data)/made-by),$(make_data)),,FORCE)
	@rm -f $@ && printf '%s\n' $(call quote,$(make_data)) && $(tool)$(make_data) && printf %s $(call quote,$(make_data)) >$@
