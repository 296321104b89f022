/* Lines of orbits that are known in closed form. */
#define OWN_MAIN
#include "../../tools/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kapitza/analysis.h"

enum { N_LINES = 49, SAMPLES = 32, MOST_PERIODS = 512 };
static const double PI = 3.14159265358979323846;

typedef struct {
  double frequency; /* drive frequencies */
  double amplitude, phase;
} line_t;

/* A six-nodding cycle: dominant 1/6, satellites 5/6 and 7/6. */
static const line_t NODDING[] = {
    {1.0 / 6, 1.1291, 0.3}, {3.0 / 6, 0.0816, -1.2}, {5.0 / 6, 0.1809, 2.9}, {7.0 / 6, 0.0915, -3.0}};
static const line_t WITH_EVEN[] = {{1.0 / 6, 1.1, 0.3}, {2.0 / 6, 1e-4, 1.0}, {5.0 / 6, 0.18, 2.9}};
static const line_t FAST[] = {{1.0, 0.01, 1.0}, {2.0, 0.001, -2.0}};
static const line_t INCOMMENSURATE[] = {{0.3819660112501051, 1.0, 0.0}, {0.6180339887498949, 0.3, 1.0}};

typedef struct {
  double theta[MOST_PERIODS * SAMPLES];
  double amplitude[8 * MOST_PERIODS], phase[8 * MOST_PERIODS];
} room_t;
static room_t *room;

static int make_room(void **state) {
  (void)state;
  room = malloc(sizeof *room);
  return room == NULL;
}

static int free_room(void **state) {
  (void)state;
  free(room);
  return 0;
}

static kz_record spectrum_closed(int64_t periods, double rotation, double centre) {
  return (kz_record){periods, SAMPLES, rotation, centre, true, false};
}

/* Samples centre + a0 + rotation t + the lines, the clock `shift` drive radians ahead. */
static void spectrum_fill(const kz_record *record, double a0, const line_t *line, int n, double shift) {
  for (int64_t i = 0; i < record->periods * SAMPLES; i++) {
    double t = 2 * PI * (double)i / SAMPLES + shift;
    room->theta[i] = record->centre + a0 + record->rotation * t;
    for (int j = 0; j < n; j++) room->theta[i] += line[j].amplitude * cos(line[j].frequency * t + line[j].phase);
  }
}

static void spectrum_lines(const kz_record *record, int64_t n) {
  assert_int_equal(kz_spectrum_lines(record, room->theta, n, room->amplitude, room->phase), KZ_OK);
}

TEST(analytic_lines_come_back) {
  kz_record record = spectrum_closed(6, 0, PI);
  spectrum_fill(&record, -0.02, NODDING, 4, 0);
  spectrum_lines(&record, N_LINES);
  for (int64_t j = 1; j < N_LINES; j++) {
    double amplitude = 0, phase = NAN;
    for (int i = 0; i < 4; i++) {
      if (llrint(6 * NODDING[i].frequency) != j) continue;
      amplitude = NODDING[i].amplitude;
      phase = NODDING[i].phase;
    }
    assert_true(fabs(room->amplitude[j] - amplitude) < 1e-14);
    assert_int_equal(isnan(room->phase[j]), isnan(phase));
    if (!isnan(phase)) assert_true(fabs(room->phase[j] - phase) < 1e-12);
  }
  assert_true(fabs(room->amplitude[0] - 0.02) < 1e-14);
  assert_true(room->phase[0] == PI);
  assert_int_equal(kz_spectrum_dominant(N_LINES, room->amplitude), 1);
}

/* A mean velocity of more than half a turn a drive radian is no angle: it is not wrapped. */
TEST(mean_velocity_is_not_wrapped) {
  kz_record record = spectrum_closed(6, 0, 0);
  spectrum_fill(&record, 5, NODDING, 4, 0.7);
  spectrum_lines(&record, 20);
  assert_true(fabs(room->amplitude[0] - (2 * PI - 5)) < 1e-12);
  record.velocity = true;
  spectrum_lines(&record, 20);
  assert_true(fabs(room->amplitude[0] - 5) < 1e-12 && fabs(room->amplitude[1] - NODDING[0].amplitude) < 1e-12);
}

TEST(symmetry_is_told_from_even_lines) {
  kz_record record = spectrum_closed(6, 0, PI);
  spectrum_fill(&record, 0, NODDING, 4, 0);
  spectrum_lines(&record, N_LINES);
  assert_true(kz_spectrum_symmetric(&record, N_LINES, room->amplitude));
  spectrum_fill(&record, 1e-6, NODDING, 4, 0);
  spectrum_lines(&record, N_LINES);
  assert_false(kz_spectrum_symmetric(&record, N_LINES, room->amplitude));
  spectrum_fill(&record, 0, WITH_EVEN, 3, 0);
  spectrum_lines(&record, N_LINES);
  assert_false(kz_spectrum_symmetric(&record, N_LINES, room->amplitude));
  kz_record turning = spectrum_closed(6, 1, 0);
  spectrum_fill(&turning, 0, NODDING, 4, 0);
  spectrum_lines(&turning, N_LINES);
  assert_false(kz_spectrum_symmetric(&turning, N_LINES, room->amplitude));
}

TEST(rest_has_no_lines) {
  kz_record record = spectrum_closed(4, 0, PI);
  spectrum_fill(&record, 0, NODDING, 0, 0);
  spectrum_lines(&record, N_LINES - 1);
  assert_int_equal(kz_spectrum_dominant(N_LINES - 1, room->amplitude), 0);
  assert_int_equal(kz_spectrum_period(&record, N_LINES - 1, room->amplitude), 1);
  assert_true(kz_spectrum_symmetric(&record, N_LINES - 1, room->amplitude));
  for (int j = 0; j < N_LINES - 1; j++) assert_true(isnan(room->phase[j]));
}

/* An open record: any number of periods, a fitted rotation. */
static int64_t open_period(int64_t periods, double rotation, const line_t *line, int n, double *largest) {
  kz_record record = {periods, SAMPLES, rotation, 0, false, false};
  spectrum_fill(&record, 0.3, line, n, 0.1);
  record.rotation = kz_spectrum_rotation(&record, room->theta);
  assert_true(fabs(record.rotation - rotation) < 1e-5);
  spectrum_lines(&record, 8 * periods);
  *largest = room->amplitude[kz_spectrum_dominant(8 * periods, room->amplitude)];
  return kz_spectrum_period(&record, 8 * periods, room->amplitude);
}

TEST(open_records_tell_n) {
  double largest;
  assert_int_equal(open_period(500, 0, NODDING, 4, &largest), 6);
  assert_true(fabs(largest - NODDING[0].amplitude) < 0.1 * NODDING[0].amplitude);
  assert_int_equal(open_period(504, 0, NODDING, 4, &largest), 6);
  assert_true(fabs(largest - NODDING[0].amplitude) < 1e-4);
  assert_int_equal(open_period(333, 2.0 / 6, NODDING, 4, &largest), 6);
  assert_int_equal(open_period(333, 1.0 / 4, FAST, 2, &largest), 4);
  assert_int_equal(open_period(333, 0, FAST, 2, &largest), 1);
  assert_int_equal(open_period(500, 0, INCOMMENSURATE, 2, &largest), 0);
  assert_int_equal(open_period(40, 0, NODDING, 4, &largest), 0); /* too short for n = 6 */
}

TEST(too_many_lines_are_refused) {
  kz_record record = spectrum_closed(1, 0, 0);
  kz_message_clear();
  assert_int_equal(kz_spectrum_lines(&record, room->theta, SAMPLES / 2 + 1, room->amplitude, room->phase), KZ_REFUSED);
  assert_non_null(strstr(kz_message(), "17 lines"));
  kz_message_clear();
}

TEST(names) {
  static const struct {
    int64_t period, winding;
    int centre;
    const char *name;
  } TABLE[] = {{1, 0, KZ_ABOUT_DOWN, "down"},
               {1, 0, KZ_ABOUT_INVERTED, "inverted"},
               {2, 0, KZ_ABOUT_INVERTED, "flutter"},
               {2, 0, KZ_ABOUT_DOWN, "down 2-nodding"},
               {6, 0, KZ_ABOUT_DOWN, "down 6-nodding"},
               {4, 0, KZ_ABOUT_INVERTED, "inverted 4-nodding"},
               {1, 1, KZ_ROTATING, "rotation +1/1"},
               {6, -2, KZ_ROTATING, "rotation -2/6"},
               {3, 0, KZ_ABOUT_NEITHER, "wide 3-nodding"},
               {0, 0, KZ_ABOUT_NEITHER, "chaotic"}};
  char text[KZ_NAME_LENGTH];
  for (size_t i = 0; i < sizeof TABLE / sizeof TABLE[0]; i++) {
    kz_orbit_name(TABLE[i].period, TABLE[i].winding, TABLE[i].centre, text);
    assert_string_equal(text, TABLE[i].name);
  }
}

int main(void) {
  return run_all_tests(make_room, free_room);
}
