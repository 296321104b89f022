/* How much of a test the build with sanitizers runs. */
#pragma once

/* The sanitizers make everything ten times slower: a part of the starts shows them the same code. */
#ifdef __SANITIZE_ADDRESS__
enum { PART = 20 };
#else
enum { PART = 1 };
#endif
