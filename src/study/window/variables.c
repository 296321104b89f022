#include "kapitza/study.h"

/* None of its own. */
const kz_variable kz_deep_variables[] = {{0}};
