/* Reads tests/literature/reference.json for tests: a section, its objects, their numbers (plain or quoted). */
#pragma once

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A stretch of the file; first = NULL where nothing was found. */
typedef struct {
  const char *first, *last;
} reference_span;

static const char *reference_text(void) {
  static char *text;
  if (text) return text;
  FILE *file = fopen(KZ_TEST_DATA "/literature/reference.json", "rb");
  if (!file) return "";
  fseek(file, 0, SEEK_END);
  long size = ftell(file);
  rewind(file);
  text = calloc((size_t)size + 1, 1);
  if (fread(text, 1, (size_t)size, file) != (size_t)size) text[0] = 0;
  fclose(file);
  return text;
}

/* The bracketed value that starts at or after `at`. */
static reference_span reference_value(const char *at, const char *stop) {
  const char *first = at;
  while (first && first < stop && *first != '[' && *first != '{') first++;
  if (!first || first >= stop) return (reference_span){NULL, NULL};
  int depth = 0;
  for (const char *c = first; c < stop; c++) {
    depth += (*c == '[' || *c == '{') - (*c == ']' || *c == '}');
    if (depth == 0) return (reference_span){first, c};
  }
  return (reference_span){NULL, NULL};
}

static const char *reference_key(reference_span in, const char *name) {
  char quoted[128];
  snprintf(quoted, sizeof quoted, "\"%s\":", name);
  const char *found = strstr(in.first, quoted);
  return found && found < in.last ? found + strlen(quoted) : NULL;
}

/* The bracketed value of a key of `in`; in.first = NULL: of the whole file. */
static reference_span reference_section(reference_span in, const char *name) {
  if (!in.first) in = (reference_span){reference_text(), reference_text() + strlen(reference_text())};
  const char *at = reference_key(in, name);
  return at ? reference_value(at, in.last) : (reference_span){NULL, NULL};
}

/* The next bracketed value inside `in` after `previous` (previous.first = NULL: the first). */
static reference_span reference_next(reference_span in, reference_span previous) {
  return reference_value(previous.first ? previous.last + 1 : in.first + 1, in.last);
}

static double reference_number_at(const char *at) {
  while (*at == ' ' || *at == '\n' || *at == '"' || *at == ',' || *at == '[') at++;
  return strtod(at, NULL);
}

/* The number of a key of `in`; NaN where there is none. */
static double reference_number(reference_span in, const char *name) {
  const char *at = in.first ? reference_key(in, name) : NULL;
  return at ? reference_number_at(at) : NAN;
}
