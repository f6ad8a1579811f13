/* Everything that gs-check can tell apart, through the tools' own readers. */
#include "fuzz.h"

#include "formats/check.h"

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

const struct fuzz_seed fuzz_seeds[] = {
	SEED(splats),
	SEED(weights),
	SEED(text),
	SEED(foreign),
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

	if (check_file(&c, path, &e))
		return -1;
	check_free(&c);
	return 0;
}
