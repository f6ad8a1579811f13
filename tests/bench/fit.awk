# Fits time against size, from lines "X Y" in any order, in two ways; prints one line, separated by tabs:
#	NAME  points  least X  largest X  exponent  R2  a  b  largest share of a
# y = a + b x by least squares of relative errors, over all points. y = C x^exponent by least squares of logarithms, over those
# points where a is less than half of a + b x, for where the constant part dominates an exponent says nothing; least and
# largest X are of these. exponent is - where fewer than three remain.
# usage: awk -f fit.awk -v name=NAME
NF >= 2 && $1 > 0 && $2 > 0 { n++; x[n] = $1; y[n] = $2 }
END {
	if (n < 2) exit
	for (i = 1; i <= n; i++) {
		w = 1 / (y[i] * y[i])
		s += w; sx += w * x[i]; sxx += w * x[i] * x[i]; sy += w * y[i]; sxy += w * x[i] * y[i]
	}
	b = (s * sxy - sx * sy) / (s * sxx - sx * sx)
	a = (sy - b * sx) / s
	for (i = 1; i <= n; i++) {
		share = a / (a + b * x[i])
		if (b <= 0 || share >= 0.5) continue
		count++
		least = count == 1 || x[i] < least ? x[i] : least
		most = count == 1 || x[i] > most ? x[i] : most
		if (count == 1 || share > worst) worst = share
		u = log(x[i]); v = log(y[i])
		su += u; sv += v; suu += u * u; suv += u * v; svv += v * v
	}
	exponent = r2 = "-"
	if (count >= 3) {
		slope = (count * suv - su * sv) / (count * suu - su * su)
		r2 = (count * suv - su * sv) ^ 2 / ((count * suu - su * su) * (count * svv - sv * sv))
		exponent = sprintf("%.2f", slope); r2 = sprintf("%.4f", r2)
	}
	printf "%s\t%d\t%s\t%s\t%s\t%s\t%.4g\t%.4g\t%s\n", name, count, count ? sprintf("%.4g", least) : "-", count ? sprintf("%.4g", most) : "-", exponent, r2, a, b, count ? sprintf("%.0f %%", 100 * (worst > 0 ? worst : 0)) : "-"
}
