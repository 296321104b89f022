/* Variables of the group atlas of the result file. */
#include "variable_words.h"
#include "types.h"

#define OF_CURVE {"curve"}
#define OF_DECADE {"decade"}
#define OF_POINT {"point"}
#define OF_SPECIAL {"special"}
#define OF_CLASS {"class"}
#define OF_REGION {"region"}

/* clang-format off */
const kz_variable kz_atlas_variables[] = {
    {"curve", KZ_INT32, OF_CURVE, NONE, "number of the curve"},
    {"curve_kind", KZ_INT8, OF_CURVE, NONE,
     "what happens on the curve", {"fold", "period_doubling", "symmetry_breaking", "rest_swings", "rest_leans"}},
    {"curve_period", KZ_INT16, OF_CURVE, PERIODS, "period of the cycle"},
    {"curve_winding", KZ_INT32, OF_CURVE, NONE,
     "net turns in one period of the cycle; of two mirror images those of the one that turns counterclockwise"},
    {"curve_centre", KZ_INT8, OF_CURVE, NONE, "what the cycle moves about", {CENTRES}},
    {"curve_symmetric", KZ_INT8, OF_CURVE, NONE, "whether the cycle is its own mirror image", {"no", "yes"}},
    {"curve_name", KZ_TEXT, OF_CURVE, NONE, "what happens there to which motion"},
    {"curve_first", KZ_INT32, OF_CURVE, NONE, "place of the curve's first point in the list of points"},
    {"curve_points", KZ_INT32, OF_CURVE, NONE, "number of the curve's points"},
    {"curve_closed", KZ_INT8, OF_CURVE, NONE, "whether the curve is closed", {"no", "yes"}},
    {"curve_open", KZ_INT8, OF_CURVE, NONE,
     "number of its ends that lie within the plane without a reason: the curve is not whole"},
    {"curve_band", KZ_REAL, OF_CURVE, NONE,
     "widest band of attractors beside the curve within the plane, in sides of the plane"},
    {"curve_places", KZ_INT32, OF_CURVE, NONE, "number of places of the census from which the curve was seen"},
    {"decade", KZ_INT32, OF_DECADE, NONE, "number of the decade of curve_band, the widest first"},
    {"decade_band", KZ_REAL, OF_DECADE, NONE, "least curve_band of the decade"},
    {"decade_curves", KZ_INT32, OF_DECADE, NONE, "number of its curves"},
    {"decade_seen", KZ_INT32, OF_DECADE, NONE, "number of them that places of the census saw"},
    {"decade_once", KZ_INT32, OF_DECADE, NONE, "number of them that one place saw"},
    {"decade_twice", KZ_INT32, OF_DECADE, NONE, "number of them that two places saw"},
    {"decade_missing", KZ_REAL, OF_DECADE, NONE,
     "estimated number of curves of the decade that are missing (Chao 1987)"},
    {"decade_missing_low", KZ_REAL, OF_DECADE, NONE, "lower end of the 95 % interval of this number"},
    {"decade_missing_high", KZ_REAL, OF_DECADE, NONE, "upper end of the 95 % interval of this number"},
    {"point", KZ_INT32, OF_POINT, NONE, "place in the list of points"},
    {"x", KZ_REAL, OF_POINT, "@x_units", "value of the key x_parameter of the pendulum"},
    {"y", KZ_REAL, OF_POINT, "@y_units", "value of the key y_parameter of the pendulum"},
    {"strobe_theta", KZ_REAL, OF_POINT, ANGLE, "angle of a strobe point of the cycle"},
    {"strobe_velocity", KZ_REAL, OF_POINT, VELOCITY, "velocity of that strobe point"},
    {"normal_form", KZ_REAL, OF_POINT, NONE,
     "folds: half the second derivative of the map along its eigenvector; others: its cubic coefficient"},
    {"side_x", KZ_REAL, OF_POINT, NONE,
     "direction along x, in widths of the plane, of the side on which the cycle exists (folds) or attracts (others)"},
    {"side_y", KZ_REAL, OF_POINT, NONE, "direction along y, in heights of the plane, of the same side"},
    {"tangent_x", KZ_REAL, OF_POINT, NONE,
     "direction of the curve along x, in widths of the plane; shorter where the cycle changes fast, 0 at an end that "
     "was joined"},
    {"tangent_y", KZ_REAL, OF_POINT, NONE, "direction of the curve along y, in heights of the plane"},
    {"supercritical", KZ_INT8, OF_POINT, NONE,
     "whether the cycle that branches off attracts; 0 on folds", {"no", "yes"}},
    {"special", KZ_INT32, OF_SPECIAL, NONE, "number of the special point"},
    {"special_x", KZ_REAL, OF_SPECIAL, "@x_units", "value of the key x_parameter there"},
    {"special_y", KZ_REAL, OF_SPECIAL, "@y_units", "value of the key y_parameter there"},
    {"special_kind", KZ_INT8, OF_SPECIAL, NONE,
     "where the normal form is 0", {"cusp", "degenerate_flip", "degenerate_pitchfork"}},
    {"special_curve", KZ_INT32, OF_SPECIAL, NONE, "number of the curve on which it lies"},
    {"class", KZ_INT32, OF_CLASS, NONE, "number of the class of attractors"},
    {"class_name", KZ_TEXT, OF_CLASS, NONE, "name of the class of attractors"},
    {"class_period", KZ_INT16, OF_CLASS, PERIODS, "period of its attractors"},
    {"class_winding", KZ_INT32, OF_CLASS, NONE,
     "net turns in one period; of two mirror images those of the one that turns counterclockwise"},
    {"class_centre", KZ_INT8, OF_CLASS, NONE,
     "what its attractors move about; neither: either, or it is not known", {CENTRES}},
    {"class_symmetric", KZ_INT8, OF_CLASS, NONE, "whether its attractors are their own mirror images", {"no", "yes"}},
    {"row", KZ_REAL, {"row"}, "@y_units", "value of the key y_parameter in the middle of a row of cells"},
    {"column", KZ_REAL, {"column"}, "@x_units", "value of the key x_parameter in the middle of a column of cells"},
    {"attracting", KZ_UINT8, {"class", "row", "column"}, NONE,
     "number of attractors of the class; two mirror images count as one; 255: not known"},
    {"count", KZ_INT16, {"row", "column"}, NONE,
     "number of attractors of up to max_period periods, mirror images too; -1: not known"},
    {"list", KZ_INT32, {"row", "column"}, NONE,
     "number of the list of attractors: cells with equal numbers have equal lists; -1: not known, as a curve is "
     "missing"},
    {"region", KZ_INT32, OF_REGION, NONE, "number of the region, the largest first: connected cells with one list"},
    {"region_x", KZ_REAL, OF_REGION, "@x_units",
     "value of the key x_parameter at the place farthest from the edge of the region"},
    {"region_y", KZ_REAL, OF_REGION, "@y_units", "value of the key y_parameter at that place"},
    {"region_share", KZ_REAL, OF_REGION, NONE, "share of the plane that the region fills"},
    {"region_radius", KZ_REAL, OF_REGION, NONE,
     "distance of that place from the edge of the region, in sides of the plane"},
    {"region_fraction", KZ_REAL, {"region", "class"}, NONE,
     "share of the starts at that place, of all angles and velocities from -2 to 2 rad per drive radian, that end on "
     "attractors of the class"},
    {"region_other", KZ_REAL, OF_REGION, NONE,
     "share of them that ends on chaotic attractors, on longer cycles, or has not settled"},
    {0},
};
/* clang-format on */
