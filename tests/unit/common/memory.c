/* Lists that grow. The sanitizers of the debug build see a write behind their end. */
#include <stdlib.h>

#include "../../tools/test.h"

#include "kapitza/common.h"

/* A list that is exactly as long as its items grows too, whatever its length. */
TEST(test_any_list_grows) {
  for (int64_t length = 0; length <= 9; length++) {
    int64_t *list = length > 0 ? kz_malloc((size_t)length * sizeof *list) : NULL;
    for (int64_t i = 0; i < length; i++) list[i] = i;
    for (int64_t n = length; n < 40; n++) {
      list = kz_grown(list, n, sizeof *list);
      list[n] = n;
    }
    for (int64_t i = 0; i < 40; i++) assert_int_equal(list[i], i);
    free(list);
  }
}
