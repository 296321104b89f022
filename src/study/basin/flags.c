/* Which label is which attractor, as flags of the labels (CF). */
#include "flags.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_FLAGS = 16000 }; /* an attribute of numbers holds 64 KiB */

/* A name with the characters that CF allows: "rotation +1/2" is rotation_+1_in_2. */
static void print_word(const char *name, FILE *out) {
  for (const char *c = name; *c; c++) {
    if (*c == '/')
      fputs("_in_", out);
    else
      fputc(strchr("+-.@", *c) || (*c >= '0' && *c <= '9') || (*c >= 'A' && *c <= 'Z') || (*c >= 'a' && *c <= 'z') ? *c : '_',
            out);
  }
}

/* Whether another entry has the name too. */
static bool is_shared(const kz_catalogue *catalogue, int64_t which) {
  for (int64_t i = 0; i < catalogue->count; i++)
    if (i != which && strcmp(catalogue->entries[i].name, catalogue->entries[which].name) == 0) return true;
  return false;
}

kz_status kz_basin_flags_write(const kz_catalogue *catalogue, kz_store *store) {
  char *words = NULL;
  size_t bytes = 0;
  if (catalogue->count > MOST_FLAGS) return KZ_OK;
  FILE *out = open_memstream(&words, &bytes);
  if (!out) return kz_fail(KZ_FAILED, "out of memory for the meanings of the labels");
  fputs("not_settled", out);
  for (int64_t i = 0; i < catalogue->count; i++) {
    fputc(' ', out);
    print_word(catalogue->entries[i].name, out);
    if (is_shared(catalogue, i)) fprintf(out, "_%lld", (long long)i);
  }
  kz_status status = fclose(out) == 0 ? KZ_OK : kz_fail(KZ_FAILED, "out of memory for the meanings of the labels");
  if (status == KZ_OK) status = kz_store_flags(store, "basin", "attractor", -1, catalogue->count + 1, words);
  free(words);
  return status;
}
