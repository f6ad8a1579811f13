#include "mask/rle.h"

#include "base/mem.h"

enum {
	GROUP_BITS = 5,	 /* payload of one character */
	GROUP_MAX = 7,	 /* 35 bits hold any difference of two runs */
	GROUP_MORE = 32, /* another character of this number follows */
	GROUP_SIGN = 16, /* in a number's last character: negative */
	GROUP_ZERO = 48, /* the character of the group 0 */
};

void rle_free(struct rle *r)
{
	free(r->runs);
	*r = (struct rle){0};
}

int rle_check_size(int64_t height, int64_t width, struct err *e)
{
	if (height < 1 || width < 1 || height > RLE_MAX_SIDE || width > RLE_MAX_SIDE)
		return err_set(e, ERR_FORMAT, "size %lldx%lld (width x height) is not within 1 to %d",
			(long long)width, (long long)height, RLE_MAX_SIDE);
	if (height * width > UINT32_MAX)
		return err_set(e, ERR_FORMAT, "size %lldx%lld (width x height) has more than %lld pixels",
			(long long)width, (long long)height, (long long)UINT32_MAX);
	return 0;
}

static int alloc_runs(struct rle *r, size_t n, int height, int width, struct err *e)
{
	*r = (struct rle){.height = height, .width = width, .n = n};
	r->runs = mem_alloc(n, sizeof *r->runs, "mask", e);
	return r->runs ? 0 : -1;
}

/* Columns where a row's foreground differs from that of the row above, rising. Equal words are skipped. */
static size_t row_changes(const uint8_t *above, const uint8_t *row, size_t width, uint32_t *columns)
{
	size_t n = 0, c = 0;

	for (; c + 8 <= width; c += 8) {
		uint64_t a, b;
		memcpy(&a, above + c, 8);
		memcpy(&b, row + c, 8);
		if (a == b)
			continue;
		for (size_t k = c; k < c + 8; k++)
			if (!above[k] != !row[k])
				columns[n++] = (uint32_t)k;
	}
	for (; c < width; c++)
		if (!above[c] != !row[c])
			columns[n++] = (uint32_t)c;
	return n;
}

/* Row-major masks are scanned by rows, twice: once to count the changes of each column, once to put each
 * change in its column's place. Walking down the columns instead would miss the cache at every pixel. */
int rle_encode(struct rle *r, const uint8_t *mask, int height, int width, struct err *e)
{
	size_t h = (size_t)height, w = (size_t)width, total = 0, n;

	*r = (struct rle){0};
	if (rle_check_size(height, width, e))
		return -1;
	SCOPED uint8_t *top = mem_alloc(w, 1, "mask", e);
	SCOPED uint32_t *columns = mem_alloc(w, sizeof *columns, "mask", e);
	SCOPED size_t *start = mem_zalloc(w + 1, sizeof *start, "mask", e);
	if (!top || !columns || !start)
		return -1;
	/* above the top of a column is the foot of the one before */
	top[0] = 0;
	memcpy(top + 1, mask + (h - 1) * w, w - 1);
	for (size_t y = 0; y < h; y++) {
		n = row_changes(y ? mask + (y - 1) * w : top, mask + y * w, w, columns);
		for (size_t i = 0; i < n; i++)
			start[columns[i] + 1]++;
		total += n;
	}
	for (size_t c = 0; c < w; c++)
		start[c + 1] += start[c];
	if (alloc_runs(r, total + 1, height, width, e))
		return -1;
	for (size_t y = 0; y < h; y++) {
		n = row_changes(y ? mask + (y - 1) * w : top, mask + y * w, w, columns);
		for (size_t i = 0; i < n; i++)
			r->runs[start[columns[i]]++] = (uint32_t)(columns[i] * h + y);
	}
	/* from positions of change to lengths */
	r->runs[total] = (uint32_t)(h * w);
	for (size_t i = total; i > 0; i--)
		r->runs[i] -= r->runs[i - 1];
	return 0;
}

/* The changes are marked first, then each row takes over the one above: whole rows at a time. */
void rle_decode(const struct rle *r, uint8_t *mask)
{
	size_t h = (size_t)r->height, w = (size_t)r->width;
	size_t begin = 0;

	memset(mask, 0, h * w);
	for (size_t i = 0; i < r->n; i++) {
		size_t end = begin + r->runs[i];
		if (i % 2 && end > begin) {
			mask[begin % h * w + begin / h] ^= 1;
			for (size_t c = begin / h + 1; c * h < end; c++)
				mask[c] ^= 1;
			if (end % h)
				mask[end % h * w + end / h] ^= 1;
		}
		begin = end;
	}
	for (size_t y = 1; y < h; y++) {
		const uint8_t *above = mask + (y - 1) * w;
		uint8_t *row = mask + y * w;
		for (size_t c = 0; c < w; c++)
			row[c] ^= above[c];
	}
}

/* The runs of r must fill its pixels exactly. */
static int check_sum(const struct rle *r, uint64_t sum, struct err *e)
{
	uint64_t pixels = (uint64_t)r->height * (uint64_t)r->width;

	if (sum == pixels)
		return 0;
	return err_set(e, ERR_FORMAT, "the runs sum to %llu, but %dx%d has %llu pixels",
		(unsigned long long)sum, r->width, r->height, (unsigned long long)pixels);
}

int rle_from_runs(struct rle *r, const uint32_t *runs, size_t n, int height, int width, struct err *e)
{
	uint64_t sum = 0;

	*r = (struct rle){0};
	if (rle_check_size(height, width, e) || alloc_runs(r, n, height, width, e))
		return -1;
	for (size_t i = 0; i < n; i++)
		sum += r->runs[i] = runs[i];
	return check_sum(r, sum, e);
}

/* One number at text[*at]: groups of five bits, low first, the last one signed. Moves *at behind it. */
static int read_number(const char *text, size_t *at, int64_t *value, struct err *e)
{
	int64_t x = 0;
	size_t begin = *at;

	for (int k = 0; k < GROUP_MAX; k++) {
		int c = (unsigned char)text[*at];
		if (!c)
			return err_set(e, ERR_FORMAT, "offset %zu: ends inside a number", *at);
		if (c < GROUP_ZERO || c >= GROUP_ZERO + 64)
			return err_set(e, ERR_FORMAT, "offset %zu: byte 0x%02x is not of a compressed run",
				*at, (unsigned)c);
		c -= GROUP_ZERO;
		++*at;
		x |= (int64_t)(c & 31) << (GROUP_BITS * k);
		if (c & GROUP_MORE)
			continue;
		if (c & GROUP_SIGN)
			x -= (int64_t)1 << (GROUP_BITS * (k + 1));
		*value = x;
		return 0;
	}
	return err_set(e, ERR_FORMAT, "offset %zu: a number of more than %d characters", begin, GROUP_MAX);
}

int rle_from_string(struct rle *r, const char *text, int height, int width, struct err *e)
{
	uint64_t sum = 0;
	size_t at = 0, n = 0;

	*r = (struct rle){0};
	if (rle_check_size(height, width, e))
		return -1;
	/* a number ends where the bit that promises more is clear */
	for (const char *p = text; *p; p++)
		n += !((*p - GROUP_ZERO) & GROUP_MORE);
	if (alloc_runs(r, n, height, width, e))
		return -1;
	for (size_t i = 0; text[at]; i++) {
		int64_t x = 0;
		size_t begin = at;
		if (read_number(text, &at, &x, e))
			return -1;
		if (i > 2)
			x += r->runs[i - 2];
		if (x < 0 || x > (int64_t)height * width)
			return err_set(e, ERR_FORMAT, "offset %zu: run %zu is %lld, not within 0 to %lld",
				begin, i, (long long)x, (long long)height * width);
		r->runs[i] = (uint32_t)x;
		sum += (uint64_t)x;
	}
	return check_sum(r, sum, e);
}

char *rle_to_string(const struct rle *r, struct err *e)
{
	size_t at = 0, bytes;

	if (mem_size(r->n, GROUP_MAX, &bytes)) {
		err_set(e, ERR_SYSTEM, "mask: %zu runs do not fit in memory", r->n);
		return NULL;
	}
	char *text = mem_alloc(bytes + 1, 1, "mask", e);
	if (!text)
		return NULL;
	for (size_t i = 0; i < r->n; i++) {
		int64_t x = (int64_t)r->runs[i] - (i > 2 ? (int64_t)r->runs[i - 2] : 0);
		for (int more = 1; more;) {
			int c = (int)(x & 31);
			/* floor division: the sign stays in the rest */
			x = (x - c) / 32;
			more = c & GROUP_SIGN ? x != -1 : x != 0;
			text[at++] = (char)(GROUP_ZERO + c + (more ? GROUP_MORE : 0));
		}
	}
	text[at] = 0;
	return text;
}

size_t rle_area(const struct rle *r)
{
	size_t area = 0;

	for (size_t i = 1; i < r->n; i += 2)
		area += r->runs[i];
	return area;
}

/* How many pixels differ from the one `step` positions on. */
static size_t changes_after(const struct rle *r, size_t step)
{
	size_t differ = 0, at = 0, i = 0, k = 0, end = 0, far = 0;

	for (; i < r->n && far <= step; far += r->runs[i++])
		;
	for (k = i, i = 0; at < (size_t)r->height * (size_t)r->width - step;) {
		while (end <= at)
			end += r->runs[i++];
		while (far <= at + step)
			far += r->runs[k++];
		const size_t next = end < far - step ? end : far - step;
		differ += (i + k) % 2 ? next - at : 0;
		at = next;
	}
	return differ;
}

int rle_is_by_rows(const struct rle *r)
{
	const size_t down = changes_after(r, (size_t)r->height), along = changes_after(r, (size_t)r->width);

	return rle_area(r) >= 16 && rle_area(r) >= r->n && along && down >= 3 * along;
}

/* Two masks of one size, walked together. */
struct walk {
	const struct rle *a, *b;
	size_t i, j;		   /* runs that were begun: run k-1 is foreground for even k */
	uint64_t end_a, end_b, at; /* where these end, and how far the walk is */
};

/* The next stretch on which neither changes: its length, or 0 at the end. Whether the masks are foreground
 * there is what is_in says. */
static inline uint64_t walk_on(struct walk *w)
{
	while (w->i < w->a->n || w->j < w->b->n) {
		if (w->end_a <= w->end_b && w->i < w->a->n)
			w->end_a += w->a->runs[w->i++];
		else if (w->j < w->b->n)
			w->end_b += w->b->runs[w->j++];
		else
			break;
		/* up to the nearer end both masks are what their last runs say */
		const uint64_t end = w->end_a < w->end_b ? w->end_a : w->end_b;
		if (end > w->at) {
			const uint64_t length = end - w->at;
			w->at = end;
			return length;
		}
	}
	return 0;
}

static inline int is_in(size_t begun)
{
	return !(begun % 2);
}

size_t rle_intersection(const struct rle *a, const struct rle *b)
{
	struct walk w = {.a = a, .b = b};
	size_t both = 0;

	for (uint64_t length; (length = walk_on(&w));)
		if (is_in(w.i) && is_in(w.j))
			both += length;
	return both;
}

static int combine(struct rle *to, const struct rle *a, const struct rle *b, int is_without, struct err *e)
{
	struct walk w = {.a = a, .b = b};

	if (alloc_runs(to, a->n + b->n + 1, a->height, a->width, e))
		return -1;
	to->n = 1;
	to->runs[0] = 0;
	for (uint64_t length; (length = walk_on(&w));) {
		if ((is_without ? is_in(w.i) && !is_in(w.j) : is_in(w.i) || is_in(w.j)) != is_in(to->n))
			to->runs[to->n++] = 0;
		to->runs[to->n - 1] += (uint32_t)length;
	}
	return 0;
}

int rle_unite(struct rle *to, const struct rle *a, const struct rle *b, struct err *e)
{
	return combine(to, a, b, 0, e);
}

int rle_without(struct rle *to, const struct rle *a, const struct rle *b, struct err *e)
{
	return combine(to, a, b, 1, e);
}

double rle_iou(const struct rle *a, const struct rle *b)
{
	size_t both = rle_intersection(a, b), either = rle_area(a) + rle_area(b) - both;

	return either ? (double)both / (double)either : 1;
}

int rle_same_size(const struct rle *a, const struct rle *b)
{
	return a->height == b->height && a->width == b->width;
}

int rle_fit(struct rle_fitted *f, const struct rle *like, struct err *e)
{
	if (f->now && rle_same_size(f->now, like))
		return 0;
	rle_free(&f->resized);
	f->now = NULL;
	if (!rle_same_size(f->own, like) && rle_resize(&f->resized, f->own, like->height, like->width, e))
		return -1;
	f->now = f->resized.runs ? &f->resized : f->own;
	f->area = rle_area(f->now);
	return 0;
}

int rle_decode_at(const struct rle *r, int height, int width, uint8_t *mask, struct err *e)
{
	SCOPED_BY(rle_fitted_free) struct rle_fitted f = {.own = r};
	const int bad = rle_fit(&f, &(struct rle){.height = height, .width = width}, e);

	if (!bad)
		rle_decode(f.now, mask);
	return bad;
}

void rle_fitted_free(struct rle_fitted *f)
{
	rle_free(&f->resized);
}
