/* Writes the results of a proof to the file and the summary. */
#ifndef KAPITZA_STUDY_PROOF_WRITE_H
#define KAPITZA_STUDY_PROOF_WRITE_H

#include <stdio.h>

#include "attractors/catalogue.h"
#include "measures.h"
#include "proof.h"

/* Attributes of /basin, columns of /attractors, and lines of the summary. Rank 0. */
kz_status kz_proof_write(const kz_proof *proof, const kz_catalogue *catalogue, int64_t cells, const kz_counts *counts,
                         const kz_proof_sample *sample, kz_store *store, FILE *summary);

#endif
