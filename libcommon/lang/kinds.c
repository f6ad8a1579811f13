/* Groups of everyday nouns, each with spaces around every word. Written from a dictionary's point of view:
 * rooms, kitchens, desks, toys, gardens, streets; a word may be in several groups. */
#include "lang/kinds.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const groups[] = {
	/* shapes */
	" box block cube cuboid brick crate carton case parcel package packet pack chest bin ",
	" ball sphere orb globe marble bead bauble bubble globule gobstopper cannonball planet ",
	" cylinder tube can tin drum canister barrel roll pipe keg cask roller spool pillar column bobbin log ",
	" cone pyramid pylon hat spike tepee teepee tipi wigwam funnel spire steeple cornet bollard ",
	" ring hoop donut doughnut torus loop circle wheel tyre tire band quoit ",
	" disc disk puck coaster coin token lid counter frisbee ",
	" rod stick pole bar dowel baton staff post ",
	" sheet card paper page leaf slip note ",
	" slab board plank panel tile ",
	" prism wedge triangle ",
	" egg ellipsoid oval ",
	/* kitchen and table */
	" plate dish platter saucer tray charger ",
	" bowl basin dish tureen ",
	" mug cup beaker teacup tumbler goblet chalice stein ",
	" glass tumbler goblet flute wineglass ",
	" bottle flask jar vial phial decanter carafe thermos canteen ",
	" jug pitcher ewer kettle carafe urn ",
	" pot pan saucepan casserole cauldron stockpot ",
	" pan skillet wok frypan griddle ",
	" kettle teakettle boiler teapot ",
	" tin can pot canister caddy ",
	" napkin serviette tissue wipe ",
	" knife blade cutter cleaver ",
	" stove cooker range oven hob ",
	" fridge refrigerator freezer icebox ",
	" tap faucet spigot ",
	" bin trashcan wastebasket dustbin garbage trash basket ",
	/* reading, writing, work */
	" book novel paperback hardback hardcover volume tome textbook publication manual guide ",
	" notebook notepad journal diary pad planner ",
	" magazine journal periodical newspaper ",
	" pen biro ballpoint marker crayon pencil ",
	" eraser rubber ",
	" folder binder file ",
	" laptop notebook computer macbook chromebook pc ",
	" computer pc desktop tower workstation machine ",
	" monitor screen display television tv telly ",
	" phone telephone mobile cellphone smartphone handset ",
	" keyboard keypad ",
	" headphone earphone earbud headset ",
	" gadget device gizmo contraption appliance gear ",
	" cable wire cord lead flex ",
	" remote controller clicker ",
	/* cloth and bags */
	" cloth rag towel fabric textile duster flannel wipe napkin ",
	" bag tote sack carrier satchel handbag purse pouch shopper ",
	" backpack rucksack knapsack schoolbag ",
	" suitcase luggage trunk case valise ",
	" rug carpet mat ",
	" mat pad coaster placemat ",
	" blanket throw quilt duvet comforter cover ",
	" cushion pillow ",
	" curtain drape blind ",
	" hat cap beanie bonnet ",
	" coat jacket parka ",
	" sweater jumper pullover cardigan hoodie ",
	" trousers pants jeans slacks ",
	" shoe sneaker trainer boot ",
	" glasses spectacles goggles sunglasses ",
	/* rooms */
	" sofa couch settee loveseat divan ",
	" chair seat armchair stool recliner ",
	" stool ottoman pouf footrest ",
	" table desk counter workbench bench worktop ",
	" cabinet cupboard closet wardrobe dresser locker sideboard ",
	" dresser bureau drawers chest ",
	" shelf bookshelf shelving bookcase rack ledge ",
	" lamp light lantern torch flashlight ",
	" picture painting photo photograph poster print artwork frame ",
	" vase urn pot jar ",
	" plant flower shrub bush pot ",
	" bathtub tub bath ",
	" toilet loo commode lavatory ",
	" sink basin washbasin ",
	" heater radiator ",
	" fan ventilator ",
	" window pane ",
	" door gate ",
	" mirror glass ",
	" clock timer watch alarm ",
	" basket hamper ",
	" candle taper ",
	" bed cot bunk mattress ",
	/* toys, animals, out of doors */
	" toy plaything plush plushie doll teddy figure figurine ",
	" figurine statue statuette figure sculpture bust ",
	" car vehicle automobile truck van ",
	" bicycle bike cycle ",
	" boat ship vessel ",
	" dog puppy hound ",
	" cat kitten kitty ",
	" bird penguin duck chick parrot ",
	" bunny rabbit hare ",
	" stone rock pebble boulder ",
	" box container receptacle holder bin ",
};

const char *kinds_group(size_t group)
{
	return group < sizeof groups / sizeof *groups ? groups[group] : NULL;
}

int kinds_have(const char *lemma)
{
	char x[KINDS_LENGTH + 3];

	if (!*lemma || strlen(lemma) >= KINDS_LENGTH || strchr(lemma, ' '))
		return 0;
	snprintf(x, sizeof x, " %s ", lemma);
	for (size_t g = 0; g < sizeof groups / sizeof *groups; g++)
		if (strstr(groups[g], x))
			return 1;
	return 0;
}

int kinds_hold(const char *lemma)
{
	static const char *const containers[] = {"bag", "basket", "bottle", "bowl", "box", "bucket", "can",
		"carton", "case", "crate", "cup", "glass", "jar", "jug", "mug", "pack", "packet", "pot",
		"sack", "tin", "tray", "tub", "tube", "vase", NULL};

	for (int i = 0; containers[i]; i++)
		if (!strcmp(lemma, containers[i]))
			return 1;
	return 0;
}

double kinds_share(const char *a, const char *b)
{
	double best = 0;
	char x[40], y[40];

	if (!*a || !*b || strlen(a) > 32 || strlen(b) > 32 || strchr(a, ' ') || strchr(b, ' '))
		return 0;
	snprintf(x, sizeof x, " %s ", a);
	snprintf(y, sizeof y, " %s ", b);
	for (size_t i = 0; i < sizeof groups / sizeof *groups; i++)
		if (strstr(groups[i], x) && strstr(groups[i], y)) {
			double v = i < 11 ? 0.85 : getenv("KL") ? atof(getenv("KL")) : 0.45;
			best = v > best ? v : best;
		}
	return best;
}
