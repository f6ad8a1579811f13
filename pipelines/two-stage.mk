# The two-stage workflow on one scene: import, weigh, encode, select, train, render on the training views, train again on
# those masks, render on the test views, score.
#
#	make -f pipelines/two-stage.mk SCENE=work/desk SPLATS=point_cloud.ply CAMERAS=sparse/0 SENTENCES=sentences.jsonl \
#		CANDIDATES=candidates.jsonl TRUTH=truth.jsonl
#
# SCENE       folder for everything that is made (required)
# SPLATS      trained scene, a 3DGS .ply (required)
# CAMERAS     COLMAP model, 3DGS cameras.json or transforms.json; default: what gs-import finds beside SPLATS
# IMAGES      folder of the photographs; optional
# TEST_VIEWS  test views as gs-import takes them: NAME,... or every:N; default every:8
# SENTENCES   sentences, JSON Lines (required)
# CANDIDATES  candidate masks, JSON Lines (required)
# TRUTH       true masks to score against; optional
# BERT        folder of the language encoder; default: where `make encoder` puts it
# SCALE       size at which training looks at the views, as a share of theirs; default 0.25
# ITERATIONS  steps of each stage; default 45000
# SEED        default 1
# SELECT, WEIGH, TRAIN   more options for pseudomask-select, gs-weigh, refer-train
# BIN         folder of the tools; default: build/bin of this checkout, or the PATH where that is not there
#
# Targets: all (predictions, overlays and, with TRUTH, scores), predictions, overlays, scores, report.
# Every file is made under its own name, so that a second make does nothing and a change remakes what depends on it.
# A training that was cut off goes on from its checkpoint.

here := $(dir $(lastword $(MAKEFILE_LIST)))
BIN ?= $(if $(wildcard $(here)../build/bin/refer-train),$(abspath $(here)../build/bin))
tool = $(if $(BIN),$(BIN)/)
BERT ?= $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/refersplat/encoder
TEST_VIEWS ?= every:8
SCALE ?= 0.25
ITERATIONS ?= 45000
SEED ?= 1

# Threads that wait for one another give their processor to other programs.
export OMP_WAIT_POLICY ?= passive

ifeq ($(filter help clean,$(MAKECMDGOALS)),)
$(foreach v,SCENE SPLATS SENTENCES CANDIDATES,$(if $($(v)),,$(error $(v) is not set; see the head of pipelines/two-stage.mk)))
endif

cameras := $(if $(CAMERAS),$(if $(wildcard $(CAMERAS)/.),$(wildcard $(CAMERAS)/*),$(CAMERAS)))
scene := $(SCENE)/scene/cameras.json
weights := $(SCENE)/weights/complete
text := $(SCENE)/text.safetensors
masks1 := $(SCENE)/stage1/masks.jsonl
masks2 := $(SCENE)/stage2/masks.jsonl
model1 := $(SCENE)/stage1/model.safetensors
model2 := $(SCENE)/stage2/model.safetensors
predictions := $(foreach s,1 2,$(foreach t,train test,$(SCENE)/stage$(s)/predictions.$(t).jsonl))
overlays := $(SCENE)/stage1/overlays/complete $(SCENE)/stage2/overlays/complete
scores := $(if $(TRUTH),$(predictions:$(SCENE)/%.jsonl=$(SCENE)/%.score.json) $(SCENE)/stage1/masks.score.json $(SCENE)/stage2/masks.score.json)

.PHONY: all predictions overlays scores report help
.DELETE_ON_ERROR:
.SECONDARY:
all: predictions overlays scores
	@$(if $(TRUTH),$(MAKE) --no-print-directory -f $(firstword $(MAKEFILE_LIST)) report)
predictions: $(predictions)
overlays: $(overlays)
scores: $(scores)

help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(lastword $(MAKEFILE_LIST))

# Runs a tool with -v: its last line, time and memory, is kept beside the result for the report.
# $(call run,LOG,COMMAND)
run = mkdir -p $(dir $(1)) && $(tool)$(2) -v 2>$(1) || { cat $(1) >&2; exit 1; }

$(scene): $(SPLATS) $(cameras)
	$(call run,$(SCENE)/log/import,gs-import $(if $(CAMERAS),--cameras $(CAMERAS)) $(if $(IMAGES),--images $(IMAGES)) \
		--test-views $(TEST_VIEWS) -o $(SCENE)/scene $(SPLATS))

$(weights): $(scene)
	$(call run,$(SCENE)/log/weigh,gs-weigh --scale $(SCALE) $(WEIGH) -o $(SCENE)/weights $(SCENE)/scene)
	@touch $@

$(text): $(SENTENCES)
	$(call run,$(SCENE)/log/encode,text-encode --model $(BERT) -o $@ $(SENTENCES))

# A way of selecting that looks at the scene has to wait for it.
$(masks1): $(CANDIDATES) $(if $(findstring --weights,$(SELECT)),$(weights))
	@mkdir -p $(dir $@)
	$(call run,$(SCENE)/log/select,pseudomask-select $(SELECT) -o $@ $(CANDIDATES))

$(SCENE)/stage%/model.safetensors: $(SCENE)/stage%/masks.jsonl $(weights) $(text)
	$(call run,$(SCENE)/log/train$*,refer-train --scene $(SCENE)/scene --weights $(SCENE)/weights --text $(text) --masks $< \
		--iterations $(ITERATIONS) --seed $(SEED) --resume --log $(SCENE)/stage$*/train.log $(TRAIN) -o $@)

# What stage 1 answers in the training views teaches stage 2.
$(masks2): $(model1)
	@mkdir -p $(dir $@)
	$(call run,$(SCENE)/log/teach,refer-render --scene $(SCENE)/scene --text $(text) --model $< --split train --sentences train \
		--scale $(SCALE) -o $@)

$(SCENE)/stage1/predictions.%.jsonl: $(model1)
	$(call run,$(SCENE)/log/render1.$*,refer-render --scene $(SCENE)/scene --text $(text) --model $< --sentences $* -o $@)

$(SCENE)/stage2/predictions.%.jsonl: $(model2)
	$(call run,$(SCENE)/log/render2.$*,refer-render --scene $(SCENE)/scene --text $(text) --model $< --sentences $* -o $@)

$(SCENE)/stage%/overlays/complete: $(SCENE)/stage%/model.safetensors
	@mkdir -p $(dir $@)
	$(call run,$(SCENE)/log/overlay$*,refer-render --scene $(SCENE)/scene --text $(text) --model $< --sentences test \
		--overlay $(SCENE)/stage$*/overlays -o $(SCENE)/stage$*/overlays/masks.jsonl)
	@touch $@

$(SCENE)/%.score.json: $(SCENE)/%.jsonl $(TRUTH)
	$(tool)miou-score --json --quiet --predicted-views --truth $(TRUTH) -o $@ $<

report: $(scores)
	@$(here)report.sh $(SCENE)
