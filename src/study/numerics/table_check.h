/* The map table's error beside the cells that it labels. Not collective. */
#ifndef KAPITZA_STUDY_TABLE_CHECK_H
#define KAPITZA_STUDY_TABLE_CHECK_H

#include "kapitza/study.h"

/* KZ_REFUSED where one period of the map table (`table_error`, rad) is off by more than a cell: the message tells the nodes that
 * would do. */
kz_status kz_steps_check_table(const kz_basin_plan *plan, double table_error);
/* A line where it is off by more than kz_steps_tolerance. */
void kz_steps_warn_table(const kz_basin_plan *plan, double table_error, FILE *summary);

#endif
