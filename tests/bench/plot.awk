# Draws an SVG line or scatter plot: awk -f plot.awk data.tsv >plot.svg
#
# Fields are separated by tabs. A line is a point, and everything after y may be empty or left out:
#	SERIES  X  Y  [Y_LOW  Y_HIGH  [X_LOW  X_HIGH  [LABEL]]]
# Lines that begin with # say how:
#	#title  TEXT          #note  TEXT (below the title)
#	#xlabel TEXT          #ylabel TEXT              with the unit
#	#xlog                 #ylog                     logarithmic axis; points that are not above 0 are left out
#	#xzero                #yzero                    a linear axis begins at 0
#	#style  SERIES STYLE                            line (default: from left to right), path (a line through the points as
#	                                                they come), points, dashed (a line without markers)
#	#ref    Y  TEXT                                 a level to compare with
#	#xref   X  TEXT
# Series are drawn, coloured and listed in the order in which a point or a #style first names them; one without points has
# its colour, so that several plots can agree, and is not listed.
BEGIN {
	FS = "\t"
	left = 82; top = 64; plot_w = 560; plot_h = 360; bottom = 64
	size = 13; char_w = 7.8; small = 11.5; small_w = 7
	split("#0072B2 #D55E00 #009E73 #CC79A7 #B8860B #56B4E9 #7B3294 #8C564B #5F9E2F #222222", colour, " ")
	colours = 10
}

/^#/ {
	if ($1 == "#style") { style[$2] = $3; number($2) }
	else if ($1 == "#ref" || $1 == "#xref") { refs++; ref_axis[refs] = $1 == "#ref" ? "y" : "x"; ref_at[refs] = $2 + 0; ref_text[refs] = $3 }
	else set[substr($1, 2)] = NF > 1 ? $2 : 1
	next
}

NF >= 3 {
	n++
	of[n] = number($1); x[n] = $2 + 0; y[n] = $3 + 0
	y_low[n] = $4 == "" ? y[n] : $4 + 0; y_high[n] = $5 == "" ? y[n] : $5 + 0
	x_low[n] = $6 == "" ? x[n] : $6 + 0; x_high[n] = $7 == "" ? x[n] : $7 + 0
	label[n] = $8
	if (("xlog" in set && x_low[n] <= 0) || ("ylog" in set && y_low[n] <= 0)) n--
}

# A series' number; a new one gets the next.
function number(s) {
	if (!(s in index_of)) { index_of[s] = ++series; name[series] = s }
	return index_of[s]
}

function escape(s) { gsub(/&/, "\\&amp;", s); gsub(/</, "\\&lt;", s); gsub(/>/, "\\&gt;", s); return s }
function min(a, b) { return a < b ? a : b }
function max(a, b) { return a > b ? a : b }
function log10(v) { return log(v) / log(10) }
function floor(v, i) { i = int(v); return i > v ? i - 1 : i }

function text(px, py, anchor, s, extra) {
	printf "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" %s>%s</text>\n", px, py, anchor, extra, escape(s)
}

function segment(x1, y1, x2, y2, extra) {
	printf "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x1, y1, x2, y2, extra
}

# A number as a tick has it: 2.5, 500, 25k, 1.5M.
function short(v, a) {
	a = v < 0 ? -v : v
	if (a >= 999999.5) return sprintf("%gM", v / 1e6)
	if (a >= 9999.5) return sprintf("%gk", v / 1e3)
	if (a < 1e-9) return "0"
	return sprintf("%.4g", v)
}

# The largest of 1, 2 and 5 times a power of ten that is at most v (up: the least that is at least v).
function nice(v, up, power, m) {
	power = 10 ^ floor(log10(v) + 1e-9)
	m = v / power
	if (up) return power * (m <= 1 + 1e-9 ? 1 : m <= 2 + 1e-9 ? 2 : m <= 5 + 1e-9 ? 5 : 10)
	return power * (m >= 5 - 1e-9 ? 5 : m >= 2 - 1e-9 ? 2 : 1)
}

# Bounds and ticks of an axis that shows lo to hi: begin[axis], end[axis], ticks[axis], tick[axis, i].
function make_axis(axis, lo, hi, v, step, power, i) {
	ticks[axis] = 0
	if ((axis "log") in set) {
		begin[axis] = nice(lo, 0); end[axis] = nice(hi, 1)
		if (begin[axis] == end[axis]) end[axis] = nice(hi * 1.5, 1)
		for (power = floor(log10(begin[axis]) + 1e-9); 10 ^ power <= end[axis] * 1.000001; power++)
			for (i = 1; i < 10; i++) {
				v = i * 10 ^ power
				if (v < begin[axis] * 0.999999 || v > end[axis] * 1.000001) continue
				if (i == 1 || (end[axis] / begin[axis] < 2000 && (i == 2 || i == 5))) tick[axis, ++ticks[axis]] = v
				else minor[axis, ++minors[axis]] = v
			}
		return
	}
	if ((axis "zero") in set && lo > 0) lo = 0
	if (hi <= lo) { hi = lo + (lo ? (lo < 0 ? -lo : lo) * 0.1 : 1); if (lo) lo -= hi - lo }
	else { step = (hi - lo) * 0.04; if (lo != 0) lo -= step; hi += step }
	step = nice((hi - lo) / 5, 1)
	if ((hi - lo) / step < 3.5) step = nice((hi - lo) / 8, 1)
	begin[axis] = floor(lo / step + 1e-9) * step
	end[axis] = -floor(-hi / step + 1e-9) * step
	for (i = 0; begin[axis] + i * step <= end[axis] + step / 2; i++) tick[axis, ++ticks[axis]] = begin[axis] + i * step
}

function share(axis, v) {
	if ((axis "log") in set) return log(v / begin[axis]) / log(end[axis] / begin[axis])
	return (v - begin[axis]) / (end[axis] - begin[axis])
}
function at_x(v) { return left + plot_w * share("x", v) }
function at_y(v) { return top + plot_h * (1 - share("y", v)) }

function marker(s, px, py, extra, r, shape) {
	extra = "fill=\"" colour[(s - 1) % colours + 1] "\" stroke=\"white\" stroke-width=\"1\""
	r = 4.5; shape = (s - 1) % 4
	if (shape == 0) printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" %s/>\n", px, py, r, extra
	else if (shape == 1) printf "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" %s/>\n", px - 4, py - 4, 8, 8, extra
	else if (shape == 2) printf "<polygon points=\"%.1f,%.1f %.1f,%.1f %.1f,%.1f\" %s/>\n", px, py - 5.5, px + 5, py + 4, px - 5, py + 4, extra
	else printf "<polygon points=\"%.1f,%.1f %.1f,%.1f %.1f,%.1f %.1f,%.1f\" %s/>\n", px, py - 5.5, px + 5.5, py, px, py + 5.5, px - 5.5, py, extra
}

# What labels keep clear of: boxes of x1, y1, x2, y2, and how bad it is to lie on one.
function occupy(x1, y1, x2, y2, cost) {
	boxes++
	box[boxes, 1] = x1; box[boxes, 2] = y1; box[boxes, 3] = x2; box[boxes, 4] = y2; box_cost[boxes] = cost
}

# Small boxes along a stroke.
function occupy_line(x1, y1, x2, y2, steps, i) {
	steps = int(max(x2 > x1 ? x2 - x1 : x1 - x2, y2 > y1 ? y2 - y1 : y1 - y2) / 6) + 1
	for (i = 0; i <= steps; i++)
		occupy(x1 + (x2 - x1) * i / steps - 1, y1 + (y2 - y1) * i / steps - 1, x1 + (x2 - x1) * i / steps + 1, y1 + (y2 - y1) * i / steps + 1, 3)
}

function clash(x1, y1, x2, y2, cost, i) {
	cost = 0
	if (x1 < left + 2 || x2 > left + plot_w - 2 || y1 < top + 2 || y2 > top + plot_h - 2) cost = 500
	for (i = 1; i <= boxes; i++)
		if (x1 < box[i, 3] && x2 > box[i, 1] && y1 < box[i, 4] && y2 > box[i, 2]) cost += box_cost[i]
	return cost
}

# Puts a label beside a point, where it covers least; far ones get a hair line to their point.
function place(px, py, s, ink, w, h, best, cost, d, k, lx, ly, bx, by, far) {
	w = length(s) * small_w; h = 12; best = 1e9
	for (d = 0; d < 4; d++)
		for (k = 0; k < 12; k++) {
			lx = px + cos(k * 0.5235988) * (8 + d * 12) + (cos(k * 0.5235988) - 1) / 2 * w
			ly = py + sin(k * 0.5235988) * (10 + d * 11) - h / 2
			cost = clash(lx, ly, lx + w, ly + h) + d * 1.5 + (k % 3 ? 0.5 : 0)
			if (cost < best) { best = cost; bx = lx; by = ly; far = d }
		}
	if (far > 1) segment(px, py, min(max(px, bx), bx + w), py < by ? by : py > by + h ? by + h : py, "stroke=\"" ink "\" stroke-width=\"0.6\"")
	text(bx, by + h - 2.5, "start", s, "font-size=\"" small "\" fill=\"" ink "\"")
	occupy(bx, by, bx + w, by + h, 40)
}

function bounds(i, lo_x, hi_x, lo_y, hi_y) {
	lo_x = lo_y = 1e300; hi_x = hi_y = -1e300
	for (i = 1; i <= n; i++) {
		lo_x = min(lo_x, x_low[i]); hi_x = max(hi_x, x_high[i]); lo_y = min(lo_y, y_low[i]); hi_y = max(hi_y, y_high[i])
	}
	for (i = 1; i <= refs; i++)
		if (ref_axis[i] == "y") { lo_y = min(lo_y, ref_at[i]); hi_y = max(hi_y, ref_at[i]) }
		else { lo_x = min(lo_x, ref_at[i]); hi_x = max(hi_x, ref_at[i]) }
	make_axis("x", lo_x, hi_x); make_axis("y", lo_y, hi_y)
}

function draw_axes(i, p, last) {
	for (i = 1; i <= minors["x"]; i++) segment(at_x(minor["x", i]), top + plot_h, at_x(minor["x", i]), top + plot_h + 3, "stroke=\"#888888\"")
	for (i = 1; i <= minors["y"]; i++) segment(left - 3, at_y(minor["y", i]), left, at_y(minor["y", i]), "stroke=\"#888888\"")
	for (i = 1; i <= ticks["x"]; i++) {
		p = at_x(tick["x", i])
		segment(p, top, p, top + plot_h, "stroke=\"#e4e4e4\"")
		segment(p, top + plot_h, p, top + plot_h + 5, "stroke=\"#444444\"")
		text(p, top + plot_h + 19, "middle", short(tick["x", i]), "")
	}
	for (i = 1; i <= ticks["y"]; i++) {
		p = at_y(tick["y", i])
		segment(left, p, left + plot_w, p, "stroke=\"#e4e4e4\"")
		segment(left - 5, p, left, p, "stroke=\"#444444\"")
		text(left - 9, p + 4.5, "end", short(tick["y", i]), "")
	}
	segment(left, top + plot_h, left + plot_w, top + plot_h, "stroke=\"#444444\"")
	segment(left, top, left, top + plot_h, "stroke=\"#444444\"")
	text(left, 26, "start", set["title"], "font-size=\"16\" font-weight=\"bold\"")
	text(left, 46, "start", set["note"], "font-size=\"" small "\" fill=\"#555555\"")
	text(left + plot_w / 2, top + plot_h + 46, "middle", set["xlabel"], "")
	p = top + plot_h / 2
	printf "<text transform=\"matrix(0,-1,1,0,24,%.1f)\" text-anchor=\"middle\">%s</text>\n", p, escape(set["ylabel"])
}

function draw_refs(i, p) {
	for (i = 1; i <= refs; i++)
		if (ref_axis[i] == "y") {
			p = at_y(ref_at[i])
			segment(left, p, left + plot_w, p, "stroke=\"#777777\" stroke-width=\"1.2\" stroke-dasharray=\"7,4\"")
			occupy(left, p - 1, left + plot_w, p + 1, 9)
		} else {
			p = at_x(ref_at[i])
			segment(p, top, p, top + plot_h, "stroke=\"#777777\" stroke-width=\"1.2\" stroke-dasharray=\"7,4\"")
			occupy(p - 1, top, p + 1, top + plot_h, 9)
		}
}

# Names a level at an end of its line, above or below (left or right) of it, where that covers least.
function name_ref(i, p, w, k, x1, y1, bx, by, cost, best, end) {
	w = length(ref_text[i]) * small_w; best = 1e9
	p = ref_axis[i] == "y" ? at_y(ref_at[i]) : at_x(ref_at[i])
	for (k = 0; k < 4; k++) {
		x1 = ref_axis[i] == "y" ? (k < 2 ? left + plot_w - 6 - w : left + 6) : (k % 2 ? p - 5 - w : p + 5)
		y1 = ref_axis[i] == "y" ? (k % 2 ? p + 3 : p - 16) : (k < 2 ? top + 3 : top + plot_h - 18)
		cost = clash(x1, y1, x1 + w, y1 + 13) + k
		if (cost < best) { best = cost; bx = x1; by = y1; end = ref_axis[i] == "y" ? k < 2 : k % 2 }
	}
	text(end ? bx + w : bx, by + 10.5, end ? "end" : "start", ref_text[i], "font-size=\"" small "\" fill=\"#555555\"")
	occupy(bx, by, bx + w, by + 13, 40)
}

# The points of a series in order of x (equal ones, and a path's, as they came), in order[1..count].
function sort_series(s, i, j, count, held) {
	count = 0
	for (i = 1; i <= n; i++) {
		if (of[i] != s) continue
		for (j = count++; j > 0 && x[order[j]] > x[i] && style[name[s]] != "path"; j--) order[j + 1] = order[j]
		order[j + 1] = i
	}
	return count
}

function draw_line(s, count, i, ink, a, b) {
	ink = colour[(s - 1) % colours + 1]
	for (i = 1; i <= count; i++) {
		a = order[i]
		if (y_low[a] < y_high[a]) {
			segment(at_x(x[a]), at_y(y_low[a]), at_x(x[a]), at_y(y_high[a]), "stroke=\"" ink "\" stroke-width=\"1.3\" stroke-opacity=\"0.7\"")
			segment(at_x(x[a]) - 4, at_y(y_low[a]), at_x(x[a]) + 4, at_y(y_low[a]), "stroke=\"" ink "\" stroke-width=\"1.3\" stroke-opacity=\"0.7\"")
			segment(at_x(x[a]) - 4, at_y(y_high[a]), at_x(x[a]) + 4, at_y(y_high[a]), "stroke=\"" ink "\" stroke-width=\"1.3\" stroke-opacity=\"0.7\"")
			occupy_line(at_x(x[a]), at_y(y_low[a]), at_x(x[a]), at_y(y_high[a]))
		}
		if (x_low[a] < x_high[a]) {
			segment(at_x(x_low[a]), at_y(y[a]), at_x(x_high[a]), at_y(y[a]), "stroke=\"" ink "\" stroke-width=\"1.3\" stroke-opacity=\"0.7\"")
			segment(at_x(x_low[a]), at_y(y[a]) - 4, at_x(x_low[a]), at_y(y[a]) + 4, "stroke=\"" ink "\" stroke-width=\"1.3\" stroke-opacity=\"0.7\"")
			segment(at_x(x_high[a]), at_y(y[a]) - 4, at_x(x_high[a]), at_y(y[a]) + 4, "stroke=\"" ink "\" stroke-width=\"1.3\" stroke-opacity=\"0.7\"")
			occupy_line(at_x(x_low[a]), at_y(y[a]), at_x(x_high[a]), at_y(y[a]))
		}
	}
	if (style[name[s]] == "points") return
	for (i = 2; i <= count; i++) {
		a = order[i - 1]; b = order[i]
		segment(at_x(x[a]), at_y(y[a]), at_x(x[b]), at_y(y[b]), "stroke=\"" ink "\" stroke-width=\"2\" stroke-linecap=\"round\"" (style[name[s]] == "dashed" ? " stroke-dasharray=\"5,5\"" : ""))
		occupy_line(at_x(x[a]), at_y(y[a]), at_x(x[b]), at_y(y[b]))
	}
}

function draw_legend(s, py, px) {
	px = left + plot_w + 22; py = top - 11
	for (s = 1; s <= series; s++) {
		if (!points[s]) continue
		py += 21
		if (style[name[s]] != "points") segment(px, py, px + 22, py, "stroke=\"" colour[(s - 1) % colours + 1] "\" stroke-width=\"2\"" (style[name[s]] == "dashed" ? " stroke-dasharray=\"5,5\"" : ""))
		if (style[name[s]] != "dashed") marker(s, px + 11, py)
		text(px + 30, py + 4.5, "start", name[s], "")
	}
}

END {
	if (!n) { print "plot.awk: no points" >"/dev/stderr"; exit 1 }
	longest = listed = 0
	for (i = 1; i <= n; i++) if (!points[of[i]]++) { listed++; longest = max(longest, length(name[of[i]])) }
	width = left + plot_w + (listed > 1 ? 22 + 30 + longest * char_w + 14 : 28)
	width = max(width, left + max(length(set["title"]) * 9.6, length(set["note"]) * small_w) + 14)
	height = top + plot_h + bottom
	bounds()
	printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"%s\" fill=\"#222222\" stroke=\"none\">\n", width, height, width, height, size
	printf "<rect width=\"%d\" height=\"%d\" fill=\"white\"/>\n", width, height
	draw_axes(); draw_refs()
	for (s = 1; s <= series; s++) draw_line(s, sort_series(s))
	for (i = 1; i <= n; i++)
		if (style[name[of[i]]] != "dashed") {
			marker(of[i], at_x(x[i]), at_y(y[i]))
			occupy(at_x(x[i]) - 5, at_y(y[i]) - 5, at_x(x[i]) + 5, at_y(y[i]) + 5, 15)
		}
	for (i = 1; i <= refs; i++) name_ref(i)
	for (i = 1; i <= n; i++) if (label[i] != "") place(at_x(x[i]), at_y(y[i]), label[i], colour[(of[i] - 1) % colours + 1])
	if (listed > 1) draw_legend()
	print "</svg>"
}
