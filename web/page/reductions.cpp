// Reductions of arrays that Fortran asks its runtime for: flang's own take minutes to compile for the few types in use.
#include <cmath>
#include <cstring>

#include "flang/Runtime/descriptor.h"
#include "terminator.h"
#include "tools.h"

using namespace Fortran::runtime;

template <typename T> static T least(const Descriptor &x, T found) {
  SubscriptValue at[maxRank];
  x.GetLowerBounds(at);
  for (std::size_t n{x.Elements()}; n-- > 0; x.IncrementSubscripts(at)) found = std::min(found, *x.Element<T>(at));
  return found;
}

template <typename FIND> static void lines(Descriptor &result, const Descriptor &x, int dim, TypeCode type,
                                           std::size_t bytes, const char *source, int line, FIND find) {
  Terminator terminator{source, line};
  CreatePartialReductionResult(result, x, bytes, dim, terminator, "reduction", type);
  SubscriptValue to[maxRank], from[maxRank];
  result.GetLowerBounds(to);
  for (std::size_t n{result.Elements()}; n-- > 0; result.IncrementSubscripts(to)) {
    for (int j{0}; j < x.rank(); ++j)
      if (j != dim - 1) from[j] = to[j < dim ? j : j - 1] - 1 + x.GetDimension(j).LowerBound();
    const SubscriptValue low{x.GetDimension(dim - 1).LowerBound()}, count{x.GetDimension(dim - 1).Extent()};
    find(result, to, count, [&](SubscriptValue i) { return from[dim - 1] = low + i, from; });
  }
}

extern "C" {
double _FortranAMinvalReal8(const Descriptor &x, const char *, int, int, const Descriptor *) {
  return least<double>(x, HUGE_VAL);
}

std::int64_t _FortranAMinvalInteger8(const Descriptor &x, const char *, int, int, const Descriptor *) {
  return least<std::int64_t>(x, INT64_MAX);
}

double _FortranANorm2_8(const Descriptor &x, const char *, int, int) {
  long double sum{0};
  SubscriptValue at[maxRank];
  x.GetLowerBounds(at);
  for (std::size_t n{x.Elements()}; n-- > 0; x.IncrementSubscripts(at)) {
    const long double value{*x.Element<double>(at)};
    sum += value * value;
  }
  return static_cast<double>(std::sqrt(sum));
}

void _FortranANorm2Dim(Descriptor &result, const Descriptor &x, int dim, const char *source, int line) {
  const TypeCode real{TypeCategory::Real, 8};
  lines(result, x, dim, real, 8, source, line, [&](auto &to, auto at, auto count, auto place) {
    long double sum{0};
    for (SubscriptValue i{0}; i < count; ++i) {
      const long double value{*x.Element<double>(place(i))};
      sum += value * value;
    }
    *to.template Element<double>(at) = static_cast<double>(std::sqrt(sum));
  });
}

void _FortranAMaxvalDim(Descriptor &result, const Descriptor &x, int dim, const char *source, int line,
                        const Descriptor *) {
  if (x.type() != TypeCode{TypeCategory::Real, 8}) Terminator{source, line}.Crash("maxval: another type");
  lines(result, x, dim, x.type(), 8, source, line, [&](auto &to, auto at, auto count, auto place) {
    double found{-HUGE_VAL};
    for (SubscriptValue i{0}; i < count; ++i) found = std::max(found, *x.Element<double>(place(i)));
    *to.template Element<double>(at) = found;
  });
}

void _FortranAFindlocDim(Descriptor &result, const Descriptor &x, const Descriptor &target, int kind, int dim,
                         const char *source, int line, const Descriptor *, bool back) {
  lines(result, x, dim, TypeCode{TypeCategory::Integer, kind}, kind, source, line,
        [&](auto &to, auto at, auto count, auto place) {
    std::int64_t found{0};
    const bool truth{x.type().IsLogical()};
    for (SubscriptValue i{0}; i < count && (back || found == 0); ++i) {
      const char *element{x.Element<char>(place(i))}, *wanted{target.OffsetElement<char>()};
      const bool equal{truth ? (*element & 1) == (*wanted & 1) : std::memcmp(element, wanted, x.ElementBytes()) == 0};
      if (equal) found = i + 1;
    }
    std::memcpy(to.template Element<char>(at), &found, kind);
  });
}
}
