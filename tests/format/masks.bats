#!/usr/bin/env bats
# Mask records: formats/records/masks.md, row by row.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load files
	cd "$BATS_TEST_TMPDIR"
	mask='"segmentation":{"size":[2,3],"counts":"132"}'
}

# refuses REASON RECORD: on line 2, after a good record
refuses() {
	printf '%s\n' "{\"view\":\"v\",\"object\":\"o\",$mask}" "$2" >x.jsonl
	says 3 "pseudomask-select: x.jsonl:2: $1" "$BIN/pseudomask-select" x.jsonl
}

# reads EXPECTED SEGMENTATION: what comes out for that mask
reads() {
	says 0 "{\"view\":\"v\",\"object\":\"o\",\"segmentation\":$1}" \
		"$BIN/pseudomask-select" <(echo "{\"view\":\"v\",\"object\":\"o\",$2}")
}

@test "a record comes back to the byte" {
	cat >x.jsonl <<-'END'
	{"view":"v1","ref":"r1","score":0.83,"segmentation":{"size":[2,3],"counts":"132"}}
	{"view":"v \"2\" \\ ü","ref":"r1","score":0.3000000000000001,"segmentation":{"size":[1,1],"counts":"01"}}
	{"view":"v2","ref":"r1","score":0.5,"visible":0.125,"segmentation":{"size":[1,1],"counts":"01"}}
	{"view":"v3","ref":"r1","score":1e+30,"segmentation":{"size":[65536,65535],"counts":"0PPPnoo3"}}
	END
	"$BIN/pseudomask-select" --method top1 x.jsonl | cmp x.jsonl -
}

@test "a peak and boxes come back, corners in order" {
	printf '%s\n' "{\"view\":\"v\",\"object\":\"o\",\"peak\":[1.5,30],\"boxes\":[[3,0,1,2],[0,1,0.25,4]],$mask}" \
		"{\"view\":\"w\",\"object\":\"o\",\"peak\":null,\"boxes\":null,$mask}" "{\"view\":\"x\",\"object\":\"o\",\"boxes\":[],$mask}" >x.jsonl
	"$BIN/mask-import" -o y.jsonl x.jsonl
	sed 's/\[3,0,1,2\]/[1,0,3,2]/; s/"peak":null,"boxes":null,//; s/"boxes":\[\],//' x.jsonl | cmp - y.jsonl
	"$BIN/mask-import" -o - y.jsonl | cmp y.jsonl -
}

@test "a peak and boxes that are none" {
	for peak in 1 '[1]' '[1,2,3]' '[1,"2"]' '[1,1e999]' '{"x":1,"y":2}'; do
		refuses "key 'peak' is not [column,row]" "{\"view\":\"v\",\"object\":\"p\",\"peak\":$peak,$mask}"
	done
	refuses "key 'boxes' is not a list" "{\"view\":\"v\",\"object\":\"p\",\"boxes\":3,$mask}"
	for box in 1 '[1,2,3]' '[1,2,3,null]' '[1,2,3,4,5]'; do
		refuses "key 'boxes': item 1 is not [left,top,right,bottom]" "{\"view\":\"v\",\"object\":\"p\",\"boxes\":[[1,2,3,4],$box],$mask}"
	done
}

@test "counts as COCO's list, and keys of COCO that we do not need" {
	reads '{"size":[2,3],"counts":"132"}' '"segmentation":{"size":[2,3],"counts":[1,3,2]},"area":3,"bbox":[0,0,1,1]'
	reads '{"size":[2,3],"counts":"06"}' '"segmentation":{"counts":[0,6],"size":[2,3]},"path":null,"score":null'
}

@test "path names a PNG beside the file, whatever the current folder" {
	mkdir -p sub
	# 3x2, grey: columns 0, 1, 0
	echo iVBORw0KGgoAAAANSUhEUgAAAAMAAAACCAAAAAC4HznGAAAADklEQVR4nGNgYGRgAGIAABAAAxdBlLwAAAAASUVORK5CYII= |
		base64 -d >sub/m.png
	echo '{"view":"v","object":"o","path":"m.png"}' >sub/x.jsonl
	says 0 '{"view":"v","object":"o","segmentation":{"size":[2,3],"counts":"222"}}' \
		"$BIN/pseudomask-select" sub/x.jsonl
	(cd sub && "$BIN/pseudomask-select" <x.jsonl | grep -q '"counts":"222"')
	echo "{\"view\":\"v\",\"object\":\"o\",\"path\":\"$PWD/sub/m.png\"}" | "$BIN/pseudomask-select" | grep -q '"counts":"222"'
}

@test "path: what is not in the folder of the file is refused, unless a link there or standard input allows it" {
	mkdir -p sub/in
	for name in /etc/x.png ../x.png in/../../x.png; do
		echo "{\"view\":\"v\",\"object\":\"o\",\"path\":\"$name\"}" >sub/x.jsonl
		says 3 "pseudomask-select: sub/x.jsonl:1: key 'path': '$name' is not in the folder of this file" "$BIN/pseudomask-select" sub/x.jsonl
	done
	ln -s ../.. sub/in/link
	echo '{"view":"v","object":"o","path":"in/link/x.png"}' >sub/x.jsonl
	says 4 "pseudomask-select: sub/in/link/x.png: No such file or directory" "$BIN/pseudomask-select" sub/x.jsonl
	cd sub
	echo '{"view":"v","object":"o","path":"../x.png"}' >x.jsonl
	! "$BIN/pseudomask-select" <x.jsonl 2>err || false
	grep -qx "pseudomask-select: ./../x.png: No such file or directory" err
}

@test "path: a missing, cut or foreign image is named" {
	echo '{"view":"v","object":"o","path":"m.png"}' >x.jsonl
	says 4 "pseudomask-select: ./m.png: No such file or directory" "$BIN/pseudomask-select" x.jsonl
	printf '\x89PNG\r\n\x1a\n\0' >m.png
	says 3 "pseudomask-select: ./m.png: PNG: the file ends too early" "$BIN/pseudomask-select" x.jsonl
	echo GIF89a-and-more >m.png
	says 3 "pseudomask-select: ./m.png: PNG: Not a PNG file" "$BIN/pseudomask-select" x.jsonl
}

@test "not JSON, not an object" {
	refuses "not JSON at column 1" 'view'
	refuses "not JSON at column 14" '{"view":"v",'
	refuses "not a JSON object" '[1,2]'
}

@test "view, ref, object" {
	refuses "key 'view' is missing" "{\"object\":\"o\",$mask}"
	refuses "key 'view' is not a string" "{\"view\":3.5,\"object\":\"o\",$mask}"
	refuses "key 'view' is empty" "{\"view\":\"\",\"object\":\"o\",$mask}"
	refuses "key 'view' is '.' or '..'" "{\"view\":\"..\",\"object\":\"o\",$mask}"
	refuses "key 'view' has a slash" "{\"view\":\"/v\",\"object\":\"o\",$mask}"
	refuses "key 'view' has a control character at byte 1" "{\"view\":\"\\n\",\"object\":\"o\",$mask}"
	refuses 'a NUL character (\u0000) in a string' "{\"view\":\"v\\u0000\",\"object\":\"o\",$mask}"
	refuses "key 'ref' has a control character at byte 1" "{\"view\":\"v\",\"ref\":\"\\u001b\",\"object\":\"o\",$mask}"
	refuses "key 'object' is not UTF-8 at byte 1" "{\"view\":\"v\",\"object\":\"$(printf '\xff')\",$mask}"
	refuses "key 'ref' is not a string" "{\"view\":\"v\",\"ref\":[],\"object\":\"o\",$mask}"
	refuses "key 'ref' is empty" "{\"view\":\"v\",\"ref\":\"\",\"object\":\"o\",$mask}"
	refuses "key 'object' is not a string" "{\"view\":\"v\",\"object\":true,$mask}"
	refuses "neither key 'ref' nor key 'object'" "{\"view\":\"v\",$mask}"
	refuses "neither key 'ref' nor key 'object'" "{\"view\":\"v\",\"ref\":null,$mask}"
}

@test "visible" {
	refuses "key 'visible' is not a number" "{\"view\":\"v\",\"object\":\"o\",\"visible\":\"all\",$mask}"
	refuses "key 'visible' is not within 0 to 1" "{\"view\":\"v\",\"object\":\"o\",\"visible\":1.01,$mask}"
	refuses "key 'visible' is not within 0 to 1" "{\"view\":\"v\",\"object\":\"o\",\"visible\":-0.5,$mask}"
}

@test "score" {
	refuses "key 'score' is not a number" "{\"view\":\"v\",\"object\":\"o\",\"score\":\"0.9\",$mask}"
	refuses "key 'score' is not a number" "{\"view\":\"v\",\"object\":\"o\",\"score\":1e999,$mask}"
}

@test "segmentation and path" {
	o='{"view":"v","object":"o"'
	refuses "neither key 'segmentation' nor key 'path'" "$o}"
	refuses "both key 'segmentation' and key 'path'" "$o,\"path\":\"m.png\",$mask}"
	refuses "key 'path' is not a string" "$o,\"path\":1}"
	refuses "key 'segmentation' is not an object" "$o,\"segmentation\":[[0,0,1,0,1,1]]}"
}

@test "size" {
	o='{"view":"v","object":"o","segmentation":{"counts":"132","size":'
	refuses "key 'segmentation.size' is not [height,width]" '{"view":"v","object":"o","segmentation":{"counts":"132"}}'
	refuses "key 'segmentation.size' is not [height,width]" "$o[2,3,1]}}"
	refuses "key 'segmentation.size' is not [height,width]" "$o[\"2\",3]}}"
	refuses "key 'segmentation.size' is not two whole numbers" "$o[2.5,3]}}"
	refuses "key 'segmentation.size' is not two whole numbers" "${o}[1e10,3]}}"
	refuses "key 'segmentation.size': size 3x0 (width x height) is not within 1 to 65536" "${o}[0,3]}}"
	refuses "key 'segmentation.size': size -3x2 (width x height) is not within 1 to 65536" "${o}[2,-3]}}"
	refuses "key 'segmentation.size': size 65537x2 (width x height) is not within 1 to 65536" "${o}[2,65537]}}"
	refuses "key 'segmentation.size': size 65536x65536 (width x height) has more than 4294967295 pixels" \
		"${o}[65536,65536]}}"
}

@test "counts" {
	o='{"view":"v","object":"o","segmentation":{"size":[2,3],"counts":'
	refuses "key 'segmentation.counts' is not a string or a list" "${o}6}}"
	refuses "key 'segmentation.counts' is not a string or a list" '{"view":"v","object":"o","segmentation":{"size":[2,3]}}'
	refuses "key 'segmentation.counts': offset 1: byte 0x7e is not of a compressed run" "$o\"1~2\"}}"
	refuses "key 'segmentation.counts': offset 2: ends inside a number" "$o\"1P\"}}"
	refuses "key 'segmentation.counts': offset 0: a number of more than 7 characters" "$o\"PPPPPPP0\"}}"
	refuses "key 'segmentation.counts': offset 0: run 0 is -1, not within 0 to 6" "$o\"O\"}}"
	refuses "key 'segmentation.counts': offset 2: run 2 is 9, not within 0 to 6" "$o\"139\"}}"
	refuses "key 'segmentation.counts': the runs sum to 5, but 3x2 has 6 pixels" "$o\"131\"}}"
	refuses "key 'segmentation.counts': the runs sum to 7, but 3x2 has 6 pixels" "$o[1,3,3]}}"
	refuses "key 'segmentation.counts': the runs sum to 0, but 3x2 has 6 pixels" "$o[]}}"
	refuses "key 'segmentation.counts': item 1 is not a whole number in 0 to 4294967295" "$o[1,-3,8]}}"
	refuses "key 'segmentation.counts': item 2 is not a whole number in 0 to 4294967295" "$o[1,3,1.5]}}"
	refuses "key 'segmentation.counts': item 0 is not a whole number in 0 to 4294967295" "$o[\"6\"]}}"
}
