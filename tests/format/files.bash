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

# Single-precision 0, 0.5, 1, NaN, infinity and -1, as the files have them.
f0=00000000 fhalf=0000003f f1=0000803f fnan=0000c07f finf=0000807f fminus=000080bf

# splats FILE [NAME=VALUE]...: refer.splats of one Gaussian. VALUE replaces a tensor's data (hexadecimal), or with the
# names meta and header the metadata after format and version, or the tensors' part of the header.
splats() {
	local file=$1 assignment
	local means=$f0$f0$f0 scales=$fhalf$fhalf$fhalf quats=$f1$f0$f0$f0 opacities=$f1 sh=$f0$f0$f0 meta= header
	header='"means":{"dtype":"F32","shape":[1,3],"data_offsets":[0,12]}
		"scales":{"dtype":"F32","shape":[1,3],"data_offsets":[12,24]}
		"quats":{"dtype":"F32","shape":[1,4],"data_offsets":[24,40]}
		"opacities":{"dtype":"F32","shape":[1],"data_offsets":[40,44]}
		"sh":{"dtype":"F32","shape":[1,1,3],"data_offsets":[44,56]}'
	header=$(tr -d '\t' <<<"$header" | tr '\n' , | sed 's/,$//')
	shift
	for assignment; do local "${assignment%%=*}=${assignment#*=}"; done
	header="{\"__metadata__\":{\"format\":\"refer.splats\",\"version\":\"1\"$meta},$header}"
	while (((8 + ${#header}) % 4)); do header+=' '; done
	st "$file" "$header" "$means$scales$quats$opacities$sh"
}

# view [KEY=VALUE]...: a view of a scene's cameras.json; VALUE is JSON, an empty one leaves the key out.
view() {
	local keys=(name width height fx fy cx cy world_to_camera split image time lens) key assignment line=
	local -A value=([name]='"v1"' [width]=4 [height]=3 [fx]=5 [fy]=5 [cx]=2 [cy]=1.5
		[world_to_camera]='[[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]]' [split]='"train"' [image]=null [time]= [lens]=)
	for assignment; do value[${assignment%%=*}]=${assignment#*=}; done
	for key in "${keys[@]}"; do
		[ -z "${value[$key]}" ] || line+=${line:+,}\"$key\":${value[$key]}
	done
	printf '{%s}' "$line"
}

# scene DIR: the smallest scene.
scene() {
	mkdir -p "$1"
	splats "$1/splats.safetensors"
	printf '[%s]\n' "$(view)" >"$1/cameras.json"
}
