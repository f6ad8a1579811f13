/* What gs-check tells apart, through the tools' own readers: scenes, weights, texts, lifted models and
 * foreign tensors, sentences, masks, boxes, cameras of three programs, 3DGS ply, npy, PNG and JPEG. Not here:
 * trained models, whose least size is over the driver's, and folders, a COLMAP model among them. */
#include "fuzz.h"

#include "cmd/check/check.h"

#define SEED(text)                                                                                           \
	{                                                                                                    \
		text, sizeof text - 1                                                                        \
	}

/* Without checksums, which would hide what comes after them. */
static const char splats[] =
	"p\001\000\000\000\000\000\000{\"__metadata__\":{\"format\":\"refer.splats\",\"version\":\"1\"},\""
	"means\":{\"dtype\":\"F32\",\"shape\":[1,3],\"data_offsets\":[0,12]},\"scales\":{\"dtype\":\"F32\""
	",\"shape\":[1,3],\"data_offsets\":[12,24]},\"quats\":{\"dtype\":\"F32\",\"shape\":[1,4],\"data_o"
	"ffsets\":[24,40]},\"opacities\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[40,44]},\"sh\""
	":{\"dtype\":\"F32\",\"shape\":[1,1,3],\"data_offsets\":[44,56]}}      \000\000\000\000\000\000\000"
	"\000\000\000\000\000\000\000\000?\000\000\000?\000\000\000?\000\000\200?\000\000\000\000\000\000"
	"\000\000\000\000\000\000\000\000\200?\000\000\000\000\000\000\000\000\000\000\000\000";

static const char weights[] =
	"X\001\000\000\000\000\000\000{\"__metadata__\":{\"format\":\"refer.weights\",\"version\":\"1\",\""
	"width\":\"2\",\"height\":\"1\",\"gaussians\":\"3\"},\"indptr\":{\"dtype\":\"I64\",\"shape\":[3],"
	"\"data_offsets\":[0,24]},\"index\":{\"dtype\":\"I32\",\"shape\":[2],\"data_offsets\":[24,32]},\""
	"dropped\":{\"dtype\":\"F32\",\"shape\":[2],\"data_offsets\":[32,40]},\"weight\":{\"dtype\":\"F32"
	"\",\"shape\":[2],\"data_offsets\":[40,48]}}       \000\000\000\000\000\000\000\000\001\000\000\000"
	"\000\000\000\000\002\000\000\000\000\000\000\000\002\000\000\000\000\000\000\000\000\000\000\000"
	"\000\000\000\000\000\000\000?\000\000\200?";

static const char text[] =
	"H\001\000\000\000\000\000\000{\"__metadata__\":{\"format\":\"refer.text\",\"version\":\"1\",\"re"
	"fs\":\"[\\\"r1\\\"]\",\"objects\":\"[\\\"cup\\\"]\",\"texts\":\"[\\\"a cup\\\"]\",\"splits\":\"["
	"\\\"train\\\"]\"},\"offsets\":{\"dtype\":\"I64\",\"shape\":[2],\"data_offsets\":[0,16]},\"words\""
	":{\"dtype\":\"F32\",\"shape\":[2,2],\"data_offsets\":[16,32]},\"sentences\":{\"dtype\":\"F32\",\""
	"shape\":[1,2],\"data_offsets\":[32,40]}}   \000\000\000\000\000\000\000\000\002\000\000\000\000\000"
	"\000\000\000\000\200?\000\000\000@\000\000@@\000\000\200@\000\000\000@\000\000@@";

static const char foreign[] =
	"\230\000\000\000\000\000\000\000{\"__metadata__\":{\"crc32.b\":\"e8b7be43\"},\"a\":{\"dtype\":\""
	"F16\",\"shape\":[1,2],\"data_offsets\":[0,4]},\"b\":{\"dtype\":\"U8\",\"shape\":[1],\"data_offse"
	"ts\":[4,5]}}      \000<\000\301a";

static const char lifted[] =
	"H\002\000\000\000\000\000\000{\"__metadata__\":{\"format\":\"refer.lifted\",\"version\":\"1\",\""
	"gaussians\":\"5\",\"names\":\"[\\\"cup\\\",\\\"pan\\\"]\",\"texts\":\"[\\\"red cup\\\",\\\"\\\"]"
	"\",\"pieces\":\"[\\\"red cup\\\",\\\"\\\"]\"},\"indptr\":{\"dtype\":\"I64\",\"shape\":[3],\"data"
	"_offsets\":[0,24]},\"offsets\":{\"dtype\":\"I64\",\"shape\":[3],\"data_offsets\":[24,48]},\"inde"
	"x\":{\"dtype\":\"I32\",\"shape\":[3],\"data_offsets\":[48,60]},\"object\":{\"dtype\":\"I32\",\"s"
	"hape\":[2],\"data_offsets\":[60,68]},\"confidence\":{\"dtype\":\"F32\",\"shape\":[2],\"data_offs"
	"ets\":[68,76]},\"words\":{\"dtype\":\"F16\",\"shape\":[2,2],\"data_offsets\":[76,84]},\"share\":"
	"{\"dtype\":\"U8\",\"shape\":[3],\"data_offsets\":[84,87]}}   \000\000\000\000\000\000\000\000"
	"\002\000\000\000\000\000\000\000\003\000\000\000\000\000\000\000\000\000\000\000\000\000\000\000"
	"\002\000\000\000\000\000\000\000\002\000\000\000\000\000\000\000\001\000\000\000\003\000\000\000"
	"\000\000\000\000\001\000\000\000\000\000\000\000\000\000\200\077\000\000\000\000\000<\000@\000B"
	"\000D\3773\001";

/* Two pixels of colour. */
static const char png[] =
	"\211PNG\015\012\032\012\000\000\000\015IHDR\000\000\000\002\000\000\000\001\010\002\000\000\000{"
	"@\350\335\000\000\000\017IDATx\234c`dbfae\003\000\000\077\000\026!\272\324T\000\000\000\000IEND"
	"\256B`\202";

/* Three grey ones by two. */
static const char jpeg[] =
	"\377\330\377\333\000C\000\010\006\006\007\006\005\010\007\007\007\011\011\010\012\014\024\015"
	"\014\013\013\014\031\022\023\017\024\035\032\037\036\035\032\034\034 $.' \",#\034\034(7),01444"
	"\037'9=82<.342\377\300\000\013\010\000\002\000\003\001\001\021\000\377\304\000\024\000\001\000"
	"\000\000\000\000\000\000\000\000\000\000\000\000\000\000\007\377\304\000\032\020\000\001\005\001"
	"\000\000\000\000\000\000\000\000\000\000\000\000\001\000\006\0077t\261\377\332\000\010\001\001"
	"\000\000\077\000O\212\352\366\366A\322\277\377\331";

const struct fuzz_seed fuzz_seeds[] = {
	SEED(splats),
	SEED(weights),
	SEED(text),
	SEED(foreign),
	SEED(lifted),
	SEED(png),
	SEED(jpeg),
	SEED("{\"ref\":\"r1\",\"object\":\"cup\",\"score\":0.5,\"min\":[0,0,0],\"max\":[1,2,3],\"oriented\":{\"centre\":[0,1,2],"
	     "\"quat\":[1,0,0,0],\"size\":[1,2,3]}}\n{\"object\":\"pan\",\"oriented\":null}\n"),
	SEED("{\"ref\":\"r1\",\"object\":\"cup\",\"text\":\"the red cup\",\"split\":\"test\",\"views\":[\"v1\"]}\n"
	     "{\"ref\":\"r2\",\"object\":\"cup\",\"text\":\"tasse \\u00e9\"}\n"),
	SEED("{\"view\":\"v1\",\"object\":\"cup\",\"score\":0.5,\"segmentation\":{\"size\":[2,3],\"counts\":[0,2,4]}}\n"
	     "{\"view\":\"v1\",\"ref\":\"r1\",\"segmentation\":{\"size\":[2,3],\"counts\":\"024\"}}\n"),
	SEED("[{\"name\":\"v1\",\"width\":4,\"height\":3,\"fx\":5,\"fy\":5,\"cx\":2,\"cy\":1.5,\"world_to_camera\":"
	     "[[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]],\"split\":\"train\",\"image\":null}]"),
	SEED("[{\"id\":0,\"img_name\":\"a\",\"width\":4,\"height\":3,\"position\":[0,0,0],"
	     "\"rotation\":[[1,0,0],[0,1,0],[0,0,1]],\"fx\":5,\"fy\":5}]"),
	SEED("{\"fl_x\":5,\"fl_y\":5,\"cx\":2,\"cy\":1.5,\"w\":4,\"h\":3,\"frames\":[{\"file_path\":\"a.png\","
	     "\"transform_matrix\":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}"),
	SEED("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
	     "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\nproperty float opacity\n"
	     "property float scale_0\nproperty float scale_1\nproperty float scale_2\nproperty float rot_0\n"
	     "property float rot_1\nproperty float rot_2\nproperty float rot_3\nend_header\n"
	     "0 1 2 0 0 0 0.5 -1 -1 -1 1 0 0 0\n1 1 2 0 0 0 0.5 -1 -2 -1 1 0 0.5 0\n"),
	SEED("\x93NUMPY\1\0\x46\0{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }          \n"
	     "\0\0\x80\x3f\0\0\0\0"),
};
const size_t fuzz_seed_count = sizeof fuzz_seeds / sizeof *fuzz_seeds;

int fuzz_one(const char *path)
{
	struct err e = {0};
	struct check c;

	int bad = check_file(&c, path, &e);
	check_free(&c);
	return bad;
}
