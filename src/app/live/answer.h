/* Answers of the command serve: a header of JSON on one line, then its payload (docs/reference/serve.md). */
#pragma once

#include "kapitza/study_atlas.h"
#include "request.h"

/* Each writes one answer to standard output; KZ_STOPPED if nobody reads it any more. sequence KZ_UNSET_INTEGER = null.
 */
kz_status kz_answer_ready(const kz_scene *scene);
kz_status kz_answer_catalogue(int64_t sequence, bool final, const kz_live_catalogue *catalogue);
kz_status kz_answer_raster(const kz_request *request, bool final, const kz_live_raster *raster);
kz_status kz_answer_where(int64_t sequence, const kz_coordinate start[2], const kz_ending *ending, double omega);
/* theta, velocity [samples] */
kz_status kz_answer_orbit(const kz_request *request, int64_t samples, const double *theta, const double *velocity);
kz_status kz_answer_plane(int64_t sequence, bool final, const kz_plane_raster *raster);
kz_status kz_answer_motions(int64_t sequence, const kz_motions *motions);
kz_status kz_answer_line(int64_t sequence, const kz_atlas_branches *line);
kz_status kz_answer_ended(int64_t sequence);
/* Contains the present message, which is then cleared. */
kz_status kz_answer_error(int64_t sequence, kz_status status);

/* Watches whether somebody still reads the answers: ends the process with status 0 a second after the reader of
 * standard output has closed it, also in the middle of a frame. Call it once. */
kz_status kz_answer_watch(void);
