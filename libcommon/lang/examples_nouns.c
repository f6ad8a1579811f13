/* The nouns and attributes that example sentences are made of; words of one are parted by "_". */
#include "lang/examples.h"

/* clang-format off */
static const char *const nouns[] = {
	"chair", "table", "desk", "lamp", "door", "window", "box", "pillow", "cabinet", "monitor",
	"picture", "shelf", "bookshelf", "keyboard", "bag", "whiteboard", "backpack", "mirror", "bed",
	"plant", "armchair", "arm_chair", "towel", "cart", "couch", "sofa", "rail", "sink", "bottle",
	"trash_can", "trashcan", "computer_tower", "tower", "mouse", "toilet_paper",
	"roll_of_toilet_paper", "nightstand", "night_stand", "kitchen_cabinet", "soap_dish", "ottoman",
	"printer", "dresser", "suitcase", "shoe", "file_cabinet", "filing_cabinet", "stool",
	"office_chair", "curtain", "microwave", "toilet", "counter", "kitchen_counter", "book",
	"end_table", "coffee_table", "bookcase", "radiator", "light", "blanket", "painting", "telephone",
	"stall", "bin", "storage_bin", "recycling_bin", "paper_towel_dispenser", "blackboard", "pipe",
	"picture_frame", "fan", "clock", "rug", "carpet", "fridge", "refrigerator", "stove", "oven",
	"bench", "laptop", "screen", "television", "tv", "tv_stand", "guitar", "piano", "bathtub",
	"shower_curtain", "poster", "basket", "laundry_basket", "mug", "cup", "bowl", "plate", "ball",
	"cone", "cube", "block", "cylinder", "can", "tin", "book", "vase", "spoon", "fork", "knife",
	"candle", "hat", "toy", "doll", "teddy_bear", "sponge", "soap", "jar", "pot", "pan", "teapot",
	"toaster", "tray", "pen", "pencil", "notebook", "phone", "remote", "remote_control", "tape",
	"stapler", "scissors", "ruler", "apple", "banana", "orange", "lemon", "pear", "tomato", "carrot",
	"egg", "cake", "loaf", "sandwich", "duck", "rubber_duck", "dinosaur", "robot", "car", "truck",
	"train", "bus", "puzzle", "glove", "scarf", "shirt", "sock", "jacket", "umbrella", "wallet",
	"key", "coin", "watch", "bracelet", "statue", "bust", "flower", "flower_pot", "pyramid", "sphere",
	"disc", "ring", "rope", "cable", "charger", "speaker", "headphones", "camera", "tripod", "drill",
	"hammer", "bucket", "broom", "ladder", "crate", "parcel", "envelope", "letter", "magazine",
	"newspaper", "napkin", "fire_alarm", "smoke_detector", "light_switch", "door_knob",
	"power_outlet", "extension_cord", "picture_book", "phone_case", "pencil_case", "shoe_box",
	"gift_box", "jewelry_box", "tissue_box", "lunch_bag", "hand_bag", "paper_bag", "shopping_basket",
	"garbage_bin", "gas_can", "soda_can", "oil_bottle", "sauce_bottle", "dog_bowl", "fruit_bowl",
	"soup_bowl", "dinner_plate", "cake_plate", "egg_cup", "baby_doll", "toy_truck", "toy_boat",
	"tennis_shoe", "baseball_cap", "desk_fan", "reading_lamp", "wall_clock", "mouse_mat", "bath_mat",
	"yoga_mat", "gadget", "device", "container", "jug", "dish", "saucer", "beaker", "goblet", "tube",
	"barrel", "packet", "pack_of_cards", "pack_of_gum", "sheet_of_music", "bar_of_chocolate",
	"bottle_of_milk", "bowl_of_cherries", "glass_of_juice", "piece_of_cloth", "cloth", "sheet",
	"label", "sticker", "handle", "lid", "leg", "wheel", "strap", "figure", "figurine", "animal",
	"bird", "tiger", "elephant", "lion", "bear", "frog", "novel", "comic", "paperback", "album",
	"marker", "crayon", "brush", "comb", "razor", "pump", "dispenser", "bin_bag", "portion", "part",
	"section", "side_table", "cereal_box", "milk_carton", "tea_cup", "wine_glass", "water_bottle",
	"coffee_mug", "salt_shaker", "ice_cream_cone", "cutting_board", "stack_of_books", "row_of_chairs",
	"group_of_tables", "fireplace", "closet", "entrance", "stairs", "wall", "ceiling_light", "rack",
	"coat_rack", "conference_table", "room", "room", "room", "corner", "floor", "ceiling", "kitchen",
	"closet", "closet", "bathroom", "hallway", "wall", "wall", "wall", "island", "hole", "person",
	"people", "cat", "dog", "photo", "picture", "row_of_tables", "set_of_windows", "pair_of_shoes",
	"table", "chair", "bed", "round_table", "dining_chair", "exit_sign", "projector", "copier",
	"vending_machine", "washing_machine",
	"table_top", "desk_top", "orb", "carton", "package", "basin", "volume", "hardback", "vessel",
	"stripe", "spot", "swirl", "dot", "pattern", "letter",
	"button", "flap", "hood", "belt", "beak", "tail", "wing", "eye", "badge", "logo", "gadget", "appliance", "rag", "bird", "pack",
	"piece_of_crockery", "piece_of_fruit", "piece_of_cutlery", "traffic_cone", "party_hat",
	"soup_bowl", "dinner_plate", "drinking_glass", "toy", "sketch", "base", "foot", "item",
};
/* clang-format on */

/* clang-format off */
static const char *const attributes[] = {
	"red", "green", "blue", "yellow", "black", "white", "brown", "grey", "gray", "pink", "purple",
	"orange", "beige", "tan", "dark", "light", "dark_brown", "light_blue", "wooden", "metal",
	"plastic", "glass", "round", "square", "rectangular", "circular", "oval", "shiny", "dull",
	"striped", "spotted", "patterned", "empty", "full", "open", "closed", "folded", "old", "new",
	"dirty", "clean", "broken", "soft", "fluffy", "leather", "silver", "golden", "cream", "maroon",
	"turquoise", "teal", "colorful", "bright", "pale", "clear", "transparent", "double", "single",
	"lone", "stuffed", "cluttered", "messy", "flat", "curved", "wireless", "electric", "digital",
	"scarlet", "violet", "lilac", "navy", "olive", "rusty", "fuzzy", "furry", "smooth", "rough",
	"knitted", "rubber", "ceramic", "paper", "cardboard", "steel", "copper", "stone", "checkered",
	"dotted", "coloured", "colored", "multicolored", "greenish", "matte", "glossy", "hollow",
	"pointy", "pointed", "bent", "upside_down", "adjustable", "portable", "cheap", "pretty", "ugly",
	"strange", "half_full", "cracked", "used", "blank", "framed", "upholstered", "padded",
	"stainless", "medium", "medium_sized", "mid_sized", "brick_red", "sky_blue", "bottle_green",
	"jet_black", "snow_white", "slate_grey", "ash_grey", "royal_blue", "lemon_yellow", "salmon_pink",
	"chalk_white", "coal_black", "bright_orange", "chocolate_brown", "grass_green", "crimson",
	"emerald", "cobalt", "chestnut", "tangerine", "plum", "rose", "aqua", "banded", "speckled",
	"polished", "porcelain", "grey_blue", "black_and_white", "wall_mounted", "swivel", "ripe", "wet",
};
/* clang-format on */

/* clang-format off */
static const char *const hues[] = {
	"red", "green", "blue", "yellow", "black", "white", "brown", "grey", "pink", "purple", "orange",
	"beige", "teal", "turquoise", "violet", "silver", "cream", "lilac", "navy", "crimson", "scarlet",
	"emerald", "cobalt", "chestnut", "tangerine", "plum", "rose", "aqua", "light_blue", "dark_green",
	"brick_red", "sky_blue", "jet_black", "snow_white", "slate_grey", "royal_blue", "lemon_yellow",
	"salmon_pink", "bright_orange", "chocolate_brown", "grass_green", "pale_pink", "deep_purple",
};

static const char *const stuffs[] = {
	"wood", "metal", "plastic", "glass", "china", "porcelain", "ceramic", "rubber", "cardboard",
	"paper", "leather", "steel", "stone", "cloth", "wool", "brass", "copper", "clay", "foam",
};
/* clang-format on */

/* clang-format off */
static const char *const nouns_test[] = {
	"kettle", "bicycle", "helmet", "violin", "trumpet", "binder", "folder", "lunch_box", "thermos",
	"flask", "blender", "scooter", "cushion", "wardrobe", "mattress", "chandelier", "easel", "globe",
	"dustbin", "paper_cup", "tennis_ball", "marble", "dice", "chess_board", "drum", "flag", "kite",
	"panda", "penguin", "zebra", "rabbit", "tulip", "cactus", "melon",
};
/* clang-format on */

#define LIST(a)                                                                                              \
	{                                                                                                    \
		(int)(sizeof(a) / sizeof *(a)), a                                                            \
	}

const struct example_list example_nouns[2] = {LIST(nouns), LIST(nouns_test)};
const struct example_list example_attributes = LIST(attributes);
const struct example_list example_hues = LIST(hues), example_stuffs = LIST(stuffs);
