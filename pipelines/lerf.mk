# The benchmarks of the field, from their folders as they unpack: Ref-LERF's referring sentences, and the names of LERF-OVS and 3D-OVS.
#
#	make -f pipelines/lerf.mk ref-lerf DATA=ref-lerf/ramen SPLATS=output/ramen TEST_VIEWS=frame_00006,frame_00024
#	make -f pipelines/lerf.mk lerf-ovs DATA=lerf_ovs/ramen LABELS=lerf_ovs/label/ramen SPLATS=output/ramen \
#		CANDIDATES=candidates.jsonl
#	make -f pipelines/lerf.mk 3d-ovs DATA=3d_ovs/sofa SPLATS=output/sofa CANDIDATES=candidates.jsonl
#
# DATA        the scene's folder: sparse/0 and images; of Ref-LERF also json/VIEW.json and gt_mask, of
#             3D-OVS segmentations with classes.txt and VIEW/CLASS.png (required)
# SPLATS      the scene that 3DGS has trained: its folder or a .ply (required)
# LABELS      of LERF-OVS: the folder with the labels VIEW.json of the scene's test views (required there)
# CANDIDATES  masks of a detector in the training views, JSON Lines; their objects are categories or classes. Required but for Ref-LERF, whose
#             default is the masks that it has of training views
# TEST_VIEWS  of Ref-LERF: names of the test views. Default for a DATA that ends in waldo_kitchen: those of the paper's program.
#             The others' are those with labels
# QUESTIONS   more sentences, JSON Lines, which may mean one thing, several or none: key objects, names as the labels have them; optional
# PEAK        of LERF-OVS: pixels of a side of the window in which localisation averages; default 30, as LangSplat has it, for pictures of 988x731; LERF: 1
# OUT         folder for everything that is made; default build/lerf/ and the target and the scene's name
# SCALE, BERT, BIN   as in lift.mk
#
# Each runs lift.mk, scores its answers in OUT/score.json, and prints mIoU and the published figures of the benchmark, for all of its scenes together.
# Ref-LERF: mIoU over the test views' own sentences, empty truths left out; a sentence's mask is its own, and no sentence of a test
# view is learnt from unless a training view has it too. LERF-OVS: mIoU over the labels of all test views, shapes of one
# category together; a query is the category's name. Published figures there are of two kinds: a threshold on the relevancy of each pixel (2D), or
# Gaussians selected and rendered (3D), which is what these tools do. Localisation is of the pixel around which the rendered responses
# of PEAK x PEAK pixels are largest, in a box of the labels or in their mask. 3D-OVS: mIoU of its
# classes, each by itself: no class is told from the others in a pixel.
# QUESTIONS are scored in OUT/questions.json as Multi3DRefer and GRES score them (miou-score --answers), against the true masks of objects.

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)common.mk
# The workflow gets what is said below, and nothing else.
MAKEOVERRIDES :=
benchmark := $(or $(filter ref-lerf lerf-ovs 3d-ovs,$(MAKECMDGOALS)),ref-lerf)
$(call check,DATA SPLATS $(if $(filter lerf-ovs,$(benchmark)),LABELS) $(if $(filter ref-lerf,$(benchmark)),,CANDIDATES),DATA SPLATS LABELS CANDIDATES QUESTIONS OUT,PEAK TEST_VIEWS SCALE BERT BIN)
name := $(notdir $(patsubst %/,%,$(DATA)))
PEAK ?= 30
OUT ?= build/lerf/$(benchmark)/$(name)
kitchen := frame_00019,frame_00035,frame_00067,frame_00105,frame_00162
TEST_VIEWS ?= $(if $(filter waldo_kitchen,$(name)),$(kitchen))
segmentations := $(patsubst %/,%,$(DATA))/segmentations
labels := $(if $(filter 3d-ovs,$(benchmark)),$(if $(wildcard $(segmentations)/classes.txt),$(segmentations)),$(wildcard $(LABELS)/*.json))
said := $(wildcard $(DATA)/json/*.json)
$(if $(filter help clean,$(MAKECMDGOALS)),,$(if $(filter lerf-ovs 3d-ovs,$(benchmark)),$(if $(labels),,$(error $(if $(filter \
	3d-ovs,$(benchmark)),$(segmentations) has no classes.txt,$(LABELS) has no labels VIEW.json))),$(if \
	$(said),,$(error $(DATA) has no json/VIEW.json))$(if $(TEST_VIEWS),,$(error $(called): TEST_VIEWS not set; 'make -f $(called) help' says what they are))))
made := $(OUT)/benchmark

.DEFAULT_GOAL := help
.PHONY: ref-lerf lerf-ovs 3d-ovs
help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(called)

# $(call flow,TEST VIEWS,MASKS)
flow = @$(MAKE) --no-print-directory -f $(here)lift.mk SCENE=$(OUT) SPLATS=$(SPLATS) CAMERAS=$(DATA)/sparse/0 IMAGES=$(DATA)/images \
	TEST_VIEWS=$(1) SENTENCES=$(made)/sentences.jsonl $(2) $(if $(QUESTIONS),ASK=$(QUESTIONS)) $(if $(filter lerf-ovs,$(benchmark)),RENDER=$(call quote,--peak $(PEAK))) $(if $(SCALE),SCALE=$(call \
	quoted,SCALE)) BERT=$(call quoted,BERT) BIN=$(call quoted,BIN)
# Truth is of the test views alone, so only what is answered there is scored.
score = @$(tool)miou-score --json --quiet --predicted-views --truth $(made)/truth.jsonl -o $(OUT)/score.json $(OUT)/lifted/predictions.test.jsonl && \
	printf '\n%s: mIoU %.1f in test views (%s/score.json)\n' '$(name)' "$$(jq '100 * .miou' $(OUT)/score.json)" '$(OUT)'$(if $(filter lerf-ovs,$(1)),$(localisation))
localisation = && jq -r '"localisation: in a box \(.peak_in_box // 0 | 1000 * . | round / 10), in the mask \(.peak_in_mask // 0 | 1000 * . | round / 10)"' $(OUT)/score.json
# One, several or none of the objects: the table of miou-score, but for kinds, with the names that GRES has for its figures.
questions = $(if $(QUESTIONS),@$(tool)miou-score --answers --quiet --json --predicted-views --sentences $(QUESTIONS) --truth $(1) -o $(OUT)/questions.json \
	$(OUT)/lifted/asked.jsonl && echo && jq -r -f $(here)lerf-questions.jq $(OUT)/questions.json)
# $(call published,WHAT IT IS,TABLE)
published = @printf '\nPublished %s, mean over its scenes:\n' '$(1)' && awk -F '\t' '$$1 == "row" && $$2 == "$(2)" { printf "  %-28s %s\n", $$4, $$5 }' \
	$(here)published.tsv

ref-lerf: $(made)/sentences.jsonl $(made)/masks.jsonl $(made)/truth.jsonl $(if $(QUESTIONS),$(made)/objects.jsonl)
	$(call flow,$(call quoted,TEST_VIEWS),$(if $(CANDIDATES),CANDIDATES=$(CANDIDATES),MASKS=$(made)/masks.jsonl))
	$(call score,ref-lerf)
	$(call questions,$(made)/objects.jsonl)
	$(call published,mIoU on Ref-LERF,ref-lerf)

command.views = $(TEST_VIEWS)
SCENE := $(OUT)
$(call track,views)
ifeq ($(benchmark),ref-lerf)
$(OUT)/log/views.command: FORCE
	@mkdir -p $(@D) && printf '%s' $(call quoted,command.views) | cmp -s - $@ || printf '%s' $(call quoted,command.views) >$@
# Records name masks in their own folder: a link there leads to the data's.
gt_mask = $(abspath $(DATA))/gt_mask
$(foreach w,sentences masks truth,$(made)/$(w).jsonl): $(made)/%.jsonl: $(said) $(OUT)/log/views.command $(here)ref-lerf.jq
	@mkdir -p $(@D) && ln -sfn $(call quoted,gt_mask) $(@D)/gt_mask
	@jq -n -c --arg what $* --arg test $(call quoted,TEST_VIEWS) --arg masks gt_mask -f $(here)ref-lerf.jq $(said) >$@
# Masks of objects whatever the sentence, for questions.
$(made)/objects.jsonl: $(said) $(OUT)/log/views.command
	@mkdir -p $(@D)
	$(tool)mask-import --quiet -o $@.all $(said) && \
		jq -c --arg test $(call quoted,TEST_VIEWS) 'select(.view as $$v | $$test | split(",") | index($$v))' $@.all >$@ && rm $@.all
else
# Names of classes have blanks, so of 3D-OVS's pictures a list of their times is watched.
$(made)/segmentations: FORCE
	@mkdir -p $(@D) && find $(segmentations)/ -type f -printf '%p %T@\n' | LC_ALL=C sort >$@.new && if cmp -s $@.new $@; then rm $@.new; else mv $@.new $@; fi
$(made)/truth.jsonl: $(if $(filter 3d-ovs,$(benchmark)),$(made)/segmentations,$(labels))
	@mkdir -p $(@D)
	$(tool)mask-import --quiet -o $@ $(labels)
# Each category trains, as the name of its candidates, and is asked for.
$(made)/sentences.jsonl: $(made)/truth.jsonl
	@jq -s -c 'map(.object) | unique[] | {ref: "\(.) name", object: ., text: ., split: "train"}, {ref: "\(.) query", object: ., text: ., split: "test"}' $< >$@
$(made)/test-views: $(made)/truth.jsonl
	@jq -s -r 'map(.view) | unique | join(",")' $< >$@
endif

lerf-ovs 3d-ovs: $(made)/sentences.jsonl $(made)/truth.jsonl $(made)/test-views
	$(call flow,"$$(cat $(made)/test-views)",CANDIDATES=$(CANDIDATES))
	$(call score,$@)
	$(call questions,$(made)/truth.jsonl)
	$(if $(filter lerf-ovs,$@),$(call published,mIoU on LERF-OVS (2D: a threshold in each pixel),lerf-ovs),$(call published,mIoU on 3D-OVS,3d-ovs))
	$(if $(filter lerf-ovs,$@),$(call published,mIoU on LERF-OVS (3D: Gaussians are selected and rendered),lerf-ovs-3d))
	$(if $(filter lerf-ovs,$@),$(call published,localisation accuracy on LERF-OVS,lerf-ovs-loc))
