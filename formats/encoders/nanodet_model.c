#include "formats/encoders/nanodet_model.h"

#include "formats/encoders/pretrained.h"

#include <stdio.h>

static int load_all(struct pretrained *from, const struct nanodet *n)
{
	char name[32];

	for (int i = 0; i < NANODET_CONVS; i++) {
		const struct conv *c = &n->convs[i];
		snprintf(name, sizeof name, "convs.%d.weight", i);
		if (pretrained_load(from, name, c->weight, (int)(c->side * c->side * c->in), (int)c->out))
			return -1;
		snprintf(name, sizeof name, "convs.%d.bias", i);
		if (pretrained_load(from, name, c->bias, 0, (int)c->out))
			return -1;
	}
	return 0;
}

int nanodet_model_read(struct nanodet *n, const char *dir, struct err *e)
{
	struct pretrained from = {.prefix = "", .e = e};
	const int bad = pretrained_open(&from.st, dir, NULL, e) || nanodet_alloc(n, e) || load_all(&from, n);

	safetensors_close(&from.st);
	return bad;
}
