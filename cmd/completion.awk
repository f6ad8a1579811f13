# How a shell completes a tool's command line, made of its --help: TOOL --help | awk -v tool=TOOL -v shell=bash|zsh -f cmd/completion.awk
# An option's argument is one of its choices, or a file where it is called by a word in capitals (a folder: DIR), else it is
# not completed. Operands are files.

# A row of the table, and the lines that go on with what it says.
/^ +-/ {
	n++
	letter[n] = sub(/^  -/, "") ? substr($0, 1, 1) : ""
	sub(/^[^-]*--/, "")
	name[n] = $1
	sub(/^[^ ]+ ?/, "")
	argument[n] = /^[^ ]/ ? $1 : ""
	sub(/^[^ ]+/, "")
}
n && !/^Usage/ {
	sub(/^ +/, "")
	help[n] = help[n] (help[n] != "" && $0 != "" ? " " : "") $0
}

# CHOICES of an option, or what its argument is: "" where it has none.
function kind_of(i) {
	if (argument[i] == "" || argument[i] == "DIR")
		return argument[i]
	if (argument[i] ~ /^[a-z0-9+-]+([|][a-z0-9+-]+)+$/)
		return "CHOICES"
	return argument[i] ~ /^[A-Z][A-Z]+$/ && argument[i] != "MIB" ? "FILE" : "NOTHING"
}

function choices(i, text) {
	text = argument[i]
	gsub(/[|]/, " ", text)
	return text
}

function pattern(i) {
	return "--" name[i] (letter[i] == "" ? "" : " | -" letter[i])
}

function completed(how) {
	return "mapfile -t COMPREPLY < <(compgen " how " -- \"$cur\")"
}

function print_arm(kind, action, i, all) {
	for (i = 1; i <= n; i++)
		if (kind_of(i) == kind)
			all = all (all == "" ? "" : " | ") pattern(i)
	if (all != "")
		printf "\t%s)\n\t\t%s\n\t\treturn\n\t\t;;\n", all, action
}

function print_bash(i, all) {
	gsub(/-/, "_", own)
	printf "# Completion of %s for bash, made of its table of options.\n_%s()\n{\n", tool, own
	print "\tlocal cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]}\n\t# --option=argument is three words"
	print "\tif [[ $cur == = ]]; then\n\t\tcur=\n\telif [[ $prev == = ]]; then\n\t\tprev=${COMP_WORDS[COMP_CWORD - 2]}\n\tfi"
	print "\tCOMPREPLY=()\n\tcase $prev in"
	for (i = 1; i <= n; i++)
		if (kind_of(i) == "CHOICES")
			printf "\t%s)\n\t\t%s\n\t\treturn\n\t\t;;\n", pattern(i), completed("-W '" choices(i) "'")
	print_arm("FILE", completed("-f"))
	print_arm("DIR", completed("-d"))
	print_arm("NOTHING", "compopt +o default 2>/dev/null")
	for (i = 1; i <= n; i++)
		all = all (i > 1 ? " " : "") "--" name[i]
	printf "\tesac\n\tif [[ $cur == -* ]]; then\n\t\t%s\n\telse\n\t\t%s\n\tfi\n}\n", completed("-W '" all "'"), completed("-f")
	printf "complete -o filenames -F _%s %s\n", own, tool
}

# Within single quotes and brackets, where a colon is no end.
function quoted(text) {
	gsub(/\[|\]|:|\\/, "\\\\&", text)
	gsub(/'/, "'\\''", text)
	return text
}

# One word of _arguments for one name of an option.
function print_word(i, dashes, called, kind) {
	kind = kind_of(i)
	printf " \\\n\t'*%s%s%s[%s]", dashes, called, kind == "" ? "" : dashes == "--" ? "=" : "+", quoted(help[i])
	if (kind != "")
		printf ":%s:%s", quoted(argument[i]), kind == "CHOICES" ? "(" choices(i) ")" : kind == "FILE" ? "_files" : kind == "DIR" ? "_files -/" : " "
	printf "'"
}

function print_zsh(i) {
	printf "#compdef %s\n# Completion of %s for zsh, made of its table of options.\n_arguments -s -S", tool, tool
	for (i = 1; i <= n; i++) {
		print_word(i, "--", name[i])
		if (letter[i] != "")
			print_word(i, "-", letter[i])
	}
	print " \\\n\t'*:file:_files'"
}

END {
	own = tool
	if (shell == "bash")
		print_bash()
	else
		print_zsh()
}
