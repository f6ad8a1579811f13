# What the pipelines share: variables that are checked and quoted, and steps that are done again when their command changes.
# Included by the other files, which set `here` to the folder that they are in.

BIN ?= $(if $(wildcard $(here)../build/bin/refer-train),$(here)../build/bin)
BERT ?= $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/refersplat/encoder

# Threads that wait for one another give their processor to other programs.
export OMP_WAIT_POLICY ?= passive

empty :=
space := $(empty) $(empty)
tab := $(empty)	$(empty)
hash := \#
open := (
close := )
define newline


endef

# A text as one word of the shell, whatever is in it; a variable as one; a variable as its words. $(call quote,TEXT),
# $(call quoted,VARIABLE), $(call options,VARIABLE)
quote = '$(subst ','\'',$(1))'
quoted = $(call quote,$($(1)))
options = $(foreach w,$($(1)),$(call quote,$(w)))

# What make or the shell would not take for a part of a file's name.
unsafe := : ; & ' " ` $$ \ * ? [ ] { } < > | ! ~ % = $(hash) $(open) $(close)
found_in = $(if $(findstring $(newline),$(1)),newline,$(if $(findstring $(space),$(1))$(findstring $(tab),$(1)),blank,$(firstword \
	$(foreach c,$(unsafe),$(if $(findstring $(c),$(1)),$(c))))))
refuse = $(error $(called): $(1) has a $(2), which file names cannot have here; use a symbolic link with another name: ln -s OLD NEW)
check_path = $(if $(call found_in,$($(1))),$(call refuse,$(1),$(call found_in,$($(1)))))$(if $(filter -%,$($(1))),$(error \
	$(called): $(1) begins with a dash; write ./$($(1))))
check_line = $(if $(findstring $(newline),$($(1))),$(error $(called): $(1) has a newline))

# What the user gives is taken as it is: no $ in it stands for anything, here or where make exports it. $(call take,VARIABLE)
take = $(if $(filter command environment,$(firstword $(origin $(1)))),$(eval override $(1) := $$(value $(1))))

# What the command line may set besides: of make and the shell, of the programs, and of all pipelines.
others_known := MAKEFLAGS MAKE SHELL HOME PATH TMPDIR XDG_CACHE_HOME OMP_% REFERSPLAT_% V BIN BERT

# Takes the variables: names of files and folders, and others. Stops where one is not known, one that is needed is not set, one
# cannot be used, or check.sh finds that its file cannot be. To be called once, before any of them is looked at. The pipeline that is
# named is the one that was called, which may include others. Another make hands on variables of its own, so what it sets need not be
# known. $(call check,NEEDED,NAMES OF FILES,OTHERS)
define check
$(if $(filter-out 0,$(MAKELEVEL)),,$(foreach v,$(filter-out $(others_known) $(2) $(3),$(.VARIABLES)),$(if $(filter command%,$(origin \
	$(v))),$(call unknown,$(v),$(2) $(3) V BIN BERT))))$(foreach v,$(2) $(3),$(call take,$(v)))$(if $(filter help clean,$(MAKECMDGOALS)),,$(if \
	$(call missing,$(1)),$(error $(called): $(call missing,$(1)) not set$(ways); $(see_help))))$(foreach v,$(2),$(call \
	check_path,$(v)))$(foreach v,$(3),$(call check_line,$(v)))$(if $(filter help clean,$(MAKECMDGOALS)),,$(call check_files,$(2) $(3)))
endef
see_help = 'make -f $(called) help' says what they are
unknown = $(error $(called): $(1) is none of its variables$(call like,$(shell $(here)check.sh --closest $(call quote,$(1)) $(2))); 'make -f $(called) help' lists them)
like = $(if $(1),: did you mean $(1)?)
check_files = $(call stop,$(shell $(here)check.sh $(call quoted,tool_folder) $(foreach v,$(1),$(if $($(v)),$(call quote,$(v)=$($(v)))))))
stop = $(if $(1),$(error $(called): $(1)))
called := $(firstword $(MAKEFILE_LIST))
missing = $(strip $(foreach v,$(1),$(if $($(v)),,$(v))))

tool_folder = $(if $(BIN),$(BIN)/)
tool = $(if $(BIN),$(call quote,$(BIN)/))

# A step is a tool's command line, the variable command.STEP. log/STEP.command, which its results depend on, is what it was
# when they were made, and changes only with it. $(call track,STEPS) finds out which changed.
same = $(if $(subst x$(1),,x$(2))$(subst x$(2),,x$(1)),,same)
track = $(foreach s,$(1),$(if $(call same,$(file <$(SCENE)/log/$(s).command),$(command.$(s))),,$(eval \
	$(SCENE)/log/$(s).command: FORCE)))

# Variables that rules are made from: no character that the shell gives a meaning may be in them. $(call check_plain,VARIABLES)
shell_characters := ; & ' " ` $$ \ * ? [ ] { } < > | ! ~ $(hash) $(open) $(close)
check_plain = $(foreach v,$(1),$(foreach c,$(shell_characters),$(if $(findstring $(c),$($(v))),$(error $(called): $(v) has a $(c)))))

# What is asked of a file that nothing but a command line makes: it holds that line, and is as old as the line.
define keep
@mkdir -p $(@D); printf '%s\n' $(call quote,$(1)) | cmp -s - $@ || printf '%s\n' $(call quote,$(1)) >$@
endef

# $(call log,FILE,COMMAND): the last line of -v, time and memory, stays beside the result.
log = mkdir -p $(dir $(1)) && $(tool)$(2) -v 2>$(1) || { cat $(1) >&2; exit 1; }

# Does a step, which says its name and time as it ends, and its warnings; with V=1 make prints its command too. On a terminal its
# progress shows, while all else that it says goes to log/STEP: -v makes the last line there, time and memory, for the report.
# $(call run,STEP)
hide = $(if $(V),,@)
run = $(hide)mkdir -p $(SCENE)/log && { REFERSPLAT_PROGRESS=3 $(tool)$(command.$(1)) -v 3>&2 2>$(SCENE)/log/$(1) || { cat $(SCENE)/log/$(1) >&2; exit 1; }; } && \
	{ grep ': warning: ' $(SCENE)/log/$(1) >&2; sed -n '$$s/^\([^:]*\): \([0-9.]*\) s, peak memory.*/\1 ($(1)): \2 s/p' $(SCENE)/log/$(1); }

# What gs-import may take for the cameras in a folder. $(call camera_files,FOLDER)
camera_files = $(wildcard $(addprefix $(1)/,cameras.json transforms.json $(foreach d,./ sparse/ sparse/0/,$(foreach f,cameras \
	images,$(d)$(f).bin $(d)$(f).txt))))

.PHONY: FORCE help
.DELETE_ON_ERROR:
.SECONDARY:
