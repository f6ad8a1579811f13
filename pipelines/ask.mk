# Opens a scene in the browser: to ask it, to look at it, and to name its things by clicks. What lift.mk makes is made first: with
# MASKS or SENTENCES the model; else the regions that a click means. Nothing is made twice.
#
#	make -f pipelines/ask.mk SCENE=work/kitchen SPLATS=kitchen.ply CAMERAS=sparse/0 IMAGES=images
#
# SCENE, SPLATS   as in lift.mk, and so all its other variables
# PORT            where the page is; default 8017
# BIN             folder of the tools; default: build/bin of this checkout, or the PATH where that is not there

here := $(dir $(lastword $(MAKEFILE_LIST)))
PORT ?= 8017
include $(here)common.mk
MAKEOVERRIDES := $(filter-out PORT=%,$(MAKEOVERRIDES))

.PHONY: ask
.DEFAULT_GOAL := ask
ask:
	@$(MAKE) --no-print-directory -f $(here)lift.mk $(if $(MASKS)$(SENTENCES),lifted,regions)
	@$(if $(wildcard $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/refersplat/viewer/.),,echo "without 3D: 'make viewer' fetches what shows it")
	@exec $(tool)refer-serve --encoder $(call quoted,BERT) --port $(call quoted,PORT) $(SCENE)

help:
	@sed -n '/^$$/q;s/^# \{0,1\}//p' $(called)
