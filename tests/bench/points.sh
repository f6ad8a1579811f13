#!/usr/bin/env bash
# Gives a scene of gs-synth the points that COLMAP would find: a place at every tenth Gaussian, of its colour. usage: points.sh DIR
width=$(($(grep -ac '^property float' "$1/point_cloud.ply") * 4))
tail -c +$(($(grep -abo end_header "$1/point_cloud.ply" | head -n 1 | cut -d: -f1) + 12)) "$1/point_cloud.ply" | od -A n -v -t f4 -w$width |
	awk 'function byte(x) { x = int(255 * (0.5 + 0.28209479 * x)); return x < 0 ? 0 : x > 255 ? 255 : x }
		NR % 10 == 1 { print NR, $1, $2, $3, byte($7), byte($8), byte($9), 0.5 }' >"$1/sparse/0/points3D.txt"
