# `make fuzz`: included by the Makefile.

# Names of the targets of tests/fuzz/reader.c.
READERS := $(shell sed -n 's/^	{"\([a-z-]*\)", try_.*/\1/p' tests/fuzz/reader.c)
FUZZ := -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
SECONDS ?= 60

fuzz: packages ## feed broken files to every reader, each for SECONDS=60; TARGETS="ply text" for some (clang's libFuzzer, else a plain loop)
	-$(call need,clang=clang)
	@if echo 'int LLVMFuzzerTestOneInput(const char *, long); int LLVMFuzzerTestOneInput(const char *d, long n) { return !d && !n; }' | \
		clang -fsanitize=fuzzer,address -x c -o /dev/null - 2>/dev/null; then \
		$(MAKE) --no-print-directory $(PARALLEL) -s BUILD=build-fuzz CC=clang CFLAGS="-O1 -g -fno-omit-frame-pointer $(FUZZ)" OPENMP= \
			CPPFLAGS="-idirafter $$(gcc -print-file-name=include)" WARNINGS=-Wno-unknown-pragmas LDLIBS="$(LDLIBS) -lgomp" \
			LDFLAGS=-L$$(dirname $$(gcc -print-file-name=libgomp.so)) LIBFUZZER=-fsanitize=fuzzer tools readers && \
			tests/fuzz/run.sh build-fuzz $(SECONDS) $(TARGETS); \
	else \
		$(MAKE) --no-print-directory $(PARALLEL) -s BUILD=build-asan CFLAGS="-O1 -g -fno-omit-frame-pointer $(SANITIZE)" tools readers && \
			tests/fuzz/run.sh build-asan $(SECONDS) $(TARGETS); \
	fi

readers: $(READERS:%=$(BUILD)/fuzz/reader-%)

# With a plain loop in place of libFuzzer, unless that is linked.
LIBFUZZER :=
FUZZ_MAIN := $(if $(LIBFUZZER),,plain mutate)
$(BUILD)/fuzz/reader: $(BUILD)/obj/tests/fuzz/reader.o $(FUZZ_MAIN:%=$(BUILD)/obj/tests/fuzz/%.o) $(LIBRARY)
	@mkdir -p $(@D)
	$(LINK) $(LIBFUZZER) -o $@ $^ $(LDLIBS) -lpthread

$(BUILD)/fuzz/reader-%: $(BUILD)/fuzz/reader
	@ln -f $< $@
