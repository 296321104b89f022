/* The wheel's FLINT has the folders that kapitza's numbers use. Two functions of its generic rings, which would bring
 * all other folders, are named by a division of polynomials that kapitza never calls. Whoever reached them here would
 * be stopped. */
#include <stdlib.h>

void gr_ctx_init_fmpz(void *context);
int _gr_poly_divexact_basecase_bidirectional(void);

void gr_ctx_init_fmpz(void *context) {
  (void)context;
  abort();
}

int _gr_poly_divexact_basecase_bidirectional(void) {
  abort();
}
