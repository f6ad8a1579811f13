# `make viewer`: included by the Makefile.

# The viewer of refer-report's page: Spark (MIT) and three.js (MIT), into a cache too.
VIEWER_CACHE ?= $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/refersplat/viewer
SPARK_PACKAGE := @sparkjsdev/spark@2.2.0
SPARK_SHA256 := c66fce63e112d9b099da87b70b36db45b822436bcf1f4b68c62f669627475231
THREE_PACKAGE := three@0.180.0
THREE_SHA256 := ad66d724565ee29a2467277fa84daa5ed0211d6b8d446e9ef29f6bae0cd14144

# $(call fetch,PACKAGE,SHA256,NAME): an npm package as $$work/NAME/package.
fetch = mkdir "$$work/$(3)" && (cd "$$work/$(3)" && npm pack --ignore-scripts --silent $(1) >npm.log 2>&1) || \
		{ tail -n 5 "$$work/$(3)/npm.log" >&2; give_up "npm pack $(1) failed (offline?)"; }; \
	mv "$$work/$(3)"/*.tgz "$$work/$(3).tgz" && echo "$(2)  $$work/$(3).tgz" | sha256sum -c --status || \
		give_up "the sha256 of $(1) is not $(2)"; \
	tar -xzf "$$work/$(3).tgz" -C "$$work/$(3)" || give_up "cannot unpack $(1)"

viewer: ## fetch the viewer of splats that refer-report puts into its page (npm)
	@[ ! -f "$(VIEWER_CACHE)/spark.module.min.js" ] || exit 0; \
	give_up() { echo "viewer: $$1" >&2; exit 1; }; \
	command -v npm >/dev/null 2>&1 || give_up "npm is not installed, so it cannot be fetched"; \
	mkdir -p "$(VIEWER_CACHE)" && work=$$(mktemp -d "$(VIEWER_CACHE)/fetch.XXXXXX") || give_up "cannot write $(VIEWER_CACHE)"; \
	trap 'rm -rf "$$work"' EXIT; \
	echo "fetching $(SPARK_PACKAGE) and $(THREE_PACKAGE) into $(VIEWER_CACHE)"; \
	$(call fetch,$(THREE_PACKAGE),$(THREE_SHA256),three); \
	$(call fetch,$(SPARK_PACKAGE),$(SPARK_SHA256),spark); \
	cd "$$work/three/package" && cp build/three.core.min.js build/three.module.min.js examples/jsm/controls/OrbitControls.js \
		examples/jsm/postprocessing/Pass.js "$(VIEWER_CACHE)" && cp LICENSE "$(VIEWER_CACHE)/LICENSE.three" && \
		cp "$$work/spark/package/LICENSE" "$(VIEWER_CACHE)/LICENSE.spark" && \
		cp "$$work/spark/package/dist/spark.module.min.js" "$(VIEWER_CACHE)" || give_up "the packages lack what they had"
