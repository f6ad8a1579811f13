# From photographs alone to a scene that can be asked: COLMAP finds the cameras, on the processor, gs-train trains splats, and
# lift.mk goes on where there is something to lift.
#
#	make -f pipelines/photos.mk SCENE=work/kitchen PHOTOS=kitchen/images
#
# With MASKS and NAMES, or SENTENCES and CANDIDATES, at the end of that line, as lift.mk has them, refer-ask can be asked then.
#
# SCENE       folder for everything that is made (required)
# PHOTOS      folder of the photographs, of one camera, or a video, for which ffmpeg is needed (required)
# FPS         photographs that are taken of a second of a video; default 2
# MATCHER     which photographs COLMAP compares: exhaustive, each with each, or sequential, in the order of their names (2 before
#             10), with the next ten, those 16, 32, 64 ... later, and some from the whole of it with one another; default
#             exhaustive for at most 80 photographs, and sequential for more and for a video
# SIZE        photographs are shrunk to at most so many pixels across before COLMAP looks at them; default 1600
# FIT         more options for gs-train, with blanks between them; default --scale 0.5 --test-views every:8
# MASKS, NAMES, SENTENCES, CANDIDATES, TRUTH, TEST_VIEWS, BERT   as lift.mk has them
# BIN         folder of the tools; default: build/bin of this checkout, or the PATH where that is not there
# V           1 prints the commands too
#
# Targets: photos (the splats, and what lift.mk makes where it can), splats. Each step says its time. A second make does nothing.
# `make deps-photos` installs COLMAP and ffmpeg.

.DEFAULT_GOAL := photos
here := $(dir $(lastword $(MAKEFILE_LIST)))
FPS ?= 2
FIT ?= --scale 0.5 --test-views every:8
lifted_by := MASKS NAMES SENTENCES CANDIDATES TRUTH TEST_VIEWS
include $(here)common.mk
export QT_QPA_PLATFORM := offscreen
SIZE ?= 1600
$(call check,SCENE PHOTOS,SCENE PHOTOS,FPS MATCHER SIZE FIT $(lifted_by) BERT BIN V)
$(call check_plain,FPS MATCHER SIZE)

is_video := $(if $(wildcard $(PHOTOS)/.),,1)
MATCHER ?= $(if $(is_video)$(word 81,$(wildcard $(PHOTOS)/*)),sequential,exhaustive)
$(if $(filter exhaustive sequential,$(MATCHER)),,$(error $(called): MATCHER is '$(MATCHER)', and exhaustive or sequential are what it can be))
images := $(if $(is_video),$(SCENE)/photos,$(PHOTOS))
colmap := $(SCENE)/colmap
model := $(colmap)/model/complete
splats := $(SCENE)/splats.ply

help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(firstword $(MAKEFILE_LIST))

# $(call step,NAME,COMMAND): does it, and says its time; all that it says itself goes to log/NAME.
define step
$(hide)mkdir -p $(SCENE)/log $(@D) && begin=$$(date +%s) && { { $(2); } >$(SCENE)/log/$(1) 2>&1 || { tail -n 20 $(SCENE)/log/$(1) >&2; exit 1; }; } && \
	echo "$(1): $$(($$(date +%s) - begin)) s"
endef
needs = $(hide)command -v $(1) >/dev/null || { echo "$(called): $(1) is not installed: run 'make deps-photos' in $(here).., or $(2)" >&2; exit 4; }

# Of the photographs in order, those that are compared: two that are near, or a power of two apart, or both of an even choice of 30.
pairs = /[.]/ { name[++n] = $$0 } \
	END { every = int((n + 29) / 30); \
		for (i = 1; i < n; i++) for (j = i + 1; j <= n; j++) { \
			for (far = j - i; far % 2 == 0; far /= 2); \
			if (j - i <= 10 || far == 1 || i % every + j % every == 0) print name[i], name[j] } }
say.exhaustive = each photograph with each; MATCHER=sequential takes less time where they were taken one after another
say.sequential = each photograph with those taken near it; where they are in no order, MATCHER=exhaustive does better and takes longer

command.features = colmap feature_extractor --database_path $(colmap)/database.db --image_path $(images) --ImageReader.single_camera 1 \
	--ImageReader.camera_model OPENCV --SiftExtraction.use_gpu 0 --SiftExtraction.max_image_size $(SIZE) --SiftExtraction.max_num_features 4096
command.exhaustive = colmap exhaustive_matcher --database_path $(colmap)/database.db --SiftMatching.use_gpu 0
command.sequential = ls -v $(images) | awk '$(pairs)' >$(colmap)/pairs && colmap matches_importer --database_path $(colmap)/database.db \
	--match_type pairs --match_list_path $(colmap)/pairs --SiftMatching.use_gpu 0
command.matches = $(command.$(MATCHER))
command.mapper = colmap mapper --database_path $(colmap)/database.db --image_path $(images) --output_path $(colmap)/sparse
command.fit = gs-train --cameras $(colmap)/model --images $(images) $(call options,FIT) --resume -v -o $(splats)
command.frames = ffmpeg -nostdin -y -i $(PHOTOS) -vf fps=$(FPS) -qscale:v 2 $(SCENE)/photos/frame_%05d.jpg
$(call track,features matches fit frames)

.PHONY: photos splats
splats: $(splats)
photos: $(splats)
ifneq ($(MASKS)$(SENTENCES),)
	$(hide)$(MAKE) --no-print-directory -f $(here)lift.mk SCENE=$(SCENE) SPLATS=$(splats) CAMERAS=$(colmap)/model UNDISTORT=1 \
		$(foreach v,$(lifted_by),$(if $($(v)),$(call quote,$(v)=$($(v)))))
else
	@echo "$(splats) is trained; MASKS= or SENTENCES= and CANDIDATES= would say what things there are: make -f $(called) help"
endif

$(SCENE)/log/%.command:
	@mkdir -p $(@D) && printf %s $(call quote,$(command.$*)) >$@

$(SCENE)/photos/complete: $(PHOTOS) $(SCENE)/log/frames.command
	$(call needs,ffmpeg,name a folder of photographs)
	@rm -rf $(@D)
	$(call step,frames,$(command.frames))
	@touch $@

# The database takes what it is given to what it has, so each step begins with what the one before left.
$(colmap)/features: $(if $(is_video),$(SCENE)/photos/complete,$(wildcard $(PHOTOS)/*)) $(SCENE)/log/features.command
	$(call needs,colmap,give gs-train a model of another program)
	@rm -rf $(colmap)
	$(call step,features,$(command.features))
	@touch $@

$(colmap)/matches: $(colmap)/features $(SCENE)/log/matches.command
	@echo "matches: $(say.$(MATCHER))"
	$(call step,matches,$(command.matches))
	@touch $@

# Of several models the one with most photographs.
$(model): $(colmap)/matches
	@rm -rf $(colmap)/sparse $(@D); mkdir -p $(colmap)/sparse
	$(call step,mapper,$(command.mapper))
	@best=$$(ls -S $(colmap)/sparse/*/images.* 2>/dev/null | head -n 1); [ -n "$$best" ] || \
		{ echo "$(called): colmap found no two photographs that show the same: see $(SCENE)/log/mapper" >&2; exit 3; }; \
		mkdir -p $(@D) && cp -p "$${best%/*}"/* $(@D) && touch $@

$(splats): $(model) $(SCENE)/log/fit.command
	$(call step,fit,$(tool)$(command.fit))
