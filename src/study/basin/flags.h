/* Which label is which attractor, as attributes of the labels. */
#ifndef KZ_STUDY_BASIN_FLAGS_H
#define KZ_STUDY_BASIN_FLAGS_H

#include "../attractors/catalogue.h"
#include "kapitza/store.h"

/* Writes flag_values (-1 = not settled, then the ids) and flag_meanings of basin/attractor; nothing for more than 16,000 attractors. */
kz_status kz_basin_flags_write(const kz_catalogue *catalogue, kz_store *store);

#endif
