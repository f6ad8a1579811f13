# The systems that the paper compares with, on synthetic scenes, beside the ways of these tools: one table.
#
#	make -f pipelines/systems.mk
#
# Each system is a field of 2D features or labels, lifted onto the Gaussians in closed form (feature-lift), and its rule for
# queries (feature-query). The 2D models cannot run here. Stand-ins for what they say of each training view are:
#	truth      true masks; the feature is the language encoder's vector of the object's name, the label its number
#	detector   the synthetic detector's candidates in their place, which show the wrong object more often than not
# Cosine and relevancy have two rows each: for the pixels of rendered features, as they are published, and for Gaussians.
# Grounded SAM's row has what the synthetic detector finds in the test views themselves, which no other row sees.
# A name is as a class has it: look-alikes share it. Queries are the sentences, by the same encoder.
#
# OUT         folder for everything that is made; default systems
# SCENES      named scenes of gs-synth; default diner toys tea kitchen
# SEEDS       of the scenes; default 21
# SYNTH       more options for gs-synth; default --size 246x182 --gaussians 15000
# PRUNE       reliability under which a Gaussian has no feature; default 0.5
# TRAIN       options of refer-train; default --iterations 2000 and rates four times the paper's; empty: without this row
# BERT        folder of the language encoder; default: where `make encoder` puts it
# BIN         folder of the tools; default: build/bin of this checkout, or the PATH where that is not there
#
# The table is printed, and kept in OUT/systems.md. Its seconds mean little where anything else runs, -j2 included.

here := $(dir $(lastword $(MAKEFILE_LIST)))
include $(here)common.mk
OUT ?= systems
SCENES ?= diner toys tea kitchen
SEEDS ?= 21
SYNTH ?= --size 246x182 --gaussians 15000
PRUNE ?= 0.5
TRAIN ?= --iterations 2000 --feature-rate 0.01 --mlp-rate 0.0004
$(call check,,OUT BIN BERT,SCENES SEEDS SYNTH PRUNE TRAIN)
$(call check_plain,SCENES SEEDS SYNTH PRUNE TRAIN)
lift_options := --prune $(PRUNE)

cells := $(foreach s,$(SCENES),$(foreach n,$(SEEDS),$(OUT)/$(s)-$(n)))
kinds := truth detector
by_features := cosine relevancy hyperplane

# The rows: NAME, where the steps that a system needs are logged, and the file that is its field; none of both where no scene is looked at.
by_pixels := cosine2d relevancy2d
rendered := carried-first $(foreach k,$(kinds),$(addprefix $(k)-,$(by_features) identity)) $(if $(TRAIN),ours-trained) ours-lifted
rows := views-sam carried-first $(foreach k,$(kinds),$(addprefix $(k)-,$(by_pixels) $(by_features) identity)) $(filter ours%,$(rendered))
positives := select.top1 lift.top1
$(foreach k,$(kinds),$(foreach r,$(by_features) $(by_pixels),$(eval steps.$(k)-$(r) = $(k).features $(k)-$(r))$(eval field.$(k)-$(r) = $(k)/features)))
$(foreach k,$(kinds),$(eval steps.$(k)-hyperplane += $(positives))$(eval steps.$(k)-identity = $(k).labels $(k)-identity \
	$(positives))$(eval field.$(k)-identity = $(k)/labels))
steps.carried-first = select.first lift.first carried.labels carried-first
field.carried-first = carried/labels
steps.ours-trained = select.ciou train
field.ours-trained = selected/ours-trained
steps.ours-lifted = select.scene lift.scene
field.ours-lifted = selected/ours-lifted

rule.cosine = --rule cosine
rule.relevancy = --rule relevancy --relative
rule.cosine2d = --rule cosine
rule.relevancy2d = --rule relevancy --relative
rule.hyperplane = --rule hyperplane
rule.identity = --rule identity

.DEFAULT_GOAL := systems
.PHONY: systems
help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(called)

# $(call cell_rules,FOLDER,SCENE,SEED)
define cell_rules
$(1)/data/made-by: FORCE
	@want='gs-synth --scene $(2) --seed $(3) $(SYNTH)'; [ "$$$$(cat $$@ 2>/dev/null)" = "$$$$want" ] || { rm -f $$@ && \
		$(tool)$$$$want -q -o $(1)/data && printf '%s\n' "$$$$want" >$$@; }
$(1)/options/encoder $(1)/options/lift $(1)/options/train: FORCE
	$$(call keep,$$(if $$(findstring encoder,$$@),$(BERT),$$(if $$(findstring lift,$$@),$(lift_options),$(TRAIN))))
$(1)/scene/cameras.json: $(1)/data/made-by
	$$(call log,$(1)/log/import,gs-import --cameras $(1)/data/sparse/0 --images $(1)/data/images \
		--test-views $$$$(cat $(1)/data/test-views) -o $(1)/scene $(1)/data/point_cloud.ply)
$(1)/weights/complete: $(1)/scene/cameras.json
	$$(call log,$(1)/log/weigh,gs-weigh -o $(1)/weights $(1)/scene)
	@touch $$@

# The texts: sentences, names of classes, canonical phrases.
$(1)/text/sentences.jsonl: $(1)/data/made-by
	@mkdir -p $$(@D) && cp $(1)/data/sentences.jsonl $$@
$(1)/text/names.jsonl: $(1)/data/made-by
	@mkdir -p $$(@D) && jq -c '{ref: .object, object, text: (.object | sub(" [0-9]+$$$$"; "")), split: "train"}' $(1)/data/sentences.jsonl | \
		sort -u >$$@
$(1)/text/canonical.jsonl: $(1)/data/made-by
	@mkdir -p $$(@D) && printf '{"ref":"%s","object":"%s","text":"%s","split":"train"}\n' $(foreach w,object things stuff texture,$(w) $(w) $(w)) >$$@
$(1)/text/%.safetensors: $(1)/text/%.jsonl $(1)/options/encoder
	$$(call log,$(1)/log/text.$$*,text-encode --model $(BERT) -o $$@ $$<)

# The masks: true ones of the training views, all of the detector's, and those that are selected.
$(1)/masks/truth.jsonl: $(1)/data/made-by
	@mkdir -p $$(@D) && jq -c --arg test "$$$$(cat $(1)/data/test-views)" 'select(.view as $$$$v | $$$$test | split(",") | index($$$$v) | not)' \
		$(1)/data/truth.jsonl >$$@
$(1)/masks/detector.jsonl: $(1)/data/made-by
	@mkdir -p $$(@D) && cp $(1)/data/candidates.jsonl $$@
$(1)/masks/scene.jsonl $(1)/masks/first.jsonl: $(1)/masks/%.jsonl: $(1)/weights/complete
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/select.$$*,pseudomask-select $$(if $$(findstring first,$$*),--method first) --scene $(1)/scene \
		--weights $(1)/weights -o $$@ $(1)/data/candidates.jsonl)
$(1)/masks/top1.jsonl $(1)/masks/ciou.jsonl: $(1)/masks/%.jsonl: $(1)/data/made-by
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/select.$$*,pseudomask-select --method $$* -o $$@ $(1)/data/candidates.jsonl)
$(1)/lifted/%.safetensors: $(1)/masks/%.jsonl $(1)/weights/complete $(1)/text/sentences.safetensors
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/lift.$$*,refer-lift --scene $(1)/scene --weights $(1)/weights --text $(1)/text/sentences.safetensors \
		--masks $$< $$(if $$(filter-out scene,$$*),--names masks) -o $$@)

# What is lifted of features and labels.
$(foreach k,$(kinds),$(1)/$(k)/features.safetensors): $(1)/%/features.safetensors: $(1)/masks/%.jsonl $(1)/text/names.safetensors \
		$(1)/weights/complete $(1)/options/lift
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/$$*.features,feature-lift --scene $(1)/scene --weights $(1)/weights --masks $$< \
		--text $(1)/text/names.safetensors --uncovered zero $(lift_options) -o $$@)
$(foreach k,$(kinds),$(1)/$(k)/labels.safetensors): $(1)/%/labels.safetensors: $(1)/masks/%.jsonl $(1)/weights/complete
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/$$*.labels,feature-lift --scene $(1)/scene --weights $(1)/weights --masks $$< -o $$@)
$(1)/carried/labels.safetensors: $(1)/masks/first.jsonl $(1)/weights/complete
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/carried.labels,feature-lift --scene $(1)/scene --weights $(1)/weights --masks $$< -o $$@)

# What is selected, or answered by a model.
$(1)/selected/carried-first.safetensors: $(1)/carried/labels.safetensors $(1)/lifted/first.safetensors
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/carried-first,feature-query --rule identity --positives $(1)/lifted/first.safetensors \
		--text $(1)/text/sentences.safetensors -o $$@ $$<)
$(1)/selected/ours-lifted.safetensors: $(1)/lifted/scene.safetensors
	@mkdir -p $$(@D) && cp $$< $$@
$(1)/selected/ours-trained.safetensors: $(1)/masks/ciou.jsonl $(1)/weights/complete $(1)/text/sentences.safetensors $(1)/options/train
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/train,refer-train --scene $(1)/scene --weights $(1)/weights --text $(1)/text/sentences.safetensors \
		--masks $$< --seed $(3) $(TRAIN) --checkpoint 0 -o $$@)
$(foreach t,test train,$(1)/answers/views-sam.$(t).jsonl): $(1)/answers/views-sam.%.jsonl: $(1)/data/made-by $(here)best-candidates.jq
	@mkdir -p $$(@D)
	@jq -n -c --arg views "$$$$(cat $(1)/data/test-views)" --arg split $$* --slurpfile sentences $(1)/data/sentences.jsonl \
		-f $(here)best-candidates.jq $(1)/data/candidates.test.jsonl >$$@
$(foreach r,$(rendered),$(foreach t,test train,$(1)/answers/$(r).$(t).jsonl)): $(1)/answers/%.jsonl:
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/render.$$*,refer-render --scene $(1)/scene --text $(1)/text/sentences.safetensors --model $$< \
		--sentences $$(patsubst .%,%,$$(suffix $$*)) -o $$@)
$(1)/answers/%.score.json: $(1)/answers/%.jsonl
	$(tool)miou-score --json --quiet --predicted-views --truth $(1)/data/truth.jsonl -o $$@ $$<
$(foreach r,$(rendered),$(foreach t,test train,$(eval $(1)/answers/$(r).$(t).jsonl: $(1)/selected/$(r)$(if $(filter ours%,$(r)),,$(if \
	$(filter carried%,$(r)),,.$(t))).safetensors)))
endef

# A rule on a field; the sentences that compete are those of a split. $(call rule_rules,FOLDER,KIND,RULE,SPLIT)
define rule_rules
$(1)/selected/$(2)-$(3).$(4).safetensors: $(1)/$(field.$(2)-$(3)).safetensors $(1)/text/sentences.safetensors $(if $(filter relevancy,$(3)),$(1)/text/canonical.safetensors) \
		$(if $(filter hyperplane identity,$(3)),$(1)/lifted/top1.safetensors)
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/$(2)-$(3)$(if $(filter train,$(4)),.train),feature-query $(rule.$(3)) --text $(1)/text/sentences.safetensors --sentences $(4) \
		$(if $(filter relevancy,$(3)),--canonical $(1)/text/canonical.safetensors) \
		$(if $(filter hyperplane identity,$(3)),--positives $(1)/lifted/top1.safetensors) -o $$@ $$<)
endef

# The same for pixels of rendered features: its masks are the answers. $(call pixel_rules,FOLDER,KIND,RULE,SPLIT)
define pixel_rules
$(1)/answers/$(2)-$(3).$(4).jsonl: $(1)/$(field.$(2)-$(3)).safetensors $(1)/text/sentences.safetensors $(if $(filter relevancy2d,$(3)),$(1)/text/canonical.safetensors)
	@mkdir -p $$(@D)
	$$(call log,$(1)/log/$(2)-$(3)$(if $(filter train,$(4)),.train),feature-query $(rule.$(3)) --pixels $(1)/scene --least $(PRUNE) \
		--text $(1)/text/sentences.safetensors --sentences $(4) $(if $(filter relevancy2d,$(3)),--canonical $(1)/text/canonical.safetensors) -o $$@ $$<)
endef

$(foreach s,$(SCENES),$(foreach n,$(SEEDS),$(eval $(call cell_rules,$(OUT)/$(s)-$(n),$(s),$(n)))))
$(foreach c,$(cells),$(foreach k,$(kinds),$(foreach r,$(by_features) identity,$(foreach t,test train,$(eval $(call rule_rules,$(c),$(k),$(r),$(t)))))))
$(foreach c,$(cells),$(foreach k,$(kinds),$(foreach r,$(by_pixels),$(foreach t,test train,$(eval $(call pixel_rules,$(c),$(k),$(r),$(t)))))))

systems: $(foreach c,$(cells),$(foreach r,$(rows),$(foreach t,test train,$(c)/answers/$(r).$(t).score.json)))
	@{ $(foreach r,$(rows),printf '%s\t%s\t%s\n' $(r) '$(field.$(r))' '$(steps.$(r))';) } | CELLS='$(cells)' PUBLISHED=$(here)published.tsv \
		BIN=$(tool) $(here)systems-report.sh | tee $(OUT)/systems.md
