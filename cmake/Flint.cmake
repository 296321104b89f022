# FLINT's balls (Arb), for orbits of any precision: one library from FLINT 3 on, a second one beside FLINT 2.
find_library(FLINT_LIBRARY flint)
find_library(FLINT_ARB_LIBRARY NAMES arb flint-arb)
find_library(GMP_LIBRARY gmp)
find_library(MPFR_LIBRARY mpfr)
set(beneath ${GMP_LIBRARY}) # of FLINT
if(FLINT_LIBRARY MATCHES "\\.a$" AND MPFR_LIBRARY) # a static one does not bring what it needs
  set(beneath ${MPFR_LIBRARY} ${GMP_LIBRARY})
endif()
find_path(FLINT_3_FOLDER flint/arb.h)
find_path(FLINT_ARB_FOLDER arb.h)
if(FLINT_LIBRARY AND GMP_LIBRARY AND FLINT_3_FOLDER)
  set(KAPITZA_FLINT_LIBRARIES ${FLINT_LIBRARY} ${beneath})
elseif(FLINT_LIBRARY AND GMP_LIBRARY AND FLINT_ARB_LIBRARY AND FLINT_ARB_FOLDER)
  set(KAPITZA_FLINT_LIBRARIES ${FLINT_ARB_LIBRARY} ${FLINT_LIBRARY} ${beneath})
else()
  message(FATAL_ERROR "kapitza needs FLINT with Arb. Install it with one of\n"
                      "  sudo apt-get install libflint-dev (Debian 12 and before: libflint-arb-dev)\n"
                      "  sudo dnf install flint-devel\n  conda install -c conda-forge libflint\n  brew install flint\n")
endif()
