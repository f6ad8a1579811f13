# Helpers of the format tests.

# st FILE HEADER [HEX]: a safetensors file of that header and those data.
st() {
	local LC_ALL=C length
	length=$(printf '%016x' ${#2})
	{
		printf '%s' "$length" | fold -w2 | tac | tr -d '\n' | xxd -r -p
		printf '%s' "$2"
		printf '%s' "${3:-}" | xxd -r -p
	} >"$1"
}

# says STATUS LINE COMMAND...: the command ends so, and prints exactly this on stdout and stderr together.
says() {
	local expected_status=$1 expected=$2 printed status=0
	shift 2
	printed=$("$@" 2>&1 </dev/null) || status=$?
	[ $status = "$expected_status" ] && [ "$printed" = "$expected" ] && return
	printf 'expected %s: %s\n     got %s: %s\n' "$expected_status" "$expected" $status "$printed"
	return 1
}
