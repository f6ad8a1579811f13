#!/usr/bin/env bats
# mask-export. Options that every tool has are in common.bats.

setup() {
	BIN=${BIN:-$BATS_TEST_DIRNAME/../../build/bin}
	load ../format/files
	cd "$BATS_TEST_TMPDIR"
	# 4 wide, 3 high: the first column; two pixels of the second row; nothing; a run over three columns
	cat >masks.jsonl <<-'END'
		{"view":"v1","ref":"r1","object":"red cup","score":0.5,"segmentation":{"size":[3,4],"counts":[0,3,9]}}
		{"view":"v2","object":"kettle","segmentation":{"size":[3,4],"counts":[4,1,2,1,4]}}
		{"view":"v1","object":"kettle","segmentation":{"size":[3,4],"counts":[12]}}
		{"view":"v2","ref":"a/b","segmentation":{"size":[3,4],"counts":[2,5,5]}}
	END
}

@test "images, categories, and annotations with boxes and areas" {
	"$BIN/mask-export" -o coco.json masks.jsonl
	[ "$(jq -c .images coco.json)" = '[{"id":1,"width":4,"height":3,"file_name":"v1.png"},{"id":2,"width":4,"height":3,"file_name":"v2.png"}]' ]
	[ "$(jq -c .categories coco.json)" = '[{"id":1,"name":"red cup"},{"id":2,"name":"kettle"},{"id":3,"name":"a/b"}]' ]
	[ "$(jq -c '.annotations[] | [.id, .image_id, .category_id, .iscrowd, .area, .bbox, .score, .ref]' coco.json)" = '[1,1,1,0,3,[0,0,1,3],0.5,"r1"]
[2,2,2,0,2,[1,1,2,1],null,null]
[3,1,2,0,0,[0,0,0,0],null,null]
[4,2,3,0,5,[0,0,3,3],null,"a/b"]' ]
	jq -e 'all(.annotations[].segmentation; .size == [3,4] and (.counts | type) == "string")' coco.json
	"$BIN/mask-export" <masks.jsonl | cmp - coco.json
	# the box of a mask in one column
	printf '{"view":"v","object":"o","segmentation":{"size":[5,2],"counts":[6,2,2]}}\n' | "$BIN/mask-export" - | jq -e '.annotations[0].bbox == [1,1,1,2]'
}

@test "mask-import reads it back: the same masks" {
	sed '3d; s/"ref":"a\/b"/"object":"plate"/' masks.jsonl >some.jsonl
	"$BIN/mask-export" -o coco.json some.jsonl
	"$BIN/mask-import" -o back.jsonl coco.json
	same() { jq -c '[.view, .object // .ref, .segmentation]' "$1" | sort; }
	"$BIN/gs-check" back.jsonl
	printf '{"view":"v1","object":"red cup"}\n{"view":"v2","object":"kettle"}\n{"view":"v2","object":"plate"}\n' >names
	[ "$(jq -c '{view, object}' back.jsonl)" = "$(cat names)" ]
	"$BIN/miou-score" --json --truth <(jq -c 'del(.ref, .score)' some.jsonl) back.jsonl | jq -e '.miou == 1 and .pairs == 3'
	"$BIN/mask-export" back.jsonl | jq -c '.annotations[].segmentation.counts' | cmp - <(jq -c '.annotations[].segmentation.counts' coco.json)
}

@test "names of photographs from a scene" {
	printf '[%s,%s]\n' "$(view 'name="v1"' 'image="../pictures/IMG 7.JPG"')" "$(view 'name="v9"')" >cameras.json
	mkdir scene
	mv cameras.json scene
	"$BIN/mask-export" --scene scene masks.jsonl | jq -c '[.images[].file_name]' >names
	[ "$(cat names)" = '["IMG 7.JPG","v2.png"]' ]
	# views of one file's name in two folders: as many folders as mask-import needs for the same views
	printf '[%s,%s]\n' "$(view 'name="a_0"' 'image="../pictures/a/0.png"')" "$(view 'name="b_0"' 'image="../pictures/b/0.png"')" >scene/cameras.json
	for view in a_0 b_0; do printf '{"view":"%s","object":"cup","segmentation":{"size":[3,4],"counts":[0,12]}}\n' $view; done >two.jsonl
	"$BIN/mask-export" --scene scene -o coco.json two.jsonl
	[ "$(jq -c '[.images[].file_name]' coco.json)" = '["a/0.png","b/0.png"]' ]
	[ "$("$BIN/mask-import" coco.json | jq -r .view | tr '\n' ' ')" = "a_0 b_0 " ]
	says 4 "mask-export: none/cameras.json: No such file or directory" "$BIN/mask-export" --scene none masks.jsonl
}

@test "--png: a picture of each, by sentence or object" {
	"$BIN/mask-export" --png tree -o coco.json masks.jsonl
	[ "$(find tree -type f | sort)" = "tree/v1/kettle.png
tree/v1/r1.png
tree/v2/a%2Fb.png
tree/v2/kettle.png" ]
	# read as a painting it is the mask again
	mkdir painted
	cp tree/v2/kettle.png painted/v2.png
	printf '255 kettle\n' >names
	"$BIN/mask-import" --names names painted/v2.png | jq -c .segmentation >back
	"$BIN/mask-import" --names names painted/v2.png >back.jsonl
	"$BIN/miou-score" --json --truth <(sed -n 2p masks.jsonl) back.jsonl | jq -e '.miou == 1 and .pairs == 1'
}

@test "what cannot be written so" {
	printf '%s\n' '{"view":"v","object":"o","segmentation":{"size":[3,4],"counts":[12]}}' '{"view":"v","object":"p","segmentation":{"size":[4,3],"counts":[12]}}' >sizes
	says 3 "mask-export: sizes: view 'v' has masks of 4x3 and of 3x4" "$BIN/mask-export" -o out sizes
	printf '%s\n' '{"view":"v","object":"o","segmentation":{"size":[3,4],"counts":[12]}}' '{"view":"v","object":"o","segmentation":{"size":[3,4],"counts":[12]}}' >twice
	says 3 "mask-export: twice: view 'v' has two masks of 'o', which would be one PNG" "$BIN/mask-export" --png tree -o out twice
	[ ! -e out ] && [ ! -e tree ]
	"$BIN/mask-export" twice | jq -e '.annotations | length == 2'
	echo '{' >broken
	run "$BIN/mask-export" -o out broken
	[ "$status" = 3 ] && [ ! -e out ]
	says 2 "mask-export: -o masks.jsonl would overwrite MASKS masks.jsonl
Try 'mask-export --help'." "$BIN/mask-export" -o masks.jsonl masks.jsonl
}
