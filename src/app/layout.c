/* The layout of the result file, from the tables that write it, as JSON. */
#include <string.h>

#include "app.h"
#include "json.h"

static const char *const kinds[] = {
    [KZ_REAL] = "float64", [KZ_INT8] = "int8",     [KZ_UINT8] = "uint8", [KZ_INT16] = "int16",
    [KZ_INT32] = "int32",  [KZ_UINT32] = "uint32", [KZ_TEXT] = "text",
};

/* As kz_variable has units: "UNIT", "UNIT|WORDS", or "@NAME" of an attribute of the group. */
static void add_units(kz_json *object, const kz_variable *row) {
  char unit[64], name[256];
  const char *words = strchr(row->units, '|');
  snprintf(unit, sizeof unit, "%.*s", (int)strcspn(row->units, "|"), row->units);
  snprintf(name, sizeof name, "%s%s%s", row->long_name, words ? ", in " : "", words ? words + 1 : "");
  kz_json_add_text(object, "units", unit);
  kz_json_add_text(object, "long_name", name);
}

static kz_json *layout_of(const char *group, const kz_variable *row) {
  kz_json *object = json_object_new_object();
  kz_json_add_text(object, "group", group);
  kz_json_add_text(object, "name", row->name);
  kz_json_add_text(object, "type", kinds[row->kind]);
  kz_json_add(object, "dimensions", kz_json_texts(row->dimensions));
  add_units(object, row);
  kz_json_add(object, "flags", kz_json_texts(row->flags));
  return object;
}

void kz_layout_print(FILE *out) {
  for (const kz_group *group = kz_groups; group->name; group++)
    for (const kz_variable *row = group->variables; row->name; row++) kz_json_print(layout_of(group->name, row), out);
}
