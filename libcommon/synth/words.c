#include "synth/words.h"

#include <stddef.h>

#define BIT(x) (1u << (x))

static const struct synth_word words[] = {
	{SYNTH_NOUN, BIT(SYNTH_BALL), "ball"},
	{SYNTH_NOUN, BIT(SYNTH_BALL), "sphere"},
	{SYNTH_NOUN, BIT(SYNTH_BALL), "orb"},
	{SYNTH_NOUN, BIT(SYNTH_BOX), "box"},
	{SYNTH_NOUN, BIT(SYNTH_BOX), "carton"},
	{SYNTH_NOUN, BIT(SYNTH_BOX), "package"},
	{SYNTH_NOUN, BIT(SYNTH_CYLINDER), "cylinder"},
	{SYNTH_NOUN, BIT(SYNTH_CYLINDER), "can"},
	{SYNTH_NOUN, BIT(SYNTH_CYLINDER), "tin"},
	{SYNTH_NOUN, BIT(SYNTH_CONE), "cone"},
	{SYNTH_NOUN, BIT(SYNTH_CONE), "traffic cone"},
	{SYNTH_NOUN, BIT(SYNTH_CONE), "party hat"},
	{SYNTH_NOUN, BIT(SYNTH_MUG), "mug"},
	{SYNTH_NOUN, BIT(SYNTH_MUG), "cup"},
	{SYNTH_NOUN, BIT(SYNTH_MUG), "coffee mug"},
	{SYNTH_NOUN, BIT(SYNTH_BOWL), "bowl"},
	{SYNTH_NOUN, BIT(SYNTH_BOWL), "basin"},
	{SYNTH_NOUN, BIT(SYNTH_BOWL), "soup bowl"},
	{SYNTH_NOUN, BIT(SYNTH_PLATE), "plate"},
	{SYNTH_NOUN, BIT(SYNTH_PLATE), "saucer"},
	{SYNTH_NOUN, BIT(SYNTH_PLATE), "dinner plate"},
	{SYNTH_NOUN, BIT(SYNTH_BOOK), "book"},
	{SYNTH_NOUN, BIT(SYNTH_BOOK), "volume"},
	{SYNTH_NOUN, BIT(SYNTH_BOOK), "hardback"},
	{SYNTH_NOUN, BIT(SYNTH_BOTTLE), "bottle"},
	{SYNTH_NOUN, BIT(SYNTH_BOTTLE), "flask"},
	{SYNTH_NOUN, BIT(SYNTH_BOTTLE), "drinking bottle"},
	{SYNTH_GROUP, BIT(SYNTH_MUG) | BIT(SYNTH_BOWL) | BIT(SYNTH_BOTTLE), "container"},
	{SYNTH_GROUP, BIT(SYNTH_MUG) | BIT(SYNTH_BOWL) | BIT(SYNTH_BOTTLE), "vessel"},
	{SYNTH_GROUP, BIT(SYNTH_MUG) | BIT(SYNTH_BOWL) | BIT(SYNTH_PLATE), "piece of crockery"},
	{SYNTH_GROUP, BIT(SYNTH_BOWL) | BIT(SYNTH_PLATE), "dish"},
	{SYNTH_GROUP, BIT(SYNTH_BOX) | BIT(SYNTH_BOOK), "rectangular thing"},
	{SYNTH_GROUP, BIT(SYNTH_BALL) | BIT(SYNTH_CYLINDER) | BIT(SYNTH_CONE), "toy"},
	{SYNTH_MATERIAL, BIT(SYNTH_MUG) | BIT(SYNTH_BOWL) | BIT(SYNTH_PLATE), "ceramic"},
	{SYNTH_MATERIAL, BIT(SYNTH_MUG) | BIT(SYNTH_BOWL) | BIT(SYNTH_PLATE), "porcelain"},
	{SYNTH_MATERIAL, BIT(SYNTH_BALL), "rubber"},
	{SYNTH_MATERIAL, BIT(SYNTH_BOX), "cardboard"},
	{SYNTH_MATERIAL, BIT(SYNTH_CYLINDER), "metal"},
	{SYNTH_MATERIAL, BIT(SYNTH_CONE), "plastic"},
	{SYNTH_MATERIAL, BIT(SYNTH_BOTTLE), "glass"},
	{SYNTH_HUE, BIT(SYNTH_RED), "red"},
	{SYNTH_HUE, BIT(SYNTH_RED), "crimson"},
	{SYNTH_HUE, BIT(SYNTH_RED), "scarlet"},
	{SYNTH_HUE, BIT(SYNTH_GREEN), "green"},
	{SYNTH_HUE, BIT(SYNTH_GREEN), "grass green"},
	{SYNTH_HUE, BIT(SYNTH_GREEN), "emerald"},
	{SYNTH_HUE, BIT(SYNTH_BLUE), "blue"},
	{SYNTH_HUE, BIT(SYNTH_BLUE), "royal blue"},
	{SYNTH_HUE, BIT(SYNTH_BLUE), "cobalt"},
	{SYNTH_HUE, BIT(SYNTH_YELLOW), "yellow"},
	{SYNTH_HUE, BIT(SYNTH_YELLOW), "lemon yellow"},
	{SYNTH_HUE, BIT(SYNTH_YELLOW), "sunny yellow"},
	{SYNTH_HUE, BIT(SYNTH_WHITE), "white"},
	{SYNTH_HUE, BIT(SYNTH_WHITE), "snow white"},
	{SYNTH_HUE, BIT(SYNTH_WHITE), "chalk white"},
	{SYNTH_HUE, BIT(SYNTH_BLACK), "black"},
	{SYNTH_HUE, BIT(SYNTH_BLACK), "jet black"},
	{SYNTH_HUE, BIT(SYNTH_BLACK), "coal black"},
	{SYNTH_HUE, BIT(SYNTH_ORANGE), "orange"},
	{SYNTH_HUE, BIT(SYNTH_ORANGE), "tangerine"},
	{SYNTH_HUE, BIT(SYNTH_ORANGE), "bright orange"},
	{SYNTH_HUE, BIT(SYNTH_PURPLE), "purple"},
	{SYNTH_HUE, BIT(SYNTH_PURPLE), "violet"},
	{SYNTH_HUE, BIT(SYNTH_PURPLE), "plum"},
	{SYNTH_HUE, BIT(SYNTH_BROWN), "brown"},
	{SYNTH_HUE, BIT(SYNTH_BROWN), "chocolate brown"},
	{SYNTH_HUE, BIT(SYNTH_BROWN), "chestnut"},
	{SYNTH_HUE, BIT(SYNTH_PINK), "pink"},
	{SYNTH_HUE, BIT(SYNTH_PINK), "rose"},
	{SYNTH_HUE, BIT(SYNTH_PINK), "salmon pink"},
	{SYNTH_HUE, BIT(SYNTH_GREY), "grey"},
	{SYNTH_HUE, BIT(SYNTH_GREY), "slate grey"},
	{SYNTH_HUE, BIT(SYNTH_GREY), "ash grey"},
	{SYNTH_HUE, BIT(SYNTH_TEAL), "teal"},
	{SYNTH_HUE, BIT(SYNTH_TEAL), "turquoise"},
	{SYNTH_HUE, BIT(SYNTH_TEAL), "aqua"},
	{SYNTH_EXTENT, BIT(SYNTH_SMALL), "small"},
	{SYNTH_EXTENT, BIT(SYNTH_SMALL), "little"},
	{SYNTH_EXTENT, BIT(SYNTH_SMALL), "tiny"},
	{SYNTH_EXTENT, BIT(SYNTH_MEDIUM), "medium-sized"},
	{SYNTH_EXTENT, BIT(SYNTH_MEDIUM), "mid-sized"},
	{SYNTH_EXTENT, BIT(SYNTH_BIG), "big"},
	{SYNTH_EXTENT, BIT(SYNTH_BIG), "large"},
	{SYNTH_SURFACE, BIT(SYNTH_PLAIN), "plain"},
	{SYNTH_SURFACE, BIT(SYNTH_PLAIN), "matt"},
	{SYNTH_SURFACE, BIT(SYNTH_SHINY), "shiny"},
	{SYNTH_SURFACE, BIT(SYNTH_SHINY), "glossy"},
	{SYNTH_SURFACE, BIT(SYNTH_SHINY), "polished"},
	{SYNTH_SURFACE, BIT(SYNTH_STRIPED), "striped"},
	{SYNTH_SURFACE, BIT(SYNTH_STRIPED), "banded"},
	{SYNTH_SURFACE, BIT(SYNTH_SPECKLED), "speckled"},
	{SYNTH_SURFACE, BIT(SYNTH_SPECKLED), "spotted"},
	{SYNTH_SURFACE, BIT(SYNTH_SPECKLED), "dotted"},
};

enum { WORDS = sizeof words / sizeof *words };

struct synth_meaning synth_meaning_any(void)
{
	return (struct synth_meaning){~0u, ~0u, ~0u, ~0u};
}

void synth_meaning_add(struct synth_meaning *m, const struct synth_word *w)
{
	switch (w->kind) {
	case SYNTH_NOUN:
	case SYNTH_GROUP:
	case SYNTH_MATERIAL:
		m->shapes &= w->mask;
		break;
	case SYNTH_HUE:
		m->colours &= w->mask;
		break;
	case SYNTH_EXTENT:
		m->sizes &= w->mask;
		break;
	case SYNTH_SURFACE:
		m->finishes &= w->mask;
		break;
	}
}

int synth_meaning_fits(const struct synth_meaning *m, const struct synth_object *o)
{
	return m->shapes & BIT(o->shape) && m->colours & BIT(o->colour) && m->sizes & BIT(o->size) &&
	       m->finishes & BIT(o->finish);
}

const struct synth_word *synth_word_choose(
	enum synth_word_kind kind, const struct synth_object *o, struct rng *r)
{
	const struct synth_word *fitting[WORDS];
	uint32_t n = 0;

	for (int i = 0; i < WORDS; i++) {
		struct synth_meaning m = synth_meaning_any();
		synth_meaning_add(&m, &words[i]);
		if (words[i].kind == kind && synth_meaning_fits(&m, o))
			fitting[n++] = &words[i];
	}
	return n ? fitting[rng_below(r, n)] : NULL;
}
