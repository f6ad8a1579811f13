# The ablation tables of the paper (ReferSplat, ICML 2025) on synthetic scenes, the published figures beside ours.
#
#	make -f pipelines/ablation.mk -j2 all
#
# OUT         folder for everything that is made; default ablation
# SIZE        full or quick; default quick: fewer seeds and steps, smaller scenes, to see that all of it works
# SCENES      named scenes of gs-synth; default diner toys tea kitchen
# SEEDS       of scenes and trainings alike; default 21 22 (full), 21 (quick)
# ITERATIONS  steps of a training; default 5000 (full), 2000 (quick)
# SYNTH       more options for gs-synth; the quick size has its own
# SCALE       size at which training looks at the views; default 0.5 (full), 1 (quick)
# TRAIN       options of every training, before its own; default: rates four times the paper's, for few steps
# RUNS        trainings to do, of those below; default all. A new one: RUNS="both mine" run.mine="--lambda 0.1"
# BERTS       more language encoders for the encoder table, as NAME=DIR ...: any folders that text-encode reads, such as clip=DIR of a CLIP
# BERT        folder of the language encoder; default: where `make encoder` puts it
# TAUGHT      numbers of sentences of each thing in the table taught; default 0 200
# THREADS     of each tool; default 1, because -j has several of them at work
# BIN         folder of the tools; default: build/bin of this checkout, or the PATH where that is not there
#
# Targets: tables (all but the cost), cost (times its own trainings, so nothing else should run), all, and one for each
# table: statistics (of the scenes) unseen (answers of the lifted model, or of the trainings in unseen=, to sentences in a wording kept apart) modules second (what may teach a second stage) similarity masks interaction width encoder contrast lifted (and,
# not in the paper, answers without training, and trainings that start from them) taught (what stands for a sentence, and sentences of the scene's own) hard (the same by what makes a case hard)
# space (its boxes and outlines of whole objects). Not among them: exact, the modules without the shortcuts of a training
# step, several times as long; and cells, which prints the scenes and seeds, for many machines: ablation.sbatch. They print;
# OUT/SIZE/NAME.md keeps what was printed. Every cell is the mean over the seeds, each the mean over the scenes, with the spread between seeds.
# Every file is made under its own name: what is there is not made again, unless what it is made of changed, or its command.

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)common.mk
OUT ?= ablation
SIZE ?= quick
SCENES ?= diner toys tea kitchen
THREADS ?= 1
TAUGHT ?= 0 200
TRAIN ?= --feature-rate 0.01 --mlp-rate 0.0004
tables := statistics unseen modules second similarity masks interaction width encoder contrast lifted taught hard space
$(call check,,OUT BIN BERT,SIZE SCENES SEEDS RUNS SYNTH TRAIN BERTS SCALE ITERATIONS TAUGHT THREADS run.% masks.% text.% steps.% init.% lift.% \
	ask.% $(tables) exact)
ifeq ($(SIZE),full)
SEEDS ?= 21 22
ITERATIONS ?= 5000
SCALE ?= 0.5
else ifeq ($(SIZE),quick)
SEEDS ?= 21
ITERATIONS ?= 2000
SCALE ?= 1
SYNTH ?= --size 246x182 --gaussians 15000
else
$(error SIZE is full or quick)
endif

# The rules of a scene and a training are made from these.
$(call check_plain,SCENES SEEDS RUNS SYNTH TRAIN BERTS SCALE ITERATIONS TAUGHT THREADS)

# The trainings: options; the masks and the word vectors that they learn from, where these are not the usual ones.
run.none = --interaction none --contrast none
run.pcmi = --interaction pcmi --contrast none
run.gtcl = --interaction none --contrast cosine
run.both = --interaction pcmi --contrast cosine
run.two = $(run.both)
masks.two = both/teach
run.cosine = $(run.none) --similarity cosine
run.top1 = $(run.both)
masks.top1 = masks/top1
run.first = $(run.both)
masks.first = masks/first
run.iou = $(run.both)
masks.iou = masks/iou
run.attention = --interaction attention --contrast none
run.attention+fp = --interaction attention+fp --contrast none
run.add = --interaction add --contrast none
run.proj = --interaction pcmi-proj --contrast none
run.width1 = $(run.both) --feature-width 1
run.width4 = $(run.both) --feature-width 4
run.width32 = $(run.both) --feature-width 32
run.static = $(run.both)
text.static = static
run.dot = --interaction pcmi --contrast dot
run.pairs = --interaction pcmi --contrast pairs
# The released code's: projections and LayerNorm, its contrast, its weight of that.
run.released = --interaction pcmi-proj --contrast pairs --lambda 0.1
run.onscene = $(run.both)
masks.onscene = masks/scene
# Another second stage: the masks of the objects that were lifted from what was selected in 3D.
run.two-lifted = $(run.both)
masks.two-lifted = masks/lifted
# Table 1 without the shortcuts of a step: every Gaussian has its own feature, every sentence is in the contrast.
$(foreach r,none pcmi gtcl both two two-lifted,$(eval run.$(r)-exact = $$(run.$(r)) --share 0 --negatives 0))
masks.two-exact = both-exact/teach
masks.two-lifted-exact = masks/lifted
run.warmed = $(run.both)
masks.warmed = masks/scene
init.warmed = lifted/full
steps.warmed = 500
# The lifted objects learned by words and by parses, with so many sentences of each thing that the scene writes of itself (refer-say),
# with the paper's modules and without, in as many steps of as many sentences; and parses in the paper's way, from images.
taught_runs := $(foreach q,words parses,$(foreach n,$(TAUGHT),$(foreach m,none pcmi gtcl,$(q)-$(n)-$(m))))
part = $(word $(2),$(subst -, ,$(1)))
$(foreach r,$(taught_runs),$(eval run.$(r) = $$(run.$(call part,$(r),3)) --query $(call part,$(r),1) --feature-rate 0.0025 --mlp-rate 0.0001 \
	--init-iterations 1250)$(eval steps.$(r) = 1250)$(eval masks.$(r) = masks/scene)$(eval init.$(r) = lifted/full)$(if \
	$(filter-out 0,$(call part,$(r),2)),$(eval text.$(r) = taught-$(call part,$(r),2))))
run.none-parses = $(run.none) --query parses

# Answers of lifted models: which model, and which parts of the choice it goes without.
lift.lift = full
lift.lift-voted = voted
lift.lift-relations = plain
lift.lift-sizes = plain
ask.lift-sizes = --without relations,except
lift.lift-colours = plain
ask.lift-colours = --without relations,except,sizes
lift.lift-names = plain
ask.lift-names = --without relations,except,sizes,colours,surfaces
lift.lift-words = plain
ask.lift-words = --without relations,except,sizes,colours,surfaces,names
lift.lift-sentence = plain
ask.lift-sentence = --without relations,except,sizes,colours,surfaces,names,words,knowledge,purpose
parts := words names knowledge colours surfaces sizes relations except sentence purpose
$(foreach p,$(parts),$(eval lift.lift-but-$(p) = full)$(eval ask.lift-but-$(p) = --without $(p)))
encoders := $(foreach b,$(BERTS),$(firstword $(subst =, ,$(b))))
$(foreach b,$(BERTS),$(eval dir.$(firstword $(subst =, ,$(b))) := $(lastword $(subst =, ,$(b)))))
$(foreach e,$(encoders),$(eval run.$(e) = $$(run.both))$(eval text.$(e) = $(e)))

statistics :=
modules := none pcmi gtcl both two
similarity := none cosine
masks := both iou top1 first two
interaction := none attention attention+fp add pcmi proj
width := width1 width4 both width32
encoder := both static $(encoders)
contrast := pcmi dot both pairs released
second := both two onscene two-lifted
exact := none none-exact pcmi pcmi-exact gtcl gtcl-exact both both-exact two two-exact two-lifted two-lifted-exact
lifted := both two onscene warmed lift-sentence lift-words lift-names lift-colours lift-sizes lift-relations lift lift-voted $(foreach p,$(parts),lift-but-$(p))
taught := none none-parses $(taught_runs)
hard := two warmed lift-relations lift
space := lift
unseen := lift
RUNS ?= $(sort $(foreach t,$(tables) exact,$($(t))))

root := $(OUT)/$(SIZE)
cells := $(foreach s,$(SCENES),$(foreach n,$(SEEDS),$(root)/$(s)-$(n)))

export OMP_NUM_THREADS := $(THREADS)

.PHONY: all tables cost scores cells $(tables) exact
.DEFAULT_GOAL := all
all: tables
	@$(MAKE) --no-print-directory -f $(firstword $(MAKEFILE_LIST)) cost
tables: $(tables)
help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(called)

# $(call data_rules,FOLDER,SCENE,SEED)
define data_rules
$(1)/data/made-by: FORCE
	@want='gs-synth --scene $(2) --seed $(3) $(SYNTH)'; [ "$$$$(cat $$@ 2>/dev/null)" = "$$$$want" ] || { rm -f $$@ && \
		$(tool)$$$$want -q -o $(1)/data && printf '%s\n' "$$$$want" >$$@; }
$(1)/scene/cameras.json: $(1)/data/made-by
	$$(call log,$(1)/log/import,gs-import --cameras $(1)/data/sparse/0 --images $(1)/data/images \
		--test-views $$$$(cat $(1)/data/test-views) -o $(1)/scene $(1)/data/point_cloud.ply)
$(1)/log/weigh.options $(1)/log/contextual.options $(1)/log/static.options: FORCE
	$$(call keep,$$(if $$(findstring weigh,$$@),--scale $(SCALE),--model $(BERT)))
$(1)/weights/complete: $(1)/scene/cameras.json $(1)/log/weigh.options
	$$(call log,$(1)/log/weigh,gs-weigh --scale $(SCALE) -o $(1)/weights $(1)/scene)
	@touch $$@
$(1)/text/contextual.safetensors: $(1)/data/made-by $(1)/log/contextual.options
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/contextual,text-encode --model $(BERT) -o $$@ $(1)/data/sentences.jsonl)
$(1)/text/parses.jsonl: $(1)/text/contextual.safetensors
	$(tool)text-parse -o $$@ $$<
$(1)/text/static.safetensors: $(1)/data/made-by $(1)/log/static.options
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/static,text-encode --words static --model $(BERT) -o $$@ $(1)/data/sentences.jsonl)
$(1)/text/taught-%.safetensors: $(1)/lifted/full.safetensors
	$$(call log,$(1)/log/say,refer-say --scene $(1)/scene --model $$< --encoder $(BERT) --each $$* --seed $(3) -o $(1)/text/said-$$*.jsonl $(1))
	@cat $(1)/data/sentences.jsonl $(1)/text/said-$$*.jsonl >$(1)/text/taught-$$*.jsonl
	$$(call log,$(1)/log/taught,text-encode --model $(BERT) -o $$@ $(1)/text/taught-$$*.jsonl)
$(1)/masks/first.jsonl: $(1)/weights/complete
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/first,pseudomask-select --method first --scene $(1)/scene --weights $(1)/weights -o $$@ \
		$(1)/data/candidates.jsonl)
$(1)/masks/scene.jsonl $(1)/masks/spare &: $(1)/weights/complete
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/select3d,pseudomask-select --scene $(1)/scene --weights $(1)/weights --spare $(1)/masks/spare \
		-o $(1)/masks/scene.jsonl $(1)/data/candidates.jsonl)
$(1)/lifted/voted.safetensors: $(1)/masks/ciou.jsonl
$(1)/lifted/plain.safetensors $(1)/lifted/full.safetensors: $(1)/masks/scene.jsonl
$(1)/lifted/full.safetensors: $(1)/masks/spare
$(1)/lifted/%.safetensors: $(1)/weights/complete $(1)/text/contextual.safetensors
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/lift.$$*,refer-lift --scene $(1)/scene --weights $(1)/weights --text $(1)/text/contextual.safetensors \
		--masks $$(filter %.jsonl,$$^) $$(if $$(filter plain,$$*),--names masks) $$(if $$(filter full,$$*),--spare $(1)/masks/spare) -o $$@)
$(1)/masks/%.jsonl: $(1)/data/made-by
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/$$*,pseudomask-select --method $$* -o $$@ $(1)/data/candidates.jsonl)
$(1)/both/teach.jsonl $(1)/both-exact/teach.jsonl: $(1)/%/teach.jsonl: $(1)/%/model.safetensors
	$$(call log,$(1)/log/teach.$$*,refer-render --scene $(1)/scene --text $(1)/text/contextual.safetensors --model $$< \
		--split train --sentences train --scale $(SCALE) -o $$@)
$(1)/masks/lifted.jsonl: $(1)/lifted/full.safetensors
	$$(call log,$(1)/log/answers,refer-render --scene $(1)/scene --text $(1)/text/contextual.safetensors --model $$< \
		--split train --sentences train -o $$@)
$(1)/%.quality.json: $(1)/%.jsonl
	$(tool)miou-score --json --quiet --predicted-views --truth $(1)/data/truth.jsonl -o $$@ $$<
endef

# $(call encoder_rules,FOLDER,NAME)
define encoder_rules
$(1)/text/$(2).safetensors: $(1)/data/made-by
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/$(2),text-encode --model $(dir.$(2)) -o $$@ $(1)/data/sentences.jsonl)
endef

masks_of = $(or $(masks.$(1)),masks/ciou)
text_of = text/$(or $(text.$(1)),contextual).safetensors
options_of = --iterations $(or $(steps.$(1)),$(ITERATIONS)) $(TRAIN) $(run.$(1))

# $(call score_rule,FOLDER/RUN)
define score_rule
$(1)/%.csv: $(1)/%.jsonl $(dir $(1))text/parses.jsonl
	$(tool)miou-score --csv --quiet --predicted-views --truth $(dir $(1))data/truth.jsonl --whole $(dir $(1))data/whole.jsonl \
		--parses $(dir $(1))text/parses.jsonl -o $$@ $$<
endef

# $(call run_rules,FOLDER,SEED,RUN)
define run_rules
$(1)/$(3)/options: FORCE
	$$(call keep,--seed $(2) $(call options_of,$(3)))
$(1)/$(3)/model.safetensors: $(1)/$(3)/options $(1)/$(call masks_of,$(3)).jsonl $(1)/weights/complete $(1)/$(call text_of,$(3)) \
		$(if $(init.$(3)),$(1)/$(init.$(3)).safetensors)
	$$(call log,$(1)/$(3)/train.log,refer-train --scene $(1)/scene --weights $(1)/weights --text $(1)/$(call text_of,$(3)) \
		--masks $(1)/$(call masks_of,$(3)).jsonl --seed $(2) $(call options_of,$(3)) --checkpoint 0 $(if $(init.$(3)),--init $(1)/$(init.$(3)).safetensors) \
		--log $(1)/$(3)/losses.jsonl -o $$@)
$(1)/$(3)/unseen.jsonl: $(1)/$(3)/model.safetensors $(1)/text/unseen.safetensors
	$$(call log,$(1)/$(3)/unseen.log,refer-render --scene $(1)/scene --text $(1)/text/unseen.safetensors --model $$< -o $$@)
$(1)/$(3)/%.jsonl: $(1)/$(3)/model.safetensors
	$$(call log,$(1)/$(3)/render.log,refer-render --scene $(1)/scene --text $(1)/$(call text_of,$(3)) --model $$< \
		--sentences $$* -o $$@)
endef

# Where the lifted objects are, and their whole outlines. $(call space_rules,FOLDER)
define space_rules
$(1)/lift/boxes.%.jsonl: $(1)/lifted/full.safetensors
	$$(call log,$(1)/lift/locate.log,refer-locate --scene $(1)/scene --text $(1)/text/contextual.safetensors --model $$< \
		--sentences $$* -o $$@)
$(1)/lift/boxes.%.score.json: $(1)/lift/boxes.%.jsonl
	$(tool)miou-score --boxes --json --quiet --truth $(1)/data/boxes.jsonl -o $$@ $$<
$(1)/lift/whole.%.jsonl: $(1)/lifted/full.safetensors
	$$(call log,$(1)/lift/whole.log,refer-render --scene $(1)/scene --text $(1)/text/contextual.safetensors --model $$< \
		--sentences $$* --amodal -o $$@)
$(1)/lift/whole.%.score.json: $(1)/lift/whole.%.jsonl
	$(tool)miou-score --json --quiet --predicted-views --truth $(1)/data/whole.jsonl -o $$@ $$<
$(1)/text/unseen.safetensors: $(1)/data/made-by
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/unseen,text-encode --model $(BERT) -o $$@ $(1)/data/unseen.jsonl)
$(1)/lift/unseen.jsonl: $(1)/lifted/full.safetensors $(1)/text/unseen.safetensors
	$$(call log,$(1)/lift/unseen.log,refer-render --scene $(1)/scene --text $(1)/text/unseen.safetensors --model $$< -o $$@)
$(1)/%/unseen.answers.json: $(1)/%/unseen.jsonl
	$(tool)miou-score --answers --json --quiet --predicted-views --sentences $(1)/data/unseen.jsonl --truth $(1)/data/truth.jsonl -o $$@ $$<
$(1)/lift/visible.%.score.json: $(1)/lift/%.jsonl
	$(tool)miou-score --json --quiet --predicted-views --truth $(1)/data/whole.jsonl -o $$@ $$<
endef

# $(call lift_rules,FOLDER,RUN)
define lift_rules
$(1)/$(2)/options: FORCE
	$$(call keep,$$(ask.$(2)))
$(1)/$(2)/%.jsonl: $(1)/$(2)/options $(1)/lifted/$(lift.$(2)).safetensors
	$$(call log,$(1)/$(2)/render.log,refer-render --scene $(1)/scene --text $(1)/text/contextual.safetensors \
		--model $(1)/lifted/$(lift.$(2)).safetensors --sentences $$* $$(ask.$(2)) -o $$@)
endef

$(foreach s,$(SCENES),$(foreach n,$(SEEDS),$(eval $(call data_rules,$(root)/$(s)-$(n),$(s),$(n)))))
$(foreach c,$(cells),$(foreach e,$(encoders),$(eval $(call encoder_rules,$(c),$(e)))))
$(foreach c,$(cells),$(eval $(call space_rules,$(c))))
$(foreach c,$(cells),$(foreach r,$(filter lift%,$(RUNS)),$(eval $(call lift_rules,$(c),$(r)))))
$(foreach c,$(cells),$(foreach r,$(RUNS),$(eval $(call score_rule,$(c)/$(r)))))
$(foreach s,$(SCENES),$(foreach n,$(SEEDS),$(foreach r,$(filter-out lift%,$(RUNS)),$(eval $(call run_rules,$(root)/$(s)-$(n),$(n),$(r))))))

scores_of = $(foreach c,$(cells),$(foreach r,$(filter $(RUNS),$(1)),$(c)/$(r)/test.csv $(c)/$(r)/train.csv))
scores: $(call scores_of,$(RUNS))
cells:
	@printf '%s\n' $(foreach s,$(SCENES),$(foreach n,$(SEEDS),'$(s) $(n)'))
define table_rules
$(1): $(if $(filter-out unseen,$(1)),$(call scores_of,$($(1))))
	@ROOT='$(root)' SCENES='$(SCENES)' SEEDS='$(SEEDS)' RUNS='$(filter $(RUNS),$($(1)))' $(here)ablation-report.sh $(1) | tee $(root)/$(1).md
endef
$(foreach t,$(tables) exact,$(eval $(call table_rules,$(t))))
statistics masks: $(foreach c,$(cells),$(foreach m,ciou iou top1,$(c)/masks/$(m).quality.json))
masks: $(foreach c,$(cells),$(c)/masks/first.quality.json $(c)/both/teach.quality.json)
second: $(foreach c,$(cells),$(foreach m,ciou scene lifted,$(c)/masks/$(m).quality.json) $(c)/both/teach.quality.json)
unseen: $(foreach c,$(cells),$(foreach r,$(unseen),$(c)/$(r)/unseen.answers.json))
space: $(foreach c,$(cells),$(foreach k,boxes whole visible,$(foreach t,test train,$(c)/lift/$(k).$(t).score.json)))
lifted: $(foreach c,$(cells),$(foreach m,ciou scene,$(c)/masks/$(m).quality.json) $(c)/both/teach.quality.json)

# Alone on the machine, or its seconds mean nothing.
cost_runs := none both released
cost: $(foreach r,$(cost_runs) lift,$(firstword $(cells))/$(r)/test.csv $(firstword $(cells))/$(r)/train.csv)
	@CELL='$(firstword $(cells))' OUT='$(root)/cost' BIN=$(tool) $(here)ablation-cost.sh $(cost_runs) | tee $(root)/cost.md
