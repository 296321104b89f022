/* Commands that are Python. */
#pragma once

/* This process becomes `module` of the Python package, whose file in the package is `entry`, with words [n] behind it.
 * Returns only after a failure. kz_program_path: the path of this executable, which the caller frees; NULL after a
 * failure. */
kz_status kz_package_become(const char *entry, const char *module, int n, const char *const *words);
char *kz_program_path(void);
