#pragma once

#include "json.h"

/* Reads a line of JSON [length] into a tree as of a scene; numbers keep their digits. `source` begins its messages. The
 * caller frees *root. KZ_REFUSED: the line is not JSON. */
kz_status kz_json_read(const char *line, size_t length, const char *source, kz_node **root);
