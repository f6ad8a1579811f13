# The fast workflow on one scene: import, weigh, encode, select in 3D, lift, render on the test views, locate, score. Nothing
# is trained.
#
#	make -f pipelines/lift.mk SCENE=work/desk SPLATS=point_cloud.ply CAMERAS=sparse/0 SENTENCES=sentences.jsonl \
#		CANDIDATES=candidates.jsonl TRUTH=truth.jsonl
#
# Or from one photograph whose things a person painted, without sentences; then `refer-ask work/desk "where is the kettle?"`:
#
#	make -f pipelines/lift.mk SCENE=work/desk SPLATS=point_cloud.ply CAMERAS=sparse/0 \
#		MASKS=input_0005.png NAMES=names.txt
#
# Or from sentences and photographs, where CANDIDATES is left out: all training sentences together say which regions they mean.
# Or from nothing but photographs: `regions` finds what may be things, by boxes where `make detector` was done, and says how to
# point at them, which makes the MASKS:
#
#	make -f pipelines/lift.mk regions SCENE=work/desk SPLATS=point_cloud.ply CAMERAS=sparse/0 IMAGES=images
#
# SCALE       size at which masks are looked at, as a share of the views'; default 0.3333
# ASK         more sentences to answer, JSON Lines; optional
# WHOLE       true masks of whole objects, to score those of --amodal against; optional
# BOXES       true boxes, to score those of refer-locate against; optional
# RENDER      more options for refer-render, of the predictions and of what is in ASK, with blanks between them
# DETECTOR    folder of the weights of box-detect, for regions; default: where `make detector` puts them
# WORDS       1: ends in words, a line for each way, in place of a table
# The other variables, and the folder's layout, are those of two-stage.mk; both workflows may use one folder where SCALE and
# WEIGH (here --packed --tolerance 0.05 by default) are the same.
#
# Targets: lifted (the model, boxes, and, where there are test views, predictions, overlays and, with TRUTH, scores), report (the
# same, and the page SCENE/report.html for a browser), regions, and those of two-stage.mk.

.DEFAULT_GOAL := lifted
SCALE ?= 0.3333
WEIGH ?= --packed --tolerance 0.05
more_files := ASK WHOLE BOXES
more := RENDER WORDS DETECTOR
include $(dir $(lastword $(MAKEFILE_LIST)))two-stage.mk

asked := $(if $(ASK),$(SCENE)/lifted/asked.jsonl)
answers := $(if $(TEST_VIEWS),$(foreach t,$(splits),$(SCENE)/lifted/predictions.$(t).jsonl) $(asked))
outlines := $(call flat,WHOLE,whole)
$(if $(and $(UNDISTORT),$(WHOLE)),$(eval $(call flatten,WHOLE,whole)))
whole := $(if $(WHOLE),$(SCENE)/lifted/whole.jsonl)
lifted_scores := $(if $(TRUTH),$(if $(MASKS)$(by_regions),,$(SCENE)/lifted/masks.score.json) $(answers:.jsonl=.score.json)) $(whole:.jsonl=.score.json) \
	$(if $(BOXES),$(SCENE)/lifted/boxes.score.json)

# What is typed to ask, for a shell, whatever is in the names.
typed = $(if $(call found_in,$(1)),$(call quote,$(1)),$(1))
typed_encoder := $(if $(filter-out file,$(origin BERT)), --encoder $(call typed,$(BERT)))
to_ask = to ask it: $(call typed,$(if $(BIN),$(BIN)/)refer-ask)$(typed_encoder) $(SCENE) 'where is the ...?'$(if $(WORDS), (all figures: $(here)report.sh $(SCENE)))

.PHONY: lifted
lifted: $(answers) $(whole) $(SCENE)/lifted/boxes.jsonl $(if $(TEST_VIEWS),$(SCENE)/lifted/overlays/complete) $(lifted_scores)
	@$(here)report.sh $(if $(WORDS),--words) $(SCENE)
	@$(if $(WORDS),,echo && )printf '%s\n' $(call quoted,to_ask)

# The steps.
ask3 = refer-render --scene $(SCENE)/scene --text $(1) --model $(model3)
$(foreach t,train test,$(eval command.render3.$(t) = $$(call ask3,$$(text)) --sentences $(t) $$(call options,RENDER) -o $(SCENE)/lifted/predictions.$(t).jsonl))
command.encode3 = text-encode --model $(call quoted,BERT) -o $(SCENE)/lifted/asked.safetensors $(ASK)
command.render3.asked = $(call ask3,$(SCENE)/lifted/asked.safetensors) $(call options,RENDER) -o $(asked)
command.render3.whole = $(call ask3,$(text)) --sentences test --amodal -o $(SCENE)/lifted/whole.jsonl
command.locate = refer-locate --scene $(SCENE)/scene --text $(text) --model $(model3) --sentences $(lastword $(splits)) \
	-o $(SCENE)/lifted/boxes.jsonl
command.overlay3 = $(call ask3,$(text)) --sentences $(lastword $(splits)) --overlay $(SCENE)/lifted/overlays -o $(SCENE)/lifted/overlays/masks.jsonl
command.score_whole = miou-score --json --quiet --predicted-views --truth $(outlines)
command.score_boxes = miou-score --boxes --json --quiet --truth $(BOXES)
$(call track,render3.train render3.test encode3 render3.asked render3.whole locate overlay3 score_whole score_boxes)

$(SCENE)/lifted/predictions.%.jsonl: $(model3) $(SCENE)/log/render3.%.command
	$(call run,render3.$*)

$(SCENE)/lifted/asked.safetensors: $(ASK) $(SCENE)/log/encode3.command
	@mkdir -p $(@D)
	$(call run,encode3)

$(SCENE)/lifted/asked.jsonl: $(SCENE)/lifted/asked.safetensors $(model3) $(SCENE)/log/render3.asked.command
	$(call run,render3.asked)

$(SCENE)/lifted/whole.jsonl: $(model3) $(SCENE)/log/render3.whole.command
	$(call run,render3.whole)

$(SCENE)/lifted/whole.score.json: $(SCENE)/lifted/whole.jsonl $(outlines) $(SCENE)/log/score_whole.command
	$(hide)$(tool)$(command.score_whole) -o $@ $<

$(SCENE)/lifted/boxes.jsonl: $(model3) $(SCENE)/log/locate.command
	$(call run,locate)

$(SCENE)/lifted/boxes.score.json: $(SCENE)/lifted/boxes.jsonl $(BOXES) $(SCENE)/log/score_boxes.command
	$(hide)$(tool)$(command.score_boxes) -o $@ $<

$(SCENE)/lifted/overlays/complete: $(model3) $(SCENE)/log/overlay3.command
	@mkdir -p $(@D)
	$(call run,overlay3)
	@touch $@

# Regions that may be things. DETECTOR is the folder of the weights of box-detect; without it photographs alone tell.
DETECTOR ?= $(wildcard $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/refersplat/detector)
boxes := $(if $(DETECTOR),$(SCENE)/boxes.jsonl)
labels := $(SCENE)/labels.jsonl
again = make -f $(called) SCENE=$(SCENE) SPLATS=$(SPLATS) $(if $(CAMERAS),CAMERAS=$(CAMERAS) )$(if $(IMAGES),IMAGES=$(IMAGES) )MASKS=$(labels)
pick = $(call typed,$(if $(BIN),$(BIN)/)mask-pick) --regions $(regions) --weights $(SCENE)/weights --point VIEW:x,y --name NAME $(SCENE)/scene >>$(labels)

.PHONY: regions
regions: $(regions)
	@printf '%s\n' $(call quote,to name a thing: $(pick)) $(call quote,to lift what is named: $(again))

command.detect = box-detect --model $(call quoted,DETECTOR) --scene $(SCENE)/scene -o $(boxes)
command.propose = pseudomask-propose --weights $(SCENE)/weights $(if $(boxes),--boxes $(boxes)) --regions $(regions) \
	-o $(SCENE)/regions.jsonl $(SCENE)/scene
$(call track,detect propose)

$(SCENE)/boxes.jsonl: $(scene) $(SCENE)/log/detect.command
	$(call run,detect)

$(regions): $(weights) $(boxes) $(SCENE)/log/propose.command
	$(call run,propose)
