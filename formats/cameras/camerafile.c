#include "formats/cameras/camerafile.h"

#include "base/file.h"
#include "base/textfile.h"
#include "formats/cameras/cameras3dgs.h"
#include "formats/cameras/colmap.h"
#include "formats/cameras/transforms.h"
#include "formats/records/foreign.h"
#include "formats/records/json.h"
#include "geom/lens.h"

#include <stdlib.h>
#include <string.h>

/* JSON, or what else the file is. */
static cJSON *read_json(const char *path, struct err *e)
{
	const char *name = file_name(path);
	cJSON *root = NULL;
	char *text;
	size_t len;

	if (textfile_read(path, &text, &len, e))
		return NULL;
	if (strchr("{[", text[strspn(text, " \t\r\n")]))
		root = json_parse(text, len, name, e);
	else if (!foreign_file(name, FOREIGN_CAMERAS, text, len, e))
		err_file(e, name,
			"neither the folder of a COLMAP model, nor a 3DGS cameras.json or a transforms.json");
	free(text);
	return root;
}

int camerafile_read(struct cameras *c, const char *path, struct err *e)
{
	const char *name = file_name(path);
	cJSON *root = NULL;
	int bad = -1;

	*c = (struct cameras){0};
	if (file_is_dir(path)) {
		bad = colmap_read(c, path, e);
	} else {
		root = read_json(path, e);
		const cJSON *frames = json_get(root, "frames"),
			    *image = json_get(root ? root->child : NULL, "img_name");
		if (root && !frames && !image && foreign_json(root, name, e))
			bad = -1;
		else if (cJSON_IsArray(root))
			bad = cameras3dgs_parse(c, root, name, e);
		else if (root)
			bad = transforms_parse(c, root, name, e);
		cJSON_Delete(root);
	}
	if (!bad && !c->n)
		bad = err_file(e, name, "no views");
	if (bad)
		cameras_free(c);
	return bad ? textfile_note(path, e) : 0;
}

int camerafile_need_pinholes(const struct cameras *c, const char *path, const char *images, struct err *e)
{
	size_t i = 0;

	while (i < c->n && !c->views[i].lens.model)
		i++;
	if (i == c->n)
		return 0;
	const struct camera *v = &c->views[i];
	const char *model = lens_model_name(v->lens.model);
	if (!file_is_dir(path))
		return err_file(e, file_name(path),
			"view '%s': camera model %s distorts: gs-import --undistort takes the pinhole of the same view",
			v->name, model);
	return err_file(e, file_name(path),
		"view '%s': camera model %s distorts: gs-import --undistort takes the pinhole of the same view, and so does 'colmap image_undistorter --image_path %s --input_path %s --output_path undistorted'",
		v->name, model, images ? images : "IMAGES", path);
}
