/* The table of every key of a scene. A study's keys stand under its own row; the row's field says whether it is wanted. */
#include <math.h>
#include <string.h>

#include "kapitza/analysis.h"
#include "key_rows.h"

/* The names of the kernel's table of schemes. */
static const char *scheme_words(void) {
  static char words[512];
  words[0] = '\0';
  for (int32_t row = 0; row < kz_scheme_count(); row++) {
    if (row > 0) strncat(words, "|", sizeof words - strlen(words) - 1);
    strncat(words, kz_scheme_at(row).name, sizeof words - strlen(words) - 1);
  }
  return words;
}

const kz_key kz_keys[] = {
    TEXT("title", "", title, "One line that names the scene in files and pictures."),

    MAPPING("pendulum", NULL, KZ_NO_FIELD,
            "The pendulum, given in one of three ways (a, b, c). A scene with the study `stability` alone needs none."),
    PENDULUM("ac", quality_factor, "", KZ_ABOVE_ZERO, "",
             "Quality factor Q = omega0 I/b, so that beta = 1/(Omega Q). Left out in (a): no damping."),
    PENDULUM("a", drive_frequency, "", KZ_ABOVE_ZERO, NULL,
             "Drive frequency over natural frequency, Omega = omega/omega0, so that k = 1/Omega^2."),
    PENDULUM("a", drive_amplitude, "", -DBL_MAX, NULL, "Drive amplitude epsilon = (A/r)(M r^2/I), so that m = epsilon."),
    PENDULUM("b", k, "", -DBL_MAX, NULL, "Gravity, 1/Omega^2; 0 = none, below 0 = upward."),
    PENDULUM("b", damping, "", 0.0, NULL, "Damping, beta of theta'' + beta theta' + (k - m cos t) sin theta = 0."),
    PENDULUM("b", m, "", -DBL_MAX, NULL, "Drive amplitude, of any sign."),
    PENDULUM("c", length, "m", KZ_ABOVE_ZERO, "",
             "Length of a pendulum that is a point mass (I = M l^2). Another body needs mass, radius and inertia."),
    PENDULUM("c", frequency, "Hz", KZ_ABOVE_ZERO, "", "Frequency of the pivot, omega/(2 pi). Give this or pivot_frequency."),
    PENDULUM("c", amplitude, "m", -DBL_MAX, "", "Amplitude A of the pivot; m = M r A/I = A/l."),
    PENDULUM("c", decay_time, "s", KZ_ABOVE_ZERO, "",
             "Time in which small swings shrink by a factor e, 2 I/b. Instead of quality_factor."),
    PENDULUM("c", gravity, "m s-2", -DBL_MAX, "", "Gravity g; k = M g r/(I omega^2) = g/(l omega^2). Left out: 9.80665."),
    PENDULUM("c", mass, "kg", KZ_ABOVE_ZERO, "", "Mass M."),
    PENDULUM("c", radius, "m", KZ_ABOVE_ZERO, "", "Distance r from the pivot to the centre of mass."),
    PENDULUM("c", inertia, "kg m2", KZ_ABOVE_ZERO, "", "Moment of inertia I about the pivot; at least M r^2."),
    PENDULUM("c", friction, "kg m2 s-1", 0.0, "", "Friction b; beta = b/(I omega). Instead of quality_factor."),
    PENDULUM("c", pivot_amplitude, "m", -DBL_MAX, "", "Another name of amplitude."),
    PENDULUM("c", pivot_frequency, "rad s-1", KZ_ABOVE_ZERO, "", "Angular frequency omega of the pivot. Instead of frequency."),
    REAL("pendulum.tilt", "rad", -M_PI, M_PI, "", parameters.written.tilt, "Angle between the pivot's path and the vertical."),
    REAL("pendulum.ellipse", "", -10, 10, "", parameters.written.ellipse,
         "Makes the pivot's path an ellipse: the ratio of its axis across the path to the one along it; above 0 = clockwise."),
    REAL("pendulum.torque", "", -1e6, 1e6, "", parameters.written.torque,
         "Constant torque on the pendulum, in units of I omega^2."),
    REAL("pendulum.torque_amplitude", "", -1e6, 1e6, "", parameters.written.torque_amplitude,
         "A torque that oscillates beside it, torque_amplitude cos t, without a drive of the pivot (a Josephson junction under "
         "microwaves). Angles are counted from the swing that it gives to a free pendulum."),
    WORD("pendulum.waveform", "sine|square|triangle|samples", "", parameters.written.waveform,
         "Form of the drive in time, which is that of the pivot's downward acceleration; square and triangle: their Fourier "
         "series "
         "up to order 7; samples: of the list samples up to order 16."),
    ROW("pendulum.samples", KZ_KEY_REALS, "", AT(parameters.written.samples),
        "The drive at equal times of a period, the first at t = 0, in units of drive_amplitude; its mean is left out.",
        .unit = "", .low = -1e6, .high = 1e6),
    MAPPING("pendulum.ramp", "", AT(parameters.has_ramp),
            "Damping or drive begins at another value when a cell of a basin is released, and comes to its own value."),
    WORD("pendulum.ramp.key", "damping|drive_amplitude", NULL, parameters.written.ramp_key,
         "The quantity that changes: beta, or all of the drive in proportion."),
    REAL("pendulum.ramp.from", "", -1e6, 1e6, NULL, parameters.written.ramp_from, "beta or m at the beginning, t = 0."),
    REAL("pendulum.ramp.periods", "", 0, 1e5, NULL, parameters.written.ramp_periods,
         "Number of drive periods that the change takes."),
    WORD("pendulum.ramp.shape", "linear|smooth", "linear", parameters.written.ramp_shape,
         "linear in time; smooth: 3 s^2 - 2 s^3, which begins and ends without a kink."),
    ROW("pendulum.harmonics", KZ_KEY_HARMONICS, "", AT(parameters.written.harmonics),
        "Further harmonics of the drive: m amplitude cos(order t + phase), the phase in rad or degrees.", .unit = ""),
    ROW("pendulum.vertical", KZ_KEY_REALS, "", AT(parameters.written.vertical),
        "Coefficients of the equation, beside k - m cos t: cosine and sine of the first harmonic, of the second, .., 16 at "
        "most, "
        "as the group pendulum of a result holds them. Instead of waveform, harmonics, tilt and ellipse.",
        .unit = "", .low = -1e7, .high = 1e7),
    ROW("pendulum.horizontal", KZ_KEY_REALS, "", AT(parameters.written.horizontal),
        "The same of a pivot that moves aside: b(t) of the equation.", .unit = "", .low = -1e7, .high = 1e7),

    ROW("numerics", KZ_KEY_MAPPING, "", KZ_NO_FIELD, "How one drive period is integrated.", .unit = "",
        .former = "precision=basin.method exact"),
    ROW("numerics.scheme", KZ_KEY_WORD, "processed", AT(asked.scheme),
        "Integrator. processed: one kick a step, the fastest; the program takes split6 if it does not reach the tolerance; "
        "split schemes are exact in the damping; rk4: classical Runge-Kutta.",
        .unit = "", .words_from = scheme_words, .former = "split4=split6|split6-11=split6", CHOSEN),
    COUNT("numerics.steps_per_period", 1, 100000, "auto", asked.steps_per_period,
          "Steps of the scheme in a drive period. auto: as many as the tolerance and the speeds need (processed); the default "
          "of the scheme, or more for small cells (others).",
          .words = "auto", CHOSEN),
    ROW("numerics.tolerance", KZ_KEY_REAL, "1e-12", AT(asked.tolerance),
        "Error of one drive period that auto allows the scheme processed, measured against quad precision; small cells allow "
        "less, and method exact a tenth of it where rounding lets it.",
        .unit = "rad", .low = 1e-15, .high = 0.01, CHOSEN),

    ROW("basin", KZ_KEY_MAPPING, "", AT(has_basin), "Study: the attractors, then a label for every cell of a window.",
        .unit = "", .former = "flag_undecided=basin.method exact"),
    MAPPING("basin.theta", "", KZ_NO_FIELD,
            "Angles of the cells; min and max, or centre and width, at most 2 pi; neither: the whole circle [-pi, pi)."),
    EDGE("basin.theta.min", "rad", 1e6, "", basin.theta_edges.min, "Lower edge of the window."),
    EDGE("basin.theta.max", "rad", 1e6, "", basin.theta_edges.max, "Upper edge of the window."),
    DECIMAL("basin.theta.centre", "rad", -1e6, 1e6, "", basin.theta.centre, CENTRE_HELP),
    DECIMAL("basin.theta.width", "rad", 1e-300, 7, "", basin.theta.width, "Width of the window."),
    INTEGER("basin.theta.count", 1, 1e6, "1000", basin.theta.count, "Cells along theta."),
    MAPPING("basin.velocity", NULL, KZ_NO_FIELD, "Velocities of the cells."),
    EDGE("basin.velocity.min", "rad per drive radian", KZ_MOST_SPEED, NULL, basin.velocity_edges.min,
         "Lower edge of the window."),
    EDGE("basin.velocity.max", "rad per drive radian", KZ_MOST_SPEED, NULL, basin.velocity_edges.max,
         "Upper edge of the window."),
    DECIMAL("basin.velocity.centre", "rad per drive radian", -KZ_MOST_SPEED, KZ_MOST_SPEED, NULL, basin.velocity.centre,
            CENTRE_HELP),
    DECIMAL("basin.velocity.width", "rad per drive radian", 1e-300, 2e9, NULL, basin.velocity.width, "Width of the window."),
    INTEGER("basin.velocity.count", 1, 1e6, "1000", basin.velocity.count, "Cells along the velocity."),
    WORD("basin.method", KZ_JOINED(KZ_METHOD_WORDS), "exact", basin.method,
         "exact: the error of each orbit decides its label; undecided cells are followed again in more precision, and flagged "
         "in evidence if quad precision does not decide them; direct: double precision alone, doubtful labels are marked in "
         "evidence; icm: interpolated cell mapping, the method of the papers. A sweep uses direct.",
         .former = "hybrid=direct", CHOSEN),
    WORD("basin.undecided", KZ_JOINED(KZ_UNDECIDED_WORDS), "flag", basin.undecided,
         "Cells that quad precision does not decide, by method exact. flag: flagged with two candidates; decide: followed in "
         "as many digits as needed, some 0.1 to 0.4 s a cell."),
    MAPPING("basin.icm", "", KZ_NO_FIELD, "The map table of method icm."),
    INTEGER("basin.icm.theta", 8, 1e5, "1000", basin.table_theta, "Nodes along theta.", CHOSEN),
    INTEGER("basin.icm.velocity", 8, 1e5, "1000", basin.table_velocity, "Nodes along the velocity.", CHOSEN),
    ROW("basin.icm.interpolation", KZ_KEY_WORD, "quintic", AT(basin.interpolation), "Interpolation between the nodes.",
        .unit = "", .words = KZ_JOINED(KZ_INTERPOLATION_WORDS), .former = "cubic=quintic", CHOSEN),
    INTEGER(
        "basin.max_periods", 1, 4e9, "", basin.max_periods,
        "Drive periods after which a cell counts as not settled; left out: the number that the damping needs, at least 2000."),
    REAL("basin.start_phase", "rad", -1e6, 1e6, "", parameters.written.start_phase,
         "Phase of the drive at which the cells are released; the strobe points of the file are at phase 0 as always."),
    MAPPING("basin.attractors", "", KZ_NO_FIELD, "The search for attractors before the cells are labelled."),
    INTEGER("basin.attractors.starts", 1, 1e8, "8192", basin.starts, "Starts of the first round."),
    INTEGER("basin.attractors.max_period", 1, 512, "48", basin.max_period, "Longest period of the search."),
    INTEGER("basin.attractors.seed", 0, 9007199254740992.0, "1", basin.seed,
            "Number that chooses the starts; another seed gives other starts."),
    BOOLEAN(
        "basin.proof", "false", basin.proof,
        "Prove the labels under the differential equation itself: `evidence` marks those that are proved, `proved_share` is "
        "their share, `other_share_high` bounds the area that ends elsewhere. Some ten times the time of the cells."),
    REAL("basin.accuracy", "", 0.5, 0.999999, "", basin.accuracy,
         "Share of right labels, instead of method, icm and numerics: the program takes the cheapest setting whose labels "
         "agree with a sample in quad precision to this share (95 % bound), or method exact if there is none."),

    MAPPING("basin.boundary", "", AT(basin.has_boundary),
            "How fractal the boundaries are: uncertainty exponents decade by decade, box-counting dimension, basins that share "
            "their boundary."),
    INTEGER("basin.boundary.pairs", 100, 1e8, "50000", basin.boundary.pairs,
            "Starts of the window, each with a partner at `farthest`, a tenth of that, ... rad."),
    REAL("basin.boundary.farthest", "rad", 1e-300, 1, "0.01", basin.boundary.farthest,
         "Distance of the first partner. With method exact it may be any share of the width of a deep window."),
    INTEGER("basin.boundary.decades", KZ_BOUNDARY_FEWEST_DECADES, KZ_BOUNDARY_MOST_DECADES, "10", basin.boundary.decades,
            "Decades of these distances: 10 go from 0.01 down to 1e-12 rad; nearer partners need basin.method exact, because "
            "doubles cannot distinguish such starts."),
    INTEGER("basin.phases", 2, 64, "", basin.phases,
            "Also releases every cell at so many phases of the drive, spread evenly over a period from 0 on: how much of the "
            "window ends "
            "alike at all of them."),
    MAPPING("basin.shocks", "", AT(basin.has_shocks),
            "The smallest shocks (a sudden change of angle, of velocity, of both) that push each attractor out of its basin."),
    REAL("basin.shocks.scale", "rad per drive radian", 1e-6, 1e6, "1", basin.shocks.scale,
         "Change of the velocity that counts as much as 1 rad; the size of a shock is hypot(dtheta, dv/scale)."),
    ROW("basin.shocks.sizes", KZ_KEY_REALS, "[0.1, 0.3, 1]", AT(basin.shocks.sizes),
        "Sizes, ascending, for which the share of harmless shocks is computed.", .unit = "rad", .low = KZ_ABOVE_ZERO,
        .high = 1e3),

    MAPPING("tradeoff", "", AT(has_tradeoff),
            "Study: time and wrong labels of many settings on the basin's window, compared with quad precision."),
    INTEGER("tradeoff.samples", 10, 1e6, "4000", tradeoff.samples, "Random cells that are compared."),
    WORDS("tradeoff.settings", kz_tradeoff_words, "", tradeoff.settings, "Settings that are compared; left out: all."),

    MAPPING("attractors", "", AT(has_attractors), "Study: the attractors of a window of starts, without a grid."),
    THETA_WINDOW(attractors, "Angles of the starts; left out: the whole circle [-pi, pi)."),
    VELOCITY_WINDOW(attractors, KZ_MOST_SPEED, NULL, NULL, NULL, "Velocities of the starts."),
    INTEGER("attractors.starts", 1, 1e8, "8192", attractors.starts, "Starts of the search."),
    INTEGER("attractors.max_period", 1, 512, "48", attractors.max_period, "Longest period of the search."),
    INTEGER("attractors.seed", 0, 9007199254740992.0, "1", attractors.seed,
            "Number that chooses the starts; another seed gives other starts."),

    MAPPING("saddles", "", AT(has_saddles),
            "Study: all unstable cycles of the strobe map up to a period, and a test whether any is missing."),
    THETA_WINDOW(saddles, "Angles of the cycles' points; left out: the whole circle [-pi, pi)."),
    VELOCITY_WINDOW(saddles, 1e3, NULL, NULL, NULL, "Velocities of the cycles' points."),
    INTEGER("saddles.max_period", 1, KZ_SADDLES_MAX_PERIOD, "1", saddles.max_period,
            "Longest period, in drive periods; their number and the time grow exponentially with it."),

    MAPPING("manifolds", "", AT(has_manifolds),
            "Study: stable and unstable manifolds of the cycles of saddles, as polylines; stable ones bound the basins."),
    ROW("manifolds.saddles", KZ_KEY_INTEGERS, "", AT(manifolds.saddles),
        "Ids of the cycles in the group saddles; left out: all of them.", .unit = "", .low = 0, .high = 1e6),
    WORD("manifolds.kind", "both|stable|unstable", "both", manifolds.kind, "Which manifolds."),
    REAL("manifolds.length", "rad", KZ_ABOVE_ZERO, 1e5, "20", manifolds.length,
         "Length of each branch: rad and rad per drive radian together, below max_speed."),
    REAL("manifolds.spacing", "rad", 1e-6, 1, "0.02", manifolds.spacing,
         "Largest distance of neighbouring points; up to 32 times smaller where a manifold bends by over 0.3 rad."),
    REAL("manifolds.max_speed", "rad per drive radian", KZ_ABOVE_ZERO, 1e3, "2", manifolds.max_speed,
         "Parts at larger speeds are left out."),

    MAPPING("edge", "", AT(has_edge), "Study: the saddle on the edge between the basins of two starts, by edge tracking."),
    EDGE_START(first, "A start; the edge of its basin is followed."),
    EDGE_START(second, "A start that ends elsewhere."),
    INTEGER("edge.periods", 1, 1e6, "2000", edge.periods, "Largest number of drive periods for which the edge is followed."),
    INTEGER("edge.max_period", 1, KZ_EDGE_MOST_PERIOD, "16", edge.max_period, "Longest period of a cycle that is recognised."),

    MAPPING("orbit", "", AT(has_orbit), "Study: one motion, its strobe points, turning points and spectrum."),
    MAPPING("orbit.start", "", KZ_NO_FIELD, "The start, at t = 0. Give this or an attractor."),
    REAL("orbit.start.theta", "rad", -1e6, 1e6, NULL, orbit.theta, "Angle from down."),
    REAL("orbit.start.velocity", "rad per drive radian", -1e9, 1e9, NULL, orbit.velocity, "Velocity."),
    INTEGER("orbit.attractor", 0, 32767, "", orbit.attractor,
            "Id in the catalogue of the basin or attractors study of the same scene: its closed orbit from the first strobe "
            "point."),
    WORD("orbit.model", "pendulum|mathieu|effective", "pendulum", orbit.model,
         "pendulum: the full equation; mathieu: linear about down or inverted; effective: the slow equation of the effective "
         "potential."),
    WORD("orbit.about", "down|inverted", "", orbit.about, "Position that the model mathieu is linear about; left out: down."),
    INTEGER("orbit.transient", 0, 1e9, "0", orbit.transient, "Drive periods before the record begins."),
    INTEGER("orbit.periods", 1, 1e6, "", orbit.periods,
            "Drive periods of the record; left out: 100, or the period of a closed orbit; a closed orbit is recorded once at "
            "least."),
    INTEGER("orbit.samples_per_period", 4, 4096, "96", orbit.samples_per_period, "Points of the series in a drive period."),
    BOOLEAN("orbit.closed", "false", orbit.closed,
            "The cycle near the start, by Newton's method, instead of the motion from it; of the model mathieu: the motion "
            "must close."),
    INTEGER("orbit.period", 1, 512, "", orbit.period,
            "Period of the closed orbit in drive periods. Left out: the program finds it."),

    MAPPING("stability", "", AT(has_stability),
            "Study: the chart of the linear equation u'' + beta u' + (k - m f(t)) u = 0 over (k, m), and its transition "
            "curves; f is "
            "the wave form of the pendulum, or cos t."),
    STABILITY_AXIS("ab", k, NULL, "Values of k, both ends included; negative about the inverted position."),
    STABILITY_AXIS("ab", m, NULL, "Values of m, both ends included; about the inverted position m changes its sign as k does."),
    STABILITY_DAMPING("ac", damping, 0.0, "beta, the same at every point; left out, with quality_factor: no damping."),
    STABILITY_DAMPING("bd", quality_factor, 1e-3, "Q: beta = sqrt(abs(k))/Q at each point."),
    STABILITY_AXIS("cd", a, "", "Instead of k, in the words of ion traps: a = 4 k."),
    STABILITY_AXIS("dc", q, "", "Instead of m, in the words of ion traps: q = 2 m."),
    ROW("stability.curves", KZ_KEY_WORDS, "", AT(stability.curves),
        "Transition curves to compute: those of the sine over k, where a curve that turns back has a second, upper branch, "
        "which is "
        "added; hill_1 to 5 of any wave form over m, without damping; meissner_1 to 5 of the true square wave over m.",
        .unit = "", .words_from = kz_curve_names),
    ROW("stability.subharmonics", KZ_KEY_INTEGERS, "", AT(stability.subharmonics),
        "Periods n of subharmonic solutions. Their curves are computed exactly and by the determinant.", .unit = "", .low = 2,
        .high = 1000),

    MAPPING("potential", "", AT(has_potential), "Study: the effective potential of the slow motion over the whole circle."),
    ROW("potential.drive_amplitudes", KZ_KEY_REALS, NULL, AT(potential.drive_amplitudes),
        "Values of m (epsilon), instead of the pendulum's.", .unit = "", .low = -1e6, .high = 1e6),
    MAPPING("potential.theta", "", KZ_NO_FIELD, "Angles from -pi to pi, both ends included."),
    INTEGER("potential.theta.count", 2, 1e6, "721", potential.theta_count, "Number of angles."),

    MAPPING("sweep", "", AT(has_sweep), "Study: quantities along one key of the pendulum mapping."),
    ROW("sweep.parameter", KZ_KEY_WORD, NULL, AT(sweep.parameter),
        "Key of the pendulum mapping, as written there, that takes the values.", .unit = "", .words_from = kz_sweep_words),
    REAL("sweep.min", KZ_OWN_UNIT, -DBL_MAX, DBL_MAX, NULL, sweep.values.min, "First value."),
    REAL("sweep.max", KZ_OWN_UNIT, -DBL_MAX, DBL_MAX, NULL, sweep.values.max, "Last value."),
    INTEGER("sweep.count", 2, 1e5, NULL, sweep.values.count, "Number of values, both ends included."),
    ROW("sweep.measure", KZ_KEY_WORDS, NULL, AT(sweep.measure),
        "attractors: branches joined by continuation, with their ends; basin_fractions: their shares of the cells of basin, or "
        "of the starts; lifetime: mean settling time of long transients; resilience: smallest shocks that leave the basins; "
        "phases: share of cells or starts that ends alike at all phases of release; flutter_amplitude: of the period-2 cycle "
        "about inverted; flutter_zone: how far it reaches when m is raised; release_angle: from rest; strobe: bifurcations.",
        .unit = "", .words_from = kz_sweep_measure_words),
    THETA_WINDOW(sweep, "Angles of the starts; left out: the whole circle [-pi, pi)."),
    VELOCITY_WINDOW(sweep, KZ_MOST_SPEED, "", "-2", "2", "Velocities of the starts; a grid of basin has its own window."),
    INTEGER("sweep.starts", 1, 1e7, "2048", sweep.starts, "Starts of the search at each value."),
    INTEGER("sweep.max_period", 1, 512, "48", sweep.max_period, "Longest period of the search."),
    INTEGER("sweep.seed", 0, 9007199254740992.0, "1", sweep.seed,
            "Number that chooses the starts; another seed gives other starts."),
    MAPPING("sweep.start", "", KZ_NO_FIELD, "Where both walks of strobe start."),
    REAL("sweep.start.theta", "rad", -1e6, 1e6, "3.1", sweep.start_theta, "Angle from down."),
    REAL("sweep.start.velocity", "rad per drive radian", -KZ_MOST_SPEED, KZ_MOST_SPEED, "0", sweep.start_velocity, "Velocity."),
    INTEGER("sweep.transient", 0, 1e7, "400", sweep.transient, "Drive periods of strobe at each value before the record."),
    REAL("sweep.shock_scale", "rad per drive radian", 1e-6, 1e6, "1", sweep.shock_scale,
         "Change of the velocity that counts as much as 1 rad in resilience."),
    INTEGER("sweep.phases", 2, 64, "8", sweep.phases, "Phases of release for the measure phases, evenly over a period."),
    INTEGER("sweep.samples", 1, 1e5, "64", sweep.samples, "Strobe points of each walk at each value."),

    MAPPING("chart", "", AT(has_chart), "Study: where the same starts end, over a plane of two keys of the pendulum mapping."),
    PLANE_AXIS(chart, x, "The key along the horizontal axis."),
    CHART_COUNT(x),
    PLANE_AXIS(chart, y, "The key along the vertical axis."),
    CHART_COUNT(y),
    MAPPING("chart.start", NULL, KZ_NO_FIELD, "Starts, at t = 0; each has a chart of its own."),
    ROW("chart.start.theta", KZ_KEY_REALS, NULL, AT(chart.theta), "Angles from down.", .unit = "rad", .low = -1e6, .high = 1e6),
    ROW("chart.start.velocity", KZ_KEY_REALS, "[0]", AT(chart.velocity), "Velocities: one for each angle, or one for all.",
        .unit = "rad per drive radian", .low = -1e3, .high = 1e3),
    INTEGER("chart.max_period", 1, KZ_CHART_MOST_PERIOD, "16", chart.max_period,
            "Longest period of a cycle that is recognised."),
    INTEGER("chart.max_periods", 1, 1e8, "", chart.max_periods,
            "Drive periods after which a motion counts as not settled; left out: the number that the damping needs, at least "
            "2000."),

    MAPPING(
        "atlas", "", AT(has_atlas),
        "Study: all curves on which cycles are born, lose their stability or their symmetry, over a plane of two keys of the "
        "pendulum mapping, and the attractors of every point of it."),
    PLANE_AXIS(atlas, x, "The key along the horizontal axis."),
    PLANE_AXIS(atlas, y, "The key along the vertical axis."),
    INTEGER("atlas.max_period", 1, KZ_ATLAS_MOST_PERIOD, "6", atlas.max_period, "Longest period of the cycles, drive periods."),
    INTEGER(
        "atlas.checks", 0, 1e5, "300", atlas.checks,
        "Random points of a round whose attractors are searched; rounds go on until one finds nothing that the curves do not "
        "tell, at most 6."),
    INTEGER("atlas.points", 16, 4000, "400", atlas.points, "Cells along each axis for the number and the lists of attractors."),

    {.path = NULL},
};
