/* The end of standard input, heard at any time. */
#ifndef KAPITZA_APP_WATCH_H
#define KAPITZA_APP_WATCH_H

#include "kapitza/common.h"

/* Ends the process, with status 0, a second after whoever asks has gone: also where a frame has not heard of it by then. Once. */
kz_status kz_input_watch(void);

#endif
