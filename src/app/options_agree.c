/* Whether all ranks were given the same command line. */
#include <string.h>

#include "app.h"

kz_status kz_options_agree(const kz_options *options, kz_ranks *ranks) {
  const char *words = strchr(options->line, ' ');
  return kz_ranks_compare(ranks, words ? words : "", "command line");
}
