# The fast workflow on one scene: import, weigh, encode, select in 3D, lift, render on the test views, locate, score. Nothing
# is trained.
#
#	make -f pipelines/lift.mk SCENE=work/desk SPLATS=point_cloud.ply CAMERAS=sparse/0 SENTENCES=sentences.jsonl \
#		CANDIDATES=candidates.jsonl TRUTH=truth.jsonl
#
# SCALE       size at which masks are looked at, as a share of the views'; default 0.3333
# ASK         more sentences to answer, JSON Lines; optional
# WHOLE       true masks of whole objects, to score those of --amodal against; optional
# BOXES       true boxes, to score those of refer-locate against; optional
# LIFT        more options for refer-lift
# The other variables, and the folder's layout, are those of two-stage.mk; both workflows may use one folder where SCALE is
# the same.
#
# Targets: lifted (predictions, overlays, boxes and, with TRUTH, scores), and those of two-stage.mk.

.DEFAULT_GOAL := lifted
SCALE ?= 0.3333
WEIGH ?= --precision u8
include $(dir $(lastword $(MAKEFILE_LIST)))two-stage.mk

masks3 := $(SCENE)/lifted/masks.jsonl
model3 := $(SCENE)/lifted/model.safetensors
asked := $(if $(ASK),$(SCENE)/lifted/asked.jsonl)
answers := $(foreach t,train test,$(SCENE)/lifted/predictions.$(t).jsonl) $(asked)
whole := $(if $(WHOLE),$(SCENE)/lifted/whole.jsonl)
lifted_scores := $(if $(TRUTH),$(SCENE)/lifted/masks.score.json $(answers:.jsonl=.score.json)) $(whole:.jsonl=.score.json) \
	$(if $(BOXES),$(SCENE)/lifted/boxes.score.json)

.PHONY: lifted
lifted: $(answers) $(whole) $(SCENE)/lifted/boxes.jsonl $(SCENE)/lifted/overlays/complete $(lifted_scores)
	@$(here)report.sh $(SCENE)

$(masks3): $(CANDIDATES) $(weights)
	@mkdir -p $(dir $@)
	$(call run,$(SCENE)/log/select3d,pseudomask-select --scene $(SCENE)/scene --weights $(SCENE)/weights -o $@ $(CANDIDATES))

$(model3): $(masks3) $(weights) $(text)
	$(call run,$(SCENE)/log/lift,refer-lift --scene $(SCENE)/scene --weights $(SCENE)/weights --text $(text) --masks $< $(LIFT) -o $@)

ask3 = refer-render --scene $(SCENE)/scene --text $(1) --model $(model3)
$(SCENE)/lifted/predictions.%.jsonl: $(model3)
	$(call run,$(SCENE)/log/render3.$*,$(call ask3,$(text)) --sentences $* -o $@)

$(SCENE)/lifted/asked.safetensors: $(ASK)
	@mkdir -p $(dir $@)
	$(call run,$(SCENE)/log/encode3,text-encode --model $(BERT) -o $@ $(ASK))

$(SCENE)/lifted/asked.jsonl: $(SCENE)/lifted/asked.safetensors $(model3)
	$(call run,$(SCENE)/log/render3.asked,$(call ask3,$<) -o $@)

$(SCENE)/lifted/whole.jsonl: $(model3)
	$(call run,$(SCENE)/log/render3.whole,$(call ask3,$(text)) --sentences test --amodal -o $@)

$(SCENE)/lifted/whole.score.json: $(SCENE)/lifted/whole.jsonl $(WHOLE)
	$(tool)miou-score --json --quiet --predicted-views --truth $(WHOLE) -o $@ $<

$(SCENE)/lifted/boxes.jsonl: $(model3)
	$(call run,$(SCENE)/log/locate,refer-locate --scene $(SCENE)/scene --text $(text) --model $< --sentences test -o $@)

$(SCENE)/lifted/boxes.score.json: $(SCENE)/lifted/boxes.jsonl $(BOXES)
	$(tool)miou-score --boxes --json --quiet --truth $(BOXES) -o $@ $<

$(SCENE)/lifted/overlays/complete: $(model3)
	@mkdir -p $(dir $@)
	$(call run,$(SCENE)/log/overlay3,$(call ask3,$(text)) --sentences test --overlay $(SCENE)/lifted/overlays \
		-o $(SCENE)/lifted/overlays/masks.jsonl)
	@touch $@
