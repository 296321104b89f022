/* Compares the map table's error with the cells that it labels. Not collective. */
#ifndef KAPITZA_STUDY_TABLE_CHECK_H
#define KAPITZA_STUDY_TABLE_CHECK_H

#include "kapitza/study.h"

/* KZ_REFUSED if `table_error`, the error of one period by the map table (rad), exceeds a cell; the message gives a number of nodes that is
 * enough. */
kz_status kz_steps_check_table(const kz_basin_plan *plan, double table_error);
/* Prints a warning if it exceeds kz_steps_tolerance. */
void kz_steps_warn_table(const kz_basin_plan *plan, double table_error, FILE *summary);

#endif
