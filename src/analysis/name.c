/* Names of attractors. */
#include <inttypes.h>

#include "kapitza/analysis.h"

/* Motions without rotation that have a name of their own. */
static const struct {
  int64_t period;
  int centre;
  const char *name;
} NAMED[] = {
    {1, KZ_ABOUT_DOWN, "down"},
    {1, KZ_ABOUT_INVERTED, "inverted"},
    {2, KZ_ABOUT_INVERTED, "flutter"},
};

static const char *const PLACE[] = {[KZ_ABOUT_DOWN] = "down",
                                    [KZ_ABOUT_INVERTED] = "inverted",
                                    [KZ_ROTATING] = "rotation",
                                    [KZ_ABOUT_NEITHER] = "wide"};

void kz_orbit_name(int64_t period, int64_t winding, int centre, char *text) {
  for (size_t i = 0; i < sizeof NAMED / sizeof NAMED[0]; i++) {
    if (NAMED[i].period == period && NAMED[i].centre == centre) {
      strcpy(text, NAMED[i].name);
      return;
    }
  }
  if (period == 0)
    strcpy(text, winding == 0 ? "chaotic" : winding > 0 ? "running +" : "running -");
  else if (centre == KZ_ROTATING)
    snprintf(text, KZ_NAME_LENGTH, "rotation %+" PRId64 "/%" PRId64, winding, period);
  else
    snprintf(text, KZ_NAME_LENGTH, "%s %" PRId64 "-nodding", PLACE[centre], period);
}
