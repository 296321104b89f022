/* What the C loops of the kernel share with its Fortran. */
#ifndef KAPITZA_KERNEL_LANES_H
#define KAPITZA_KERNEL_LANES_H

enum { KZ_LANES = 64 }; /* of a batch: WIDTH of map.f90 */

#endif
