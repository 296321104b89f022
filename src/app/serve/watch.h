/* Watches whether somebody still reads the answers. */
#ifndef KAPITZA_APP_WATCH_H
#define KAPITZA_APP_WATCH_H

#include "kapitza/common.h"

/* Ends the process with status 0 a second after the reader of standard output has closed it, also in the middle of a frame. Call it once. */
kz_status kz_output_watch(void);

#endif
