/* Whether anybody still reads the answers, heard at any time. */
#ifndef KAPITZA_APP_WATCH_H
#define KAPITZA_APP_WATCH_H

#include "kapitza/common.h"

/* Ends the process, with status 0, a second after the reader of standard output has gone: also where a frame has not heard of it
   by then. Called once. */
kz_status kz_output_watch(void);

#endif
