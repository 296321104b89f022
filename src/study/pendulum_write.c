/* The group `pendulum` of the result file: the very numbers that were integrated, to which labels belong. */
#include "variable_words.h"
#include "kapitza/study.h"

const kz_variable kz_pendulum_variables[] = {
    {"harmonic", KZ_INT32, {"harmonic"}, NONE, "order of a harmonic of the drive"},
    {"part", KZ_UINT8, {"part"}, NONE, "part of a harmonic", {"cosine", "sine"}},
    {"vertical",
     KZ_REAL,
     {"harmonic", "part"},
     NONE,
     "harmonics beside m cos t of the vertical drive, in theta'' = (..) sin theta"},
    {"horizontal",
     KZ_REAL,
     {"harmonic", "part"},
     NONE,
     "harmonics of the horizontal drive, in theta'' = (..) cos theta"},
    {.name = NULL},
};

/* The harmonics beside m cos t; nothing for the sine. */
static kz_status write_harmonics(const kz_pendulum *p, kz_store *store) {
  if (p->harmonics == 0) return KZ_OK;
  int32_t order[KZ_HARMONICS];
  for (int32_t j = 0; j < KZ_HARMONICS; j++) order[j] = j + 1;
  KZ_TRY(kz_store_dimension(store, "/pendulum", "harmonic", p->harmonics, order));
  KZ_TRY(kz_store_dimension(store, "/pendulum", "part", 2, (const uint8_t[]){0, 1}));
  KZ_TRY(kz_store_variable(store, "/pendulum", "vertical", p->vertical));
  return kz_is_mirrored(p) ? KZ_OK : kz_store_variable(store, "/pendulum", "horizontal", p->horizontal);
}

kz_status kz_pendulum_write(const kz_parameters *p, kz_store *store) {
  const kz_pendulum_keys *si = &p->written; /* NaN where the scene has no such key */
  const struct {
    const char *name;
    double value;
  } reals[] = {{"k", p->pendulum.k},
               {"beta", p->pendulum.beta},
               {"m", p->pendulum.m},
               {"torque", p->pendulum.torque == 0 ? NAN : p->pendulum.torque},
               {"torque_amplitude", p->pendulum.torque_amplitude == 0 ? NAN : p->pendulum.torque_amplitude},
               {"constant_torque_ratio", si->constant_torque_ratio},
               {"torque_ratio", si->torque_ratio},
               {"constant_torque", si->constant_torque},
               {"oscillating_torque", si->oscillating_torque},
               {"beta_c", si->beta_c},
               {"omega", si->omega},
               {"i_dc", si->i_dc},
               {"i_ac", si->i_ac},
               {"quality_factor", p->quality_factor},
               {"drive_frequency", p->drive_frequency},
               {"drive_amplitude", p->drive_amplitude},
               {"mass", si->mass},
               {"radius", si->radius},
               {"inertia", si->inertia},
               {"friction", si->friction},
               {"gravity", si->gravity},
               {"length", si->length},
               {"decay_time", si->decay_time},
               {"pivot_amplitude", isnan(si->amplitude) ? si->pivot_amplitude : si->amplitude},
               {"pivot_frequency", p->pivot_frequency}};
  for (size_t i = 0; i < sizeof reals / sizeof reals[0]; i++)
    if (!isnan(reals[i].value)) KZ_TRY(kz_store_real(store, "/pendulum", reals[i].name, reals[i].value));
  return write_harmonics(&p->pendulum, store);
}
