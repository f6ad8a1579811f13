# The two-stage workflow on one scene: import, weigh, encode, select, train, render masks of the training views, train again on
# those masks, render on the test views, score.
#
#	make -f pipelines/two-stage.mk SCENE=work/desk SPLATS=point_cloud.ply CAMERAS=sparse/0 SENTENCES=sentences.jsonl \
#		CANDIDATES=candidates.jsonl TRUTH=truth.jsonl
#
# SCENE       folder for everything that is made (required)
# SPLATS      trained scene, a 3DGS .ply or the folder that 3DGS wrote (required)
# CAMERAS     COLMAP model, 3DGS cameras.json or transforms.json; default: what gs-import finds beside SPLATS
# IMAGES      folder of the photographs; optional
# UNDISTORT   1 where the photographs' lenses distort, and CANDIDATES, MASKS and TRUTH are drawn on the photographs: the views are
#             pinholes, as gs-import --undistort makes them, and so are all masks. Mask records then end in .jsonl
# TEST_VIEWS  test views as gs-import takes them: NAME,... or every:N; default every:8, and none with MASKS
# SENTENCES   sentences, JSON Lines (required, but with MASKS)
# CANDIDATES  candidate masks, JSON Lines (required, but with MASKS)
# MASKS       masks that a person drew, in place of CANDIDATES: JSON of LabelMe, COCO or a detector (Grounded-SAM-2), or a folder of
#             such; pictures, with NAMES; a folder of VIEW/NAME.png; or mask records, JSON Lines. They keep their names, whatever SENTENCES say. Where SENTENCES is not given, the
#             names of the things are the sentences. A PNG that mask records name is not watched for changes
# NAMES       what the colours of MASKS mean, as mask-import takes it: MASKS is then a painted photograph, a PNG with the name
#             of its view, or a folder of such
# TRUTH       true masks to score against; optional
# BERT        folder of the language encoder; default: where `make encoder` puts it
# SCALE       size at which training looks at the views, as a share of theirs; default 0.25
# ITERATIONS  steps of each stage; default 45000
# SEED        default 1
# TEACH       who teaches stage 2: stage1, whose masks of the training views it learns from, as in the paper; or lifted, the objects
#             that are lifted from masks selected in 3D; default lifted, which pipelines/ablation.md shows to be better
# TAUGHT      sentences of each thing that refer-say writes for a stage 2 that is taught by lifted objects, which learns these objects
#             by parses, in 2500 steps at most; default 200. 0: it learns their masks of the training views, as from stage1
# SELECT, WEIGH, LIFT, TRAIN   more options for pseudomask-select, gs-weigh, refer-lift, refer-train, with blanks between them
# BIN         folder of the tools; default: build/bin of this checkout, or the PATH where that is not there
# V           1 prints the commands too
#
# Targets: all (predictions, overlays and, with TRUTH, scores), predictions, overlays, scores, report (scores and times, and the
# page SCENE/report.html of what is there, for a browser).
# Every file is made under its own name, so that a second make does nothing, and a changed input or variable remakes what
# depends on it. A training that was cut off goes on from its checkpoint, unless something that it learns from changed: then
# it starts anew. Names of files and folders may not have blanks or characters that make or the shell give a meaning.

here := $(dir $(lastword $(MAKEFILE_LIST)))
TEST_VIEWS ?= $(if $(MASKS)$(filter regions,$(MAKECMDGOALS)),,every:8)
SCALE ?= 0.25
ITERATIONS ?= 45000
SEED ?= 1
TEACH ?= lifted
TAUGHT ?= 200
include $(here)common.mk
$(foreach v,MASKS SENTENCES CANDIDATES,$(call take,$(v)))
# How the things may be given, for whoever has given none.
define ways
$(if $(MASKS),,; the things to find are named in one of four ways:
  MASKS=frame_00041.png NAMES=names.txt           no masks yet: paint each thing of one photograph in a colour of its own, and list colours and names
  MASKS=labels.json                               labels of LabelMe or COCO, or the JSON of a detector such as Grounded-SAM-2; no sentences needed
  SENTENCES=s.jsonl CANDIDATES=candidates.jsonl   sentences, and the masks that a detector found for them
  make -f pipelines/lift.mk regions ...           nothing at all: finds what may be things, and says how to name them by a click
for example: make -f $(called) SCENE=work/kitchen SPLATS=point_cloud.ply CAMERAS=sparse/0 MASKS=labels.json)
endef
# Of lift.mk, where sentences and photographs are all there is: regions that the sentences name.
by_regions := $(and $(filter lifted,$(.DEFAULT_GOAL)),$(SENTENCES),$(IMAGES),$(if $(CANDIDATES)$(MASKS),,1))
$(call check,SCENE SPLATS $(if $(by_regions),SENTENCES,$(if $(SENTENCES)$(CANDIDATES),$(if $(MASKS),,SENTENCES CANDIDATES),$(if $(filter regions,$(MAKECMDGOALS)),,MASKS))),SCENE SPLATS CAMERAS SENTENCES CANDIDATES MASKS NAMES TRUTH $(more_files),IMAGES TEST_VIEWS BERT SCALE \
	ITERATIONS SEED TEACH TAUGHT SELECT WEIGH LIFT TRAIN BIN UNDISTORT $(more))
$(if $(filter stage1 lifted,$(TEACH)),,$(error $(called): TEACH is '$(TEACH)', and stage1 or lifted are what it can be))

# Of a folder of 3DGS the last iteration, as gs-import takes it.
splats := $(if $(wildcard $(SPLATS)/.),$(or $(shell ls -d $(SPLATS)/point_cloud/iteration_*/point_cloud.ply $(SPLATS)/iteration_*/point_cloud.ply \
	2>/dev/null | sort -V | tail -n 1),$(wildcard $(SPLATS)/point_cloud.ply),$(SPLATS)),$(SPLATS))
beside := $(patsubst %/,%,$(dir $(splats)))
cameras := $(if $(CAMERAS),$(if $(wildcard $(CAMERAS)/.),$(call camera_files,$(CAMERAS)),$(CAMERAS)),$(or $(call \
	camera_files,$(beside)),$(if $(filter iteration_%,$(notdir $(beside))),$(call camera_files,$(beside)/../..)))) $(wildcard $(beside)/dataparser_transforms.json)
$(if $(CAMERAS)$(strip $(cameras))$(filter help clean,$(MAKECMDGOALS)),,$(error $(called): CAMERAS not set, and no cameras beside $(splats): name a COLMAP model \
	(the folder sparse/0), cameras.json of 3DGS or transforms.json of nerfstudio))
scene := $(SCENE)/scene/cameras.json
weights := $(SCENE)/weights/complete
# Mask records of a variable as the views see them. $(call flat,VARIABLE,NAME)
flat = $(if $($(1)),$(if $(UNDISTORT),$(SCENE)/undistorted/$(2).jsonl,$($(1))))
candidates := $(call flat,CANDIDATES,candidates)
truth := $(call flat,TRUTH,truth)
text := $(SCENE)/text.safetensors
# Photographs that a person painted, with NAMES, or labelled, as JSON.
labelled := $(or $(wildcard $(MASKS)/*.json),$(filter %.json,$(MASKS)))
painted := $(if $(MASKS),$(or $(labelled),$(if $(NAMES),$(or $(wildcard $(MASKS)/*.png),$(MASKS))),$(if $(UNDISTORT)$(wildcard $(MASKS)/.),$(MASKS))))
drawn := $(if $(painted),$(SCENE)/painted.jsonl,$(MASKS))
masks1 := $(or $(drawn),$(SCENE)/stage1/masks.jsonl)
masks2 := $(SCENE)/stage2/masks.jsonl
masks3 := $(or $(drawn),$(SCENE)/lifted/masks.jsonl)
# Made with masks3.
regions := $(SCENE)/regions.safetensors
spare3 := $(if $(MASKS),,$(SCENE)/lifted/spare.jsonl)
# Sentences that are names only train.
splits := train $(if $(SENTENCES),test)
model1 := $(SCENE)/stage1/model.safetensors
model2 := $(SCENE)/stage2/model.safetensors
model3 := $(SCENE)/lifted/model.safetensors
teacher := $(if $(filter lifted,$(TEACH)),3,1)
# Sentences that the scene writes of itself, behind those of SENTENCES.
taught := $(if $(filter lifted,$(TEACH)),$(filter-out 0,$(TAUGHT)))
said := $(SCENE)/stage2/said.jsonl
text1 := $(text)
text2 := $(if $(taught),$(SCENE)/stage2/text.safetensors,$(text))
steps2 := $(if $(taught),$(shell [ "$(ITERATIONS)" -lt 2500 ] 2>/dev/null || echo 2500))
init2 := $(if $(taught),--query parses --interaction none --contrast none --init $(model3) --init-iterations $(or $(steps2),$(ITERATIONS)))
predictions := $(foreach s,1 2,$(foreach t,$(splits),$(SCENE)/stage$(s)/predictions.$(t).jsonl))
overlays := $(SCENE)/stage1/overlays/complete $(SCENE)/stage2/overlays/complete
scores := $(if $(TRUTH),$(predictions:$(SCENE)/%.jsonl=$(SCENE)/%.score.json) $(if $(MASKS),,$(SCENE)/stage1/masks.score.json) $(SCENE)/stage2/masks.score.json)

.PHONY: all predictions overlays scores report
all: predictions overlays scores
	@$(if $(TRUTH),$(here)report.sh $(SCENE))
predictions: $(predictions)
overlays: $(overlays)
scores: $(scores)

help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(firstword $(MAKEFILE_LIST))

# The steps.
undistort_flag := $(if $(UNDISTORT),--undistort )
undistort := $(if $(UNDISTORT),--undistort $(SCENE)/scene )
command.import = gs-import $(if $(CAMERAS),--cameras $(CAMERAS)) $(if $(IMAGES),--images $(call quoted,IMAGES)) \
	$(if $(TEST_VIEWS),--test-views $(call quoted,TEST_VIEWS)) $(undistort_flag)-o $(SCENE)/scene $(splats)
command.weigh = gs-weigh --scale $(call quoted,SCALE) $(call options,WEIGH) -o $(SCENE)/weights $(SCENE)/scene
command.encode = text-encode --model $(call quoted,BERT) $(if $(SENTENCES),,--names) -o $(text) $(or $(SENTENCES),$(drawn))
command.paint = mask-import $(if $(NAMES),--names $(NAMES)) --undistort $(SCENE)/scene -o $(drawn) $(foreach f,$(painted),$(call quote,$(f)))
command.select = pseudomask-select $(call options,SELECT) -o $(masks1) $(candidates)
train = refer-train --scene $(SCENE)/scene --weights $(SCENE)/weights --text $(text$(1)) --masks $(masks$(1)) $(init$(1)) \
	--iterations $(or $(steps$(1)),$(call quoted,ITERATIONS)) --seed $(call quoted,SEED) --resume --log $(SCENE)/stage$(1)/train.log \
	$(call options,TRAIN) -o $(model$(1))
render = refer-render --scene $(SCENE)/scene --text $(text) --model $(model$(1))
predict = $(call render,$(1)) --sentences $(2) -o $(SCENE)/stage$(1)/predictions.$(2).jsonl
command.teach = $(call render,$(teacher)) --split train --sentences train --scale $(call quoted,SCALE) -o $(masks2)
command.select3d = pseudomask-select --scene $(SCENE)/scene --weights $(SCENE)/weights --spare $(spare3) -o $(masks3) $(candidates)
command.lift = refer-lift --scene $(SCENE)/scene --text $(text) $(if $(by_regions),--regions $(regions),--weights $(SCENE)/weights --masks \
	$(masks3) $(if $(spare3),--spare $(spare3)) $(if $(MASKS),--names masks)) $(call options,LIFT) \
	-o $(model3)
command.say = refer-say --scene $(SCENE)/scene --model $(model3) --encoder $(call quoted,BERT) --each $(call quoted,TAUGHT) \
	--seed $(call quoted,SEED) -o $(said) $(SCENE)
command.encode2 = text-encode --model $(call quoted,BERT) -o $(text2) $(SCENE)/stage2/sentences.jsonl
command.page = refer-report $(if $(TRUTH),--truth $(truth)) $(SCENE)
command.score = miou-score --json --quiet --predicted-views --truth $(truth)
$(foreach s,1 2,$(eval command.train$(s) = $$(call train,$(s))))
$(foreach s,1 2,$(foreach t,train test,$(eval command.render$(s).$(t) = $$(call predict,$(s),$(t)))))
$(foreach s,1 2,$(eval command.overlay$(s) = $$(call render,$(s)) --sentences $(lastword $(splits)) --overlay $(SCENE)/stage$(s)/overlays \
	-o $(SCENE)/stage$(s)/overlays/masks.jsonl))
$(call track,import weigh paint encode select select3d lift train1 train2 teach say encode2 score overlay1 overlay2 $(foreach s,1 2,render$(s).train render$(s).test))

$(SCENE)/log/%.command:
	@mkdir -p $(@D) && printf %s $(call quote,$(command.$*)) >$@

$(scene): $(splats) $(cameras) $(SCENE)/log/import.command
	$(call run,import)

# What the records say is read before anything that takes long, and again where one changed.
records := $(foreach v,SENTENCES CANDIDATES TRUTH $(more_files),$(if $($(v)),$(v))) $(if $(painted),,$(if $(MASKS),MASKS))
$(SCENE)/log/checked: $(scene) $(foreach v,$(records),$($(v)))
	@fault=$$($(here)check.sh --records $(call quoted,tool_folder) $(SCENE)/scene $(foreach v,$(records),$(call quote,$(v)=$($(v))))) && \
		[ -z "$$fault" ] || { printf '%s\n' $(call quoted,called)": $$fault" >&2; exit 3; }
	@touch $@
$(weights) $(text) $(if $(MASKS),,$(masks1)): | $(SCENE)/log/checked

$(weights): $(scene) $(SCENE)/log/weigh.command $(if $(painted),| $(drawn))
	$(call run,weigh)
	@touch $@

$(text): $(or $(SENTENCES),$(drawn)) $(SCENE)/log/encode.command
	$(call run,encode)

ifneq ($(painted),)
$(drawn): $(NAMES) $(painted) $(scene) $(SCENE)/log/paint.command
	$(call run,paint)
endif

# Masks that were drawn on photographs of lenses that distort. $(call flatten,VARIABLE,NAME)
define flatten
command.undistort.$(2) = mask-import $$(undistort)-o $(SCENE)/undistorted/$(2).jsonl $($(1))
$(SCENE)/undistorted/$(2).jsonl: $($(1)) $(scene) $(SCENE)/log/undistort.$(2).command
	@mkdir -p $$(@D)
	$$(call run,undistort.$(2))
$$(call track,undistort.$(2))
endef
$(if $(UNDISTORT),$(foreach v,CANDIDATES TRUTH,$(if $($(v)),$(eval $(call flatten,$(v),$(if $(filter TRUTH,$(v)),truth,candidates))))))

ifeq ($(MASKS),)
# A way of selecting that looks at the scene has to wait for it.
$(masks1): $(candidates) $(SCENE)/log/select.command $(if $(findstring --weights,$(SELECT)),$(weights))
	@mkdir -p $(@D)
	$(call run,select)

$(masks3): $(candidates) $(weights) $(SCENE)/log/select3d.command
	@mkdir -p $(@D)
	$(call run,select3d)
endif

# A checkpoint of a training that learned from something else is of no use.
$(model1): $(masks1)
$(model2): $(masks2)
$(model2): $(if $(taught),$(text2) $(model3))
$(SCENE)/stage%/model.safetensors: $(weights) $(text) $(SCENE)/log/train%.command
	@mkdir -p $(@D)
	@[ ! -e $@.checkpoint ] || [ -z "$$(find $^ -newer $@.checkpoint)" ] || rm $@.checkpoint
	@[ ! -e $@.checkpoint ] || echo "refer-train (train$*): goes on after step $$(head -c 9999 $@.checkpoint | \
		LC_ALL=C sed -n 's/.*"iteration":"\([0-9]*\)".*/\1/p') of an interrupted training"
	$(call run,train$*)

$(model3): $(if $(by_regions),$(regions),$(masks3)) $(weights) $(text) $(SCENE)/log/lift.command
	@mkdir -p $(@D)
	$(call run,lift)

ifneq ($(taught),)
$(said): $(model3) $(SCENE)/log/say.command
	@mkdir -p $(@D)
	$(call run,say)

$(text2): $(said) $(SENTENCES) $(SCENE)/log/encode2.command
	@cat $(SENTENCES) $(said) >$(SCENE)/stage2/sentences.jsonl
	$(call run,encode2)
endif

# What another model answers in the training views teaches stage 2.
$(masks2): $(model$(teacher)) $(SCENE)/log/teach.command
	@mkdir -p $(@D)
	$(call run,teach)

$(SCENE)/stage1/predictions.%.jsonl: $(model1) $(SCENE)/log/render1.%.command
	$(call run,render1.$*)

$(SCENE)/stage2/predictions.%.jsonl: $(model2) $(SCENE)/log/render2.%.command
	$(call run,render2.$*)

$(SCENE)/stage%/overlays/complete: $(SCENE)/stage%/model.safetensors $(SCENE)/log/overlay%.command
	@mkdir -p $(@D)
	$(call run,overlay$*)
	@touch $@

$(SCENE)/%.score.json: $(SCENE)/%.jsonl $(truth) $(SCENE)/log/score.command
	$(hide)$(tool)$(command.score) -o $@ $<

# Of lift.mk, what it makes.
page = open in a browser: file://$(abspath $(SCENE))/report.html
report: $(if $(filter lifted,$(.DEFAULT_GOAL)),lifted,predictions scores)
	@$(if $(filter lifted,$^),,$(here)report.sh $(SCENE))
	@$(call run,page)
	@printf '%s\n' $(call quoted,page)
