/* Edges of narrow bands of attractors along a line of an atlas. */
#include "../../tools/test.h"

#include <math.h>
#include <string.h>

#include "atlas/lines.h"

enum { MOST = 8 };

/* How many attractors of a class there are above all crossings, and below `at`. */
static void bands_count(const kz_atlas_crossings *crossings, double at, int32_t *above, int32_t *below) {
  int32_t counts[KZ_ATLAS_MOST_CLASSES] = {0};
  kz_atlas_changes(crossings, -1, at, counts);
  *below = counts[0];
  kz_atlas_changes(crossings, at, 2, counts);
  *above = counts[0];
}

static kz_atlas_crossings line_of(kz_atlas_crossing *list, int64_t n, const double (*edge)[3]) {
  for (int64_t i = 0; i < n; i++)
    list[i] = (kz_atlas_crossing){.at = edge[i][0], .width = edge[i][1], .change = edge[i][2] > 0 ? 1 : -1, .curve = i};
  return (kz_atlas_crossings){.count = n, .list = list};
}

/* Checks that `kept` of n edges are left, with so many attractors below `at` and above all. */
static void bands_check(int64_t n, const double (*edge)[3], int64_t kept, double at, int32_t below, int32_t above) {
  kz_atlas_crossing list[MOST];
  kz_atlas_crossings line = line_of(list, n, edge);
  int32_t found[2];
  kz_atlas_pair(&line);
  bands_count(&line, at, found + 1, found);
  assert_int_equal(line.count, kept);
  assert_int_equal(found[0], below);
  assert_int_equal(found[1], above);
}

TEST(test_an_edge_alone_counts_for_nothing) {
  const double edges[][3] = {{0.1, 1e-7, 1}, {0.3, 1e-7, -1}, {0.5, 0.2, 1}};
  bands_check(3, edges, 1, 0.4, 0, 1);
}

TEST(test_both_edges_stay) {
  const double edges[][3] = {{0.1, 1e-6, 1}, {0.100001, 1e-6, -1}, {0.2, 3e-6, 1}, {0.200005, 2e-5, -1}};
  bands_check(4, edges, 4, 0.1000005, 1, 0);
}

/* Interpolation errs by more than the width: the edges change places, and no count is negative. */
TEST(test_edges_in_the_wrong_order_change_places) {
  const double edges[][3] = {{0.1, 1e-9, -1}, {0.1000002, 1e-9, 1}};
  bands_check(2, edges, 2, 0.1000001, 1, 0);
}

/* One more edge than the other ones need; those of another class are no partners. */
TEST(test_every_edge_has_one_partner) {
  const double edges[][3] = {{0.1, 1e-7, 1}, {0.1000001, 1e-7, 1}, {0.1000002, 1e-7, -1}, {0.1000003, 1e-7, -1}};
  kz_atlas_crossing list[MOST];
  kz_atlas_crossings line = line_of(list, 4, edges);
  int32_t above, below;
  list[3].class = 1;
  kz_atlas_pair(&line);
  assert_int_equal(line.count, 2);
  bands_count(&line, 0.5, &above, &below);
  assert_int_equal(below, 0);
}

/* Henon's map x' = a - x^2 - D x_before has its fold at a = -(1 + D)^2/4, with q = (1, 1)/sqrt 2 and p = sqrt 2 (1,
 * -D)/(1 - D); the trace is 1 + D - sqrt((1 + D)^2 + 4 a), so that it is -(1 + D) at a = 3 (1 + D)^2/4. */
TEST(test_both_edges_tell_the_width_of_henons_band) {
  const kz_cycle_kind born = {1, 1, 1}, doubled = {1, 1, -1};
  for (double d = 0; d < 1; d += 0.19) {
    const double p = sqrt(2) / (1 - d), width = (1 + d) * (1 + d), h = 1e-6, at = 0.75 * width;
    const double gradient = (sqrt(width + 4 * (at + h)) - sqrt(width + 4 * (at - h))) / (2 * h);
    assert_true(fabs(kz_atlas_band(&born, d, -p / 2, p) - width) < 1e-9);
    assert_true(fabs(kz_atlas_band(&doubled, d, 1, gradient) - width) < 1e-6);
  }
}
