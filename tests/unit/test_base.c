#include "unit.h"

#include "base/base64.h"
#include "base/half.h"
#include "base/hash.h"
#include "base/mem.h"
#include "base/number.h"
#include "base/rng.h"
#include "formats/arrays/safetensors.h"

/* The first outputs of the PCG32 reference program pcg32-demo, seeded with 42 and 54. */
static void rng_known_answers(void)
{
	static const uint32_t expected[6] = {
		0xa15c02b7, 0x7b47f409, 0xba1d3330, 0x83d2f293, 0xbfa4784b, 0xcbed606e};
	struct rng r;

	rng_seed(&r, 42, 54);
	for (int i = 0; i < 6; i++) {
		uint32_t x = rng_u32(&r);
		CHECK(x == expected[i], "output %d is %08x", i, x);
	}
}

/* The hashes of xxHash's own command line, xxhsum -H64. */
static void hash_known_answers(void)
{
	static const struct {
		const char *text;
		uint64_t hash;
	} known[] = {{"", 0xef46db3751d8e999}, {"a", 0xd24ec4f1a98c6e5b}, {"abc", 0x44bc2cf5ad770999},
		{"Nobody inspects the spammish repetition", 0xfbcea83c8a378bf1}};

	for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
		const uint64_t hash = hash64(known[i].text, strlen(known[i].text), 0);
		CHECK(hash == known[i].hash, "'%s' has %016llx", known[i].text, (unsigned long long)hash);
	}
}

/* The examples of RFC 4648, section 10, and bytes that need every bit. */
static void base64_known_answers(void)
{
	static const struct {
		const char *bytes, *text;
	} known[] = {{"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="},
		{"fooba", "Zm9vYmE="}, {"foobar", "Zm9vYmFy"}, {"\xff\xfe\xfd\xfc", "//79/A=="}};

	for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
		struct err e;
		char *text = base64_text("data:", known[i].bytes, strlen(known[i].bytes), &e);
		CHECK(text && !strncmp(text, "data:", 5) && !strcmp(text + 5, known[i].text), "%s", text);
		size_t n;
		char *bytes = base64_bytes(known[i].text, &n, &e);
		CHECK(bytes && n == strlen(known[i].bytes) && !memcmp(bytes, known[i].bytes, n),
			"%zu bytes of %s", n, known[i].text);
		free(bytes);
		free(text);
	}
}

static void half_round_trip(void)
{
	enum { ALL = 65536 };
	static uint16_t halves[ALL];
	static float floats[ALL];
	int wrong = 0, others = 0;

	for (int h = 0; h < ALL; h++)
		halves[h] = (uint16_t)h;
	half_to_floats(
		halves + 1, ALL - 1, floats + 1); /* at any address, by whole vectors and what is left */
	for (int h = 0; h < ALL; h++) {
		float f = half_to_float((uint16_t)h);
		if (!isnan(f) && half_of_float(f) != h)
			wrong++;
		others += memcmp(&f, floats + h, sizeof f) != 0;
	}
	CHECK(wrong == 0, "%d halves change on the way through float", wrong);
	CHECK(others == 0, "%d halves have another float by vectors", others);
	CHECK(half_count_finite(halves, 0x7c00) == 0x7c00 && half_count_finite(halves, ALL) == 0x7c00 &&
			half_count_finite(halves + 0x8000, ALL - 0x8000) == 0x7c00,
		"finite halves");
	CHECK(half_of_float(1.00048828125f) == 0x3c00, "a tie rounds to even");
	CHECK(half_of_float(65520) == 0x7c00, "65520 rounds to infinity");
}

static void sizes_overflow(void)
{
	struct err e = {0};
	size_t out = 7;

	CHECK(mem_size((size_t)1 << 40, (size_t)1 << 40, &out) < 0 && out == 7, "product of 2^80 is refused");
	CHECK(!mem_alloc((size_t)1 << 62, 16, "x", &e) && e.code == ERR_SYSTEM, "2^66 bytes are refused");
}

/* 100% is said of what is certain only. */
static void percents(void)
{
	static const struct {
		double p;
		const char *text;
	} cases[] = {{0, "0%"}, {0.0099, "below 1%"}, {0.01, "1%"}, {0.974, "97%"}, {0.9951, "99%"},
		{0.9999999, "99%"}, {1, "100%"}};
	char text[NUMBER_SIZE];

	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
		CHECK(!strcmp(number_percent(text, cases[i].p), cases[i].text), "%.17g: %s", cases[i].p,
			text);
}

int main(void)
{
	rng_known_answers();
	hash_known_answers();
	base64_known_answers();
	half_round_trip();
	sizes_overflow();
	percents();
	return unit_end();
}
